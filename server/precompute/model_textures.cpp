#include "precompute/model_textures.h"

#include "codec/stream_decoder.h"
#include "codec/stream_header_writer.h"
#include "image/image_file.h"
#include "image/texture_decoder.h"
#include "picture/decoded_surface.h"
#include "precompute/chunk_order.h"
#include "scene/appearance_chunk.h"

#include <algorithm>
#include <utility>

namespace vsplit::precompute {
namespace {

/// What materials use an image for.
struct ImageRole
{
    bool used = false;
    bool normals = false;
};

std::vector<ImageRole> image_roles(const Appearance& appearance)
{
    std::vector<ImageRole> roles(appearance.images.size());
    const auto use = [&](const TextureUse& texture, bool normals) {
        if (texture.image >= 0 && static_cast<std::size_t>(texture.image) < roles.size())
        {
            ImageRole& role = roles[static_cast<std::size_t>(texture.image)];
            role.used = true;
            role.normals = role.normals || normals;
        }
    };
    for (const Material& material : appearance.materials)
    {
        use(material.base_color_texture, false);
        use(material.metallic_roughness_texture, false);
        use(material.normal_texture, true);
        use(material.occlusion_texture, false);
        use(material.emissive_texture, false);
    }
    return roles;
}

/// A prefix of a stream of shape and attributes at whose end a client shows something better than before.
struct Stage
{
    std::size_t chunk = 0;    ///< The last one of the prefix.
    std::uint64_t bytes = 0;  ///< Of the prefix.
};

/// Decodes a prefix of a stream and calls `follow(step)` after every step.
template <typename Follow>
Result<void> decode_prefix(
    codec::StreamDecoder& decoder, std::span<const std::byte> prefix, const Follow& follow
)
{
    while (!prefix.empty())
    {
        const auto taken = decoder.feed(prefix);
        VSPLIT_TRY(taken);
        prefix = prefix.subspan(*taken);
        const auto step = decoder.step();
        VSPLIT_TRY(step);
        follow(*step);
    }
    return {};
}

/// Finds the stages of a stream: one a level, then one for all normals of an attribute and what else makes the
/// last level better without being a level. The last stage is the whole file.
Result<std::vector<Stage>> find_stages(std::span<const std::byte> file)
{
    std::vector<Stage> stages;
    codec::StreamDecoder decoder;
    std::size_t chunk = 0;
    const auto follow = [&](const codec::Step& step) {
        const bool plain = step.level_complete && decoder.info()->attributes.empty();
        if (plain || step.attributes_complete)
        {
            stages.push_back({chunk, decoder.decoded_bytes()});
        }
        chunk += step.chunk != nullptr ? 1 : 0;
    };
    VSPLIT_TRY(decode_prefix(decoder, file, follow));
    stages.back() = {chunk - 1, decoder.decoded_bytes()};
    return stages;
}

/// What a client shows after a prefix of a stream.
Result<Surface> surface_after(std::span<const std::byte> prefix)
{
    codec::StreamDecoder decoder;
    VSPLIT_TRY(decode_prefix(decoder, prefix, [](const codec::Step&) {}));
    return picture::decoded_surface(decoder);
}

/// The image that the first chunks of a coded one show.
Result<Raster> raster_after(const image::EncodedTexture& texture, std::uint32_t chunks)
{
    constexpr std::uint32_t kSide = OrderOptions().image_side;
    image::TextureDecoder decoder;
    for (const image::TextureChunk& chunk : std::span(texture.chunks).first(chunks))
    {
        VSPLIT_TRY(decoder.feed(chunk.payload));
    }
    return decoder.picture(kSide);
}

Result<ChunkOrder> find_order(
    std::span<const std::byte> file,
    std::span<const Stage> stages,
    const Surface& original,
    const Appearance& appearance,
    const ModelTextures& textures
)
{
    OrderSource source;
    source.original = &original;
    source.appearance = &appearance;
    source.original_images = textures.rasters;
    std::uint64_t before = 0;
    for (const Stage& stage : stages)
    {
        source.stage_bytes.push_back(stage.bytes - before);
        before = stage.bytes;
    }
    for (const image::EncodedTexture& texture : textures.encoded)
    {
        auto& bytes = source.texture_bytes.emplace_back();
        for (const image::TextureChunk& chunk : texture.chunks)
        {
            bytes.push_back(chunk.payload.size() + proto::kChunkChecksumBytes);
        }
    }
    source.stage = [&](std::uint32_t stage) {
        return surface_after(file.first(stages[stage].bytes));
    };
    source.image = [&](std::uint32_t image, std::uint32_t chunks) {
        return raster_after(textures.encoded[image], chunks);
    };
    return order_chunks(source);
}

}  // namespace

Result<ModelTextures> encode_textures(
    Appearance& appearance,
    std::span<const SourceImage> images,
    const ImageOptions& options,
    const std::function<void(double)>& progress
)
{
    const auto roles = image_roles(appearance);
    ModelTextures textures;
    textures.rasters.resize(images.size());
    textures.encoded.resize(images.size());
    for (std::size_t i = 0; i < images.size(); ++i)
    {
        progress(static_cast<double>(i) / static_cast<double>(images.size()));
        if (!roles[i].used)
        {
            continue;
        }
        auto raster = image::read_image(images[i].bytes);
        const auto named = [&](Error error) {
            error.message = "image " + images[i].name + ": " + error.message;
            return tl::unexpected<Error>(std::move(error));
        };
        if (!raster)
        {
            return named(raster.error());
        }
        auto encoded = image::encode_texture(
            *raster,
            {.image = static_cast<std::uint32_t>(i),
             .max_size = options.max_size,
             .psnr = options.psnr,
             // A little more than the source's own file: what stops just there is a little worse than it.
             .cheap_bytes = images[i].bytes.size() * 9 / 8,
             .lossless = options.lossless,
             .is_normal_map = roles[i].normals}
        );
        if (!encoded)
        {
            return named(encoded.error());
        }
        appearance.images[i].width = encoded->info.width;
        appearance.images[i].height = encoded->info.height;
        appearance.images[i].channels = encoded->info.channels;
        textures.rasters[i] = std::move(*raster);
        textures.encoded[i] = std::move(*encoded);
    }
    return textures;
}

Result<std::vector<std::byte>> insert_appearance(
    std::span<const std::byte> file,
    const Surface& original,
    const Appearance& appearance,
    const ModelTextures& textures
)
{
    auto payload = scene::encode_appearance(appearance);
    VSPLIT_TRY(payload);
    std::vector<codec::ExtraChunk> extra;
    extra.push_back({.after = 0, .kind = proto::ChunkKind::Appearance, .bytes = std::move(*payload)}
    );
    const bool has_images = std::ranges::any_of(textures.encoded, [](const auto& texture) {
        return !texture.chunks.empty();
    });
    if (!has_images)
    {
        return codec::insert_chunks(file, extra);
    }
    const auto info = codec::parse_stream_info(file);
    VSPLIT_TRY(info);
    const auto stages = find_stages(file);
    VSPLIT_TRY(stages);
    const auto order = find_order(file, *stages, original, appearance, textures);
    VSPLIT_TRY(order);
    std::vector<std::uint32_t> tags(info->chunks.size());
    std::ranges::transform(info->chunks, tags.begin(), &codec::ChunkInfo::tag);
    std::size_t last = 0;
    for (const OrderStep& step : order->steps)
    {
        if (step.image == OrderStep::kGeometry)
        {
            last = (*stages)[step.index].chunk;
            std::uint32_t& tag = tags[last];
            tag = codec::with_picture_quality(tag, step.error);
            continue;
        }
        const auto& chunk =
            textures.encoded[static_cast<std::size_t>(step.image)].chunks[step.index];
        extra.push_back(
            {.after = last,
             .kind = proto::ChunkKind::Texture,
             .tag = codec::with_picture_quality(chunk.tag, step.error),
             .bytes = chunk.payload}
        );
    }
    return codec::insert_chunks(file, extra, tags);
}

}  // namespace vsplit::precompute
