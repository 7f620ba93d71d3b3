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

/// Decodes a stream up to and with the attributes of a level.
Result<Surface> surface_at(
    std::span<const std::byte> file, const codec::StreamInfo& info, std::uint32_t level
)
{
    codec::StreamDecoder decoder;
    auto rest = file.first(info.levels[level].cumulative_bytes);
    while (!rest.empty())
    {
        const auto taken = decoder.feed(rest);
        VSPLIT_TRY(taken);
        rest = rest.subspan(*taken);
        VSPLIT_TRY(decoder.step());
    }
    return picture::decoded_surface(decoder);
}

/// The image that the first chunks of a coded one show.
Result<Raster> raster_after(const image::EncodedTexture& texture, std::uint32_t chunks)
{
    constexpr std::uint32_t kSide = 512;
    image::TextureDecoder decoder;
    for (const image::TextureChunk& chunk : std::span(texture.chunks).first(chunks))
    {
        VSPLIT_TRY(decoder.feed(chunk.payload));
    }
    return decoder.picture(kSide);
}

/// By level the last chunk that belongs to it.
std::vector<std::size_t> last_chunks(const codec::StreamInfo& info)
{
    std::vector<std::size_t> last;
    for (std::size_t i = 0; i < info.chunks.size(); ++i)
    {
        const codec::ChunkInfo& chunk = info.chunks[i];
        if (codec::is_optional(chunk.kind))
        {
            last.back() = i;
        }
        else if (chunk.ends_level)
        {
            last.push_back(i);
        }
    }
    return last;
}

Result<ChunkOrder> find_order(
    std::span<const std::byte> file,
    const codec::StreamInfo& info,
    const Surface& original,
    const Appearance& appearance,
    const ModelTextures& textures
)
{
    OrderSource source;
    source.original = &original;
    source.appearance = &appearance;
    source.original_images = textures.rasters;
    for (const codec::LevelInfo& level : info.levels)
    {
        source.level_bytes.push_back(level.chunk_bytes);
    }
    for (const image::EncodedTexture& texture : textures.encoded)
    {
        auto& bytes = source.texture_bytes.emplace_back();
        for (const image::TextureChunk& chunk : texture.chunks)
        {
            bytes.push_back(chunk.payload.size() + proto::kChunkChecksumBytes);
        }
    }
    source.level = [&](std::uint32_t level) { return surface_at(file, info, level); };
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
             .cheap_bytes = images[i].bytes.size(),
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
    const auto order = find_order(file, *info, original, appearance, textures);
    VSPLIT_TRY(order);
    const auto last = last_chunks(*info);
    std::vector<std::uint32_t> tags(info->chunks.size());
    std::ranges::transform(info->chunks, tags.begin(), &codec::ChunkInfo::tag);
    std::uint32_t level = 0;
    for (const OrderStep& step : order->steps)
    {
        if (step.image == OrderStep::kGeometry)
        {
            level = step.index;
            std::uint32_t& tag = tags[last[level]];
            tag = codec::with_picture_quality(tag, step.error);
            continue;
        }
        const auto& chunk =
            textures.encoded[static_cast<std::size_t>(step.image)].chunks[step.index];
        extra.push_back(
            {.after = last[level],
             .kind = proto::ChunkKind::Texture,
             .tag = codec::with_picture_quality(chunk.tag, step.error),
             .bytes = chunk.payload}
        );
    }
    return codec::insert_chunks(file, extra, tags);
}

}  // namespace vsplit::precompute
