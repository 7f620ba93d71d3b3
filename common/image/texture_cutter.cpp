#include "image/texture_cutter.h"

#include "core/assert.h"
#include "core/byte_writer.h"
#include "format.h"

#include <algorithm>
#include <cstdint>
#include <span>

namespace vsplit::image {

namespace {

constexpr std::uint64_t kLeastChunkBytes = 400;

/// Packets in a chunk, short enough that a prefix of any length shows nearly all that it holds; leaves room
/// for numbers, header and checksum.
constexpr std::uint64_t kMostPacketBytes = 6000;

/// With packets that are too few for a chunk of their own.
constexpr std::uint64_t kMostJoinedBytes = proto::kTargetChunkBytes - 64;

/// Consecutive packets of one layer and group.
struct Run
{
    std::uint64_t first = 0;
    std::uint64_t count = 0;
    std::uint64_t offset = 0;
    std::uint64_t bytes = 0;
    bool untouched = false;
};

/// Consecutive runs.
struct Piece
{
    std::size_t first_run = 0;
    std::size_t end_run = 0;
    std::uint64_t bytes = 0;
    std::uint64_t layer = 0;
};

bool is_untouched(const CodedPackets& coded, std::uint64_t packet, std::uint64_t offset)
{
    return coded.lengths[packet] == 1 && coded.bytes[offset] == kUntouchedPacket;
}

std::vector<Run> make_runs(const CodedPackets& coded, const TextureLayout& layout)
{
    std::vector<Run> runs;
    std::uint64_t offset = 0;
    std::uint64_t end = 0;
    for (std::uint64_t packet = 0; packet < layout.packet_count(); ++packet)
    {
        const std::uint64_t length = coded.lengths[packet];
        const bool border = packet == end;
        if (border)
        {
            end = layout.run_end(packet);
        }
        if (border || runs.back().bytes + length > kMostPacketBytes)
        {
            runs.push_back({packet, 0, offset, 0, true});
        }
        Run& run = runs.back();
        run.untouched = run.untouched && is_untouched(coded, packet, offset);
        ++run.count;
        run.bytes += length;
        offset += length;
    }
    return runs;
}

std::uint64_t sent_bytes(const Run& run)
{
    return run.untouched ? 0 : run.bytes;
}

std::vector<Piece> make_pieces(const std::vector<Run>& runs, const TextureLayout& layout)
{
    std::vector<Piece> pieces;
    bool open = false;
    for (std::size_t i = 0; i < runs.size(); ++i)
    {
        const std::uint64_t layer = runs[i].first / layout.packets_per_layer();
        const std::uint64_t bytes = sent_bytes(runs[i]);
        const bool fits = !pieces.empty() && pieces.back().bytes + bytes <= kMostJoinedBytes;
        // The first layer is the preview: one chunk, if it can be.
        const bool wanted = open || (layer == 0 && !pieces.empty());
        if (fits && wanted)
        {
            pieces.back().end_run = i + 1;
            pieces.back().bytes += bytes;
        }
        else
        {
            pieces.push_back({i, i + 1, bytes, layer});
        }
        open = pieces.back().bytes < kLeastChunkBytes;
        const bool last_of_layer =
            i + 1 == runs.size() || runs[i + 1].first / layout.packets_per_layer() != layer;
        if (!last_of_layer || !open || pieces.size() < 2)
        {
            continue;
        }
        Piece& before = pieces[pieces.size() - 2];
        const bool joins = before.layer == pieces.back().layer || i + 1 == runs.size();
        if (joins && before.bytes + pieces.back().bytes <= kMostJoinedBytes)
        {
            before.end_run = pieces.back().end_run;
            before.bytes += pieces.back().bytes;
            pieces.pop_back();
            open = false;
        }
    }
    return pieces;
}

std::vector<std::byte> make_payload(
    std::span<const Run> runs,
    const CodedPackets& coded,
    const TextureHeader& header,
    std::uint32_t image
)
{
    ByteWriter writer;
    writer.write_varint(image);
    writer.write_varint(runs.front().first);
    if (runs.front().first == 0)
    {
        write_texture_header(header, writer);
    }
    for (const Run& run : runs)
    {
        writer.write_varint(run.count);
        writer.write_varint(sent_bytes(run));
        writer.write_bytes(std::span(coded.bytes).subspan(run.offset, sent_bytes(run)));
    }
    return writer.take();
}

}  // namespace

std::vector<TextureChunk> cut_chunks(
    const CodedPackets& coded, const TextureHeader& header, std::uint32_t image
)
{
    const TextureLayout layout(header);
    VSPLIT_ASSERT(coded.lengths.size() == layout.packet_count());
    const std::vector<Run> runs = make_runs(coded, layout);
    std::vector<TextureChunk> chunks;
    for (const Piece& piece : make_pieces(runs, layout))
    {
        const auto own = std::span(runs).subspan(piece.first_run, piece.end_run - piece.first_run);
        unsigned group = layout.group_of(own.front().first);
        for (const Run& run : own)
        {
            group = std::min(group, layout.group_of(run.first));
        }
        chunks.push_back({
            .layer = static_cast<unsigned>(piece.layer),
            .group = group,
            .tag = texture_tag(image, group),
            .payload = make_payload(own, coded, header, image),
        });
    }
    return chunks;
}

}  // namespace vsplit::image
