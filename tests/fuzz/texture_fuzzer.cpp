// Feeds noise to the decoder of texture chunks. The input is a sequence of chunks, each after its length
// in two bytes; pictures are decoded at a small and at the full size.

#include "core/byte_reader.h"
#include "image/texture_decoder.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

namespace {

using namespace vsplit;

void require(bool condition)
{
    if (!condition)
    {
        std::abort();
    }
}

void show(const image::TextureDecoder& decoder, std::uint32_t max_size)
{
    const auto picture = decoder.picture(max_size);
    if (!picture)
    {
        require(picture.error().code != ErrorCode::Internal);
        return;
    }
    require(picture->width <= max_size && picture->height <= max_size);
    require(
        picture->pixels.size() == std::size_t{picture->width} * picture->height * picture->channels
    );
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    // Code blocks are slow to decode where every byte is noise: few pixels make many runs a second.
    image::TextureDecoder decoder({.max_pixels = 320U * 320U});
    ByteReader reader(std::as_bytes(std::span(data, size)));
    while (const auto length = reader.read<std::uint16_t>())
    {
        const auto chunk = reader.read_bytes(std::min<std::size_t>(*length, reader.remaining()));
        const auto before = decoder.coded_bytes();
        const auto fed = decoder.feed(*chunk);
        require(fed || decoder.coded_bytes() == before);
        require(!fed || image::texture_chunk_image(*chunk).has_value());
    }
    show(decoder, 40);
    show(decoder, image::kMaxTextureSide);
    return 0;
}
