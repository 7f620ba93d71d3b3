#include "image/texture_decoder.h"

#include "core/assert.h"
#include "image/code_stream.h"
#include "image/downsample.h"
#include "image/open_jpeg.h"

#include <algorithm>
#include <utility>

namespace vsplit::image {

namespace {

constexpr std::uint64_t kMaxImageNumber = (1U << 28U) - 1U;

Result<std::uint32_t> read_image_number(ByteReader& reader)
{
    const auto number = reader.read_varint();
    VSPLIT_TRY(number);
    if (*number > kMaxImageNumber)
    {
        return fail(ErrorCode::BadChunk, "an image has an impossible number");
    }
    return static_cast<std::uint32_t>(*number);
}

/// The finest resolution whose sides are at most `max_size`; the coarsest when all are larger.
std::size_t fitting_resolution(const TextureLayout& layout, std::uint32_t max_size)
{
    std::size_t index = layout.resolutions().size() - 1;
    while (index > 0 &&
           std::max(layout.resolutions()[index].width, layout.resolutions()[index].height) >
               max_size)
    {
        --index;
    }
    return index;
}

tl::unexpected<Error> bad(const char* message)
{
    return fail(ErrorCode::BadChunk, message);
}

}  // namespace

Result<std::uint32_t> texture_chunk_image(std::span<const std::byte> payload)
{
    ByteReader reader(payload);
    return read_image_number(reader);
}

Result<TextureDecoder::Chunk> TextureDecoder::parse(std::span<const std::byte> payload) const
{
    ByteReader reader(payload);
    Chunk chunk;
    const auto image = read_image_number(reader);
    VSPLIT_TRY(image);
    chunk.image = *image;
    const auto first = reader.read_varint();
    VSPLIT_TRY(first);
    std::uint64_t packet = *first;
    if (header_ && (chunk.image != image_ || packet < next_packet_))
    {
        return bad("a texture chunk is of another image or comes too late");
    }
    std::optional<TextureLayout> own_layout;
    if (!header_)
    {
        if (packet != 0)
        {
            return bad("the first chunk of an image is missing");
        }
        const auto header = read_texture_header(reader);
        VSPLIT_TRY(header);
        chunk.header = *header;
        own_layout.emplace(*header);
    }
    const TextureLayout& layout = header_ ? *layout_ : *own_layout;
    do
    {
        const auto count = reader.read_varint();
        VSPLIT_TRY(count);
        const auto length = reader.read_varint();
        VSPLIT_TRY(length);
        if (packet >= layout.packet_count() || *count == 0 ||
            *count > layout.run_end(packet) - packet)
        {
            return bad("a texture chunk has more packets than the image");
        }
        if (*length > reader.remaining() || (*length > 0 && *length < *count))
        {
            return bad("packets of a texture chunk have an impossible length");
        }
        const auto bytes = reader.read_bytes(static_cast<std::size_t>(*length));
        VSPLIT_TRY(bytes);
        chunk.runs.push_back({packet, *count, {bytes->begin(), bytes->end()}});
        packet += *count;
    }
    while (reader.remaining() > 0);
    return chunk;
}

Result<void> TextureDecoder::feed(std::span<const std::byte> payload)
{
    if (payload.size() > limits_.max_coded_bytes - std::min(coded_bytes_, limits_.max_coded_bytes))
    {
        return fail(ErrorCode::LimitExceeded, "an image has more bytes than may be kept");
    }
    auto chunk = parse(payload);
    VSPLIT_TRY(chunk);
    if (chunk->header)
    {
        image_ = chunk->image;
        header_ = chunk->header;
        layout_.emplace(*header_);
        layers_.assign(layout_->packets_per_layer(), 0);
    }
    for (Run& run : chunk->runs)
    {
        take(std::move(run));
    }
    return {};
}

void TextureDecoder::take(Run run)
{
    next_packet_ = run.first + run.count;
    if (!builds_on_what_came(run))
    {
        return;
    }
    const std::uint64_t place = run.first % layout_->packets_per_layer();
    for (std::uint64_t i = place; i < place + run.count; ++i)
    {
        ++layers_[i];
    }
    const auto finest = fitting_resolution(*layout_, limits_.max_size);
    if (layout_->group_of(run.first) > layout_->resolutions()[finest].group)
    {
        return;
    }
    coded_bytes_ += run.bytes.size();
    runs_.push_back(std::move(run));
}

bool TextureDecoder::builds_on_what_came(const Run& run) const
{
    const std::uint64_t layer = run.first / layout_->packets_per_layer();
    const auto begin =
        layers_.begin() + static_cast<std::ptrdiff_t>(run.first % layout_->packets_per_layer());
    return std::all_of(begin, begin + static_cast<std::ptrdiff_t>(run.count), [&](std::uint8_t n) {
        return n == layer;
    });
}

bool TextureDecoder::complete() const
{
    if (!header_)
    {
        return false;
    }
    const auto& finest = layout_->resolutions()[fitting_resolution(*layout_, limits_.max_size)];
    const auto end = layers_.begin() + finest.first_packet + finest.packets;
    return std::all_of(layers_.begin(), end, [&](std::uint8_t n) { return n == header_->layers; });
}

std::vector<std::byte> TextureDecoder::code_stream(std::size_t resolution) const
{
    const TextureResolution& finest = layout_->resolutions()[resolution];
    const std::uint64_t per_layer = layout_->packets_per_layer();
    const std::uint64_t used = std::uint64_t{finest.first_packet} + finest.packets;
    std::vector<std::byte> packets;
    packets.reserve(coded_bytes_ + used);
    std::uint64_t layer = 0;
    std::uint64_t place = 0;
    const auto fill_until = [&](std::uint64_t wanted_layer, std::uint64_t wanted_place) {
        const std::uint64_t missing = (wanted_layer - layer) * used + wanted_place - place;
        packets.insert(packets.end(), missing, kNoPacket);
        layer = wanted_layer;
        place = wanted_place;
    };
    for (const Run& run : runs_)
    {
        if (run.first % per_layer >= used)
        {
            continue;
        }
        fill_until(run.first / per_layer, run.first % per_layer);
        packets.insert(packets.end(), run.bytes.begin(), run.bytes.end());
        if (run.bytes.empty())
        {
            packets.insert(packets.end(), run.count, kUntouchedPacket);
        }
        place += run.count;
    }
    fill_until(layer + 1, 0);
    const auto dropped = static_cast<unsigned>(header_->levels - resolution);
    auto stream = main_header(*header_, dropped, static_cast<unsigned>(layer));
    append_tile(stream, packets);
    return stream;
}

Result<Raster> TextureDecoder::picture(std::uint32_t max_size) const
{
    VSPLIT_ASSERT(max_size >= 1);
    if (!header_)
    {
        return fail(ErrorCode::Truncated, "nothing of the image has come");
    }
    const std::size_t wanted = fitting_resolution(*layout_, std::min(max_size, limits_.max_size));
    const TextureResolution& shown = layout_->resolutions()[wanted];
    // Runs hold whole groups, so the code stream ends with one; what is finer in it is not decoded.
    const std::size_t finest = layout_->finest_resolution(shown.group);
    const TextureResolution& coded = layout_->resolutions()[finest];
    if (std::uint64_t{coded.width} * coded.height > limits_.max_pixels)
    {
        return fail(ErrorCode::LimitExceeded, "an image has more pixels than may be decoded");
    }
    auto raster = open_jpeg_decode(code_stream(finest), static_cast<unsigned>(finest - wanted));
    VSPLIT_TRY(raster);
    if (raster->width != shown.width || raster->height != shown.height ||
        raster->channels != header_->channels)
    {
        return bad("an image was decoded to another size");
    }
    return downsampled(*raster, max_size);
}

std::uint64_t texture_decode_bytes(
    const ImageInfo& info, std::uint32_t max_size, std::uint64_t coded_bytes
)
{
    std::uint64_t width = std::max(info.width, 1U);
    std::uint64_t height = std::max(info.height, 1U);
    while (std::max(width, height) > std::max(max_size, 1U))
    {
        width = (width + 1) / 2;
        height = (height + 1) / 2;
    }
    // Coefficients of 4 bytes and pixels of 1; OpenJPEG's records of packets and code blocks.
    constexpr std::uint64_t kBytesPerSample = 6;
    constexpr std::uint64_t kFixedBytes = 1U << 20U;
    return width * height * info.channels * kBytesPerSample + 4 * coded_bytes + kFixedBytes;
}

}  // namespace vsplit::image
