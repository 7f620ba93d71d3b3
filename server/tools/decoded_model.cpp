#include "decoded_model.h"

#include "image/image_file.h"
#include "picture/decoded_surface.h"
#include "scene/appearance_chunk.h"

#include <string>
#include <utility>

namespace vsplit::tools {
namespace {

constexpr int kJpegQuality = 95;

bool holds_directions(const Appearance& appearance, std::size_t image)
{
    for (const Material& material : appearance.materials)
    {
        if (material.normal_texture.image == static_cast<std::int32_t>(image))
        {
            return true;
        }
    }
    return false;
}

}  // namespace

Result<void> DecodedModel::take(const codec::Step& step)
{
    if (step.chunk == nullptr || step.contents.empty())
    {
        return {};
    }
    if (step.chunk->kind == proto::ChunkKind::Appearance)
    {
        auto appearance = scene::decode_appearance(step.contents);
        VSPLIT_TRY(appearance);
        appearance_ = std::move(*appearance);
        textures_.resize(appearance_.images.size());
    }
    if (step.chunk->kind == proto::ChunkKind::Texture)
    {
        const auto image = image::texture_chunk_image(step.contents);
        VSPLIT_TRY(image);
        if (*image >= textures_.size())
        {
            return fail(ErrorCode::BadChunk, "a chunk belongs to no image", step.chunk->offset);
        }
        return textures_[*image].feed(step.contents);
    }
    return {};
}

Result<std::vector<SourceImage>> DecodedModel::images() const
{
    std::vector<SourceImage> images(textures_.size());
    for (std::size_t i = 0; i < images.size(); ++i)
    {
        images[i].name = appearance_.images[i].name;
        const auto& header = textures_[i].header();
        if (!header)
        {
            continue;
        }
        const auto raster = textures_[i].picture(image::kMaxTextureSide);
        VSPLIT_TRY(raster);
        const bool exact = raster->channels == 2 || raster->channels == 4 || header->reversible ||
                           holds_directions(appearance_, i);
        auto file = exact ? image::write_png(*raster)
                          : image::write_jpeg(*raster, {.quality = kJpegQuality});
        VSPLIT_TRY(file);
        images[i].bytes = std::move(*file);
    }
    return images;
}

Surface stitched_surface(const codec::StreamDecoder& decoder)
{
    Surface surface = picture::decoded_surface(decoder);
    surface.mesh = codec::extract_mesh(decoder);
    return surface;
}

}  // namespace vsplit::tools
