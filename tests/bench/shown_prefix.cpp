#include "shown_prefix.h"

#include "codec/stream_decoder.h"
#include "image/texture_decoder.h"
#include "picture/decoded_surface.h"
#include "scene/appearance_chunk.h"

#include <limits>
#include <map>

namespace vsplit::bench {
namespace {

/// Takes the chunks that are about materials and images.
class AppearanceReader
{
public:
    Result<void> take(proto::ChunkKind kind, std::span<const std::byte> payload)
    {
        if (kind == proto::ChunkKind::Appearance)
        {
            auto read = scene::decode_appearance(payload);
            VSPLIT_TRY(read);
            appearance_ = std::move(*read);
        }
        else if (kind == proto::ChunkKind::Texture)
        {
            const auto image = image::texture_chunk_image(payload);
            VSPLIT_TRY(image);
            VSPLIT_TRY(images_[*image].feed(payload));
        }
        return {};
    }

    Result<void> show(ShownModel& model) const
    {
        model.appearance = appearance_;
        model.textures.resize(appearance_.images.size());
        for (const auto& [image, decoder] : images_)
        {
            const auto picture = decoder.picture(std::numeric_limits<std::uint32_t>::max());
            VSPLIT_TRY(picture);
            if (image < model.textures.size())
            {
                model.textures[image] = picture::Texture(*picture);
            }
        }
        return {};
    }

private:
    Appearance appearance_;
    std::map<std::uint32_t, image::TextureDecoder> images_;
};

}  // namespace

Result<ShownPrefix> show_prefix(std::span<const std::byte> prefix)
{
    codec::StreamDecoder decoder;
    AppearanceReader reader;
    ShownPrefix shown;
    std::size_t chunk = 0;
    for (std::span<const std::byte> rest = prefix; !decoder.complete();)
    {
        const auto taken = decoder.feed(rest);
        VSPLIT_TRY(taken);
        rest = rest.subspan(*taken);
        const auto step = decoder.step();
        VSPLIT_TRY(step);
        if (step->kind == codec::StepKind::NeedBytes && rest.empty())
        {
            break;
        }
        if (step->kind == codec::StepKind::Chunk || step->kind == codec::StepKind::SkippedChunk)
        {
            const codec::ChunkInfo& info = decoder.info()->chunks[chunk++];
            const auto payload =
                codec::chunk_contents(prefix.subspan(info.offset, info.bytes), info.offset);
            VSPLIT_TRY(payload);
            VSPLIT_TRY(reader.take(info.kind, *payload));
        }
        const bool plain = step->level_complete && decoder.info()->attributes.empty();
        if (plain || step->attributes_complete)
        {
            shown.model.surface = picture::decoded_surface(decoder);
        }
    }
    shown.bytes = decoder.decoded_bytes();
    VSPLIT_TRY(reader.show(shown.model));
    return shown;
}

}  // namespace vsplit::bench
