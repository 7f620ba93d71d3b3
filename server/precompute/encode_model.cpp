#include "precompute/encode_model.h"

#include "precompute/model_textures.h"
#include "precompute/tex_coord_bits.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace vsplit::precompute {
namespace {

/// Bits of positions behind the images, as far as those are worth more.
constexpr int kLateBits = 2;

bool is_plain(const Appearance& appearance)
{
    return appearance.materials.empty() && appearance.groups.size() <= 1 &&
           appearance.images.empty();
}

bool places_images(const Appearance& appearance)
{
    return std::ranges::any_of(appearance.materials, [](const Material& material) {
        return material.base_color_texture.image >= 0;
    });
}

/// Beside images the shape is refined piece by piece: images come between. Growth saves bytes, but shows nothing
/// new for half of the file.
EncodeOptions mesh_options(EncodeOptions options, const Appearance& appearance)
{
    if (places_images(appearance))
    {
        options.grow_last_level = false;
        options.late_bits = kLateBits;
    }
    return options;
}

}  // namespace

Result<EncodedModel> encode_model(
    RepairedModel&& model, const ModelOptions& options, const ProgressSink& progress
)
{
    Surface original;
    if (!model.images.empty())
    {
        original = {model.surface.repaired.mesh, model.surface.attributes, model.surface.groups};
    }
    AttributeBits bits = options.bits;
    if (bits.tex_coord == 0)
    {
        bits.tex_coord = choose_tex_coord_bits(
            model.surface.attributes, model.appearance, options.images.max_size
        );
    }
    auto input = make_encode_input(std::move(model.surface), bits);
    VSPLIT_TRY(input);
    auto mesh =
        encode_surface(std::move(*input), mesh_options(options.mesh, model.appearance), progress);
    VSPLIT_TRY(mesh);
    EncodedModel result;
    result.mesh = std::move(*mesh);
    if (is_plain(model.appearance))
    {
        return result;
    }
    const auto start = std::chrono::steady_clock::now();
    const auto textures =
        encode_textures(model.appearance, model.images, options.images, [&](double share) {
            if (progress)
            {
                progress("images", share);
            }
        });
    VSPLIT_TRY(textures);
    auto file = insert_appearance(result.mesh.file, original, model.appearance, *textures);
    VSPLIT_TRY(file);
    result.mesh.file = std::move(*file);
    auto info = codec::parse_stream_info(result.mesh.file);
    VSPLIT_TRY(info);
    result.mesh.info = std::move(*info);
    for (const codec::ChunkInfo& chunk : result.mesh.info.chunks)
    {
        result.image_bytes += chunk.kind == proto::ChunkKind::Texture ? chunk.bytes : 0;
    }
    result.image_seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

}  // namespace vsplit::precompute
