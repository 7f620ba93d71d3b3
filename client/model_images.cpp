#include "model_images.h"

#include "gl_textures.h"
#include "image/texture_layout.h"
#include "scene/appearance_chunk.h"

#include <algorithm>
#include <utility>

namespace vsplit::client {

Result<void> ModelImages::take(const codec::ChunkInfo& chunk, std::span<const std::byte> contents)
{
    Result<void> taken;
    if (chunk.kind == proto::ChunkKind::Appearance)
    {
        taken = take_appearance(contents);
    }
    else if (chunk.kind == proto::ChunkKind::Texture && wants(chunk))
    {
        taken = take_texture(contents);
    }
    return taken ? taken : fail(taken.error().code, taken.error().message, chunk.offset);
}

Result<void> ModelImages::take_appearance(std::span<const std::byte> contents)
{
    auto appearance = scene::decode_appearance(contents);
    VSPLIT_TRY(appearance);
    if (appearance_)
    {
        return fail(ErrorCode::BadChunk, "the materials come twice");
    }
    appearance_ = std::move(*appearance);
    image::TextureLimits limits;
    limits.max_size = std::max(1U, limit_);
    entries_.clear();
    for (const bool drawn : drawn_images(*appearance_))
    {
        entries_.push_back({image::TextureDecoder(limits), drawn, false});
    }
    return {};
}

Result<void> ModelImages::take_texture(std::span<const std::byte> contents)
{
    const auto image = image::texture_chunk_image(contents);
    VSPLIT_TRY(image);
    if (*image >= entries_.size())
    {
        return fail(ErrorCode::BadChunk, "a texture is of an image that the model has not");
    }
    Entry& entry = entries_[*image];
    if (entry.drawn)
    {
        VSPLIT_TRY(entry.decoder.feed(contents));
        entry.fed = true;
    }
    return {};
}

bool ModelImages::wants(const codec::ChunkInfo& chunk) const
{
    if (chunk.kind != proto::ChunkKind::Texture)
    {
        return true;
    }
    if (limit_ == 0 || !image::texture_chunk_wanted(chunk.tag, limit_))
    {
        return false;
    }
    const std::uint32_t number = image::parse_texture_tag(chunk.tag).image;
    return !appearance_ || (number < entries_.size() && entries_[number].drawn);
}

bool ModelImages::has_sharper() const
{
    return std::ranges::any_of(entries_, &Entry::fed);
}

Result<std::optional<SharperImage>> ModelImages::decode_next()
{
    for (std::size_t i = 0; i < entries_.size(); ++i)
    {
        const std::size_t number = (turn_ + i) % entries_.size();
        Entry& entry = entries_[number];
        if (!entry.fed)
        {
            continue;
        }
        const auto start = std::chrono::steady_clock::now();
        auto raster = entry.decoder.picture(limit_);
        VSPLIT_TRY(raster);
        entry.fed = false;
        turn_ = number + 1;
        return SharperImage{
            static_cast<std::uint32_t>(number),
            std::move(*raster),
            std::chrono::steady_clock::now() - start,
        };
    }
    return std::nullopt;
}

std::uint64_t ModelImages::coded_bytes() const
{
    std::uint64_t sum = 0;
    for (const Entry& entry : entries_)
    {
        sum += entry.decoder.coded_bytes();
    }
    return sum;
}

}  // namespace vsplit::client
