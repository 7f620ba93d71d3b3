#include "codec/stream_header_writer.h"

#include "codec/entropy_coder.h"
#include "codec/error_scale.h"
#include "codec/index_coder.h"
#include "core/byte_writer.h"
#include "core/crc32c.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace vsplit::codec {
namespace {

/// Length of the diagonal as the reader of the header will compute it.
double stored_diagonal(const StreamInfo& info, const std::array<std::int32_t, 3>& extent)
{
    StreamInfo stored;
    stored.box_min = dequantize(info.grid, {0, 0, 0});
    stored.box_max = dequantize(info.grid, extent);
    return stored.diagonal();
}

/// Writes rows of the index; keeps what the next row needs.
class RowWriter
{
public:
    RowWriter(BitEncoder& bits, const StreamInfo& info, double diagonal)
        : index_(bits), info_(info), diagonal_(diagonal)
    {
    }

    /// Writes the row of chunk `i`. What is out of range is written as far as it can be: the reader
    /// refuses it.
    void write(std::size_t i)
    {
        const ChunkInfo& chunk = info_.chunks[i];
        IndexRow row{.kind = chunk.kind, .codec = chunk.codec, .bytes = chunk.bytes};
        row.shift = chunk.shift;
        row.rms_code = code_of(chunk.rms_error);
        row.max_code = code_of(chunk.max_error);
        if (i == 0)
        {
            row.vertices = chunk.vertices;
            row.faces = chunk.faces;
            static_cast<void>(index_.code_base(row));
        }
        else
        {
            index_.code_kind(row);
            if (is_optional(chunk.kind))
            {
                row.tag = chunk.tag;
                static_cast<void>(index_.code_optional(row));
                return;
            }
            if (chunk.kind == proto::ChunkKind::Growth)
            {
                write_growth(i, row);
                return;
            }
            row.vertices = chunk.vertices - vertices_;
            write_refinement(i, row);
        }
        vertices_ = chunk.vertices;
        faces_ = chunk.faces;
    }

    /// Writes the number of rows.
    void write_count()
    {
        static_cast<void>(index_.code_number(static_cast<std::uint32_t>(info_.chunks.size())));
    }

private:
    /// Writes the rest of the row of a Batch or Parts chunk.
    void write_refinement(std::size_t i, IndexRow& row)
    {
        const ChunkInfo& chunk = info_.chunks[i];
        if (chunk.kind == proto::ChunkKind::Parts)
        {
            row.faces = chunk.faces - faces_;
            row.ends_parts = chunk.ends_level;
            static_cast<void>(index_.code_parts(row));
            return;
        }
        row.boundary = 2 * row.vertices - (chunk.faces - faces_);
        count_level(i, row);
        static_cast<void>(index_.code_batch(row));
    }

    std::uint32_t code_of(double error) const
    {
        return error_to_code(diagonal_ > 0.0 ? error / diagonal_ : 0.0);
    }

    /// Writes the rest of the row of a Growth chunk, which tells of the level's end.
    void write_growth(std::size_t i, IndexRow& row)
    {
        count_level(i, row);
        const ChunkInfo& last = info_.chunks[last_of_level(i)];
        row.vertices = last.vertices;
        row.faces = last.faces;
        row.rms_code = code_of(last.rms_error);
        row.max_code = code_of(last.max_error);
        static_cast<void>(index_.code_growth(row));
    }

    /// Finds the chunk that ends the level of chunk `i`.
    std::size_t last_of_level(std::size_t i) const
    {
        while (i + 1 < info_.chunks.size() &&
               (is_optional(info_.chunks[i].kind) || !info_.chunks[i].ends_level))
        {
            ++i;
        }
        return i;
    }

    /// Finds chunks and splits of the level that begins with chunk `i`.
    void count_level(std::size_t i, IndexRow& row) const
    {
        std::uint32_t vertices = vertices_;
        bool open = true;
        for (; open && i < info_.chunks.size(); ++i)
        {
            const ChunkInfo& chunk = info_.chunks[i];
            if (!is_optional(chunk.kind))
            {
                ++row.level_chunks;
                vertices = chunk.vertices;
                open = !chunk.ends_level;
            }
        }
        row.level_chunks += open ? 1 : 0;
        row.level_vertices = vertices - vertices_;
    }

    IndexCoder<BitEncoder> index_;
    const StreamInfo& info_;
    double diagonal_;
    std::uint32_t vertices_ = 0;
    std::uint32_t faces_ = 0;
};

bool fits_single_precision(const QuantizationGrid& grid)
{
    const auto fits = [](double number) {
        return static_cast<double>(static_cast<float>(number)) == number;
    };
    return std::ranges::all_of(grid.origin, fits) && fits(grid.cell);
}

/// Codes the greatest indices; one axis, most often, spans the whole grid.
void code_extent(BitEncoder& bits, const QuantizationGrid& grid, std::array<std::int32_t, 3> extent)
{
    const auto full = std::ranges::find(extent, (std::int64_t{1} << grid.bits) - 1);
    const auto axis = full - extent.begin();
    bits.raw(static_cast<std::uint32_t>(axis), 2);
    for (std::ptrdiff_t i = 0; i < 3; ++i)
    {
        if (i != axis)
        {
            bits.raw(static_cast<std::uint32_t>(extent[static_cast<std::size_t>(i)]), grid.bits);
        }
    }
}

void write_attribute(ByteWriter& out, const AttributeInfo& info)
{
    ByteWriter entry;
    entry.write(static_cast<std::uint8_t>(
        info.components << 4 | (info.rgb ? proto::kRgbColor : 0) |
        static_cast<std::uint8_t>(info.kind)
    ));
    entry.write(info.set);
    entry.write(info.bits);
    if (has_grid(info))
    {
        for (std::size_t k = 0; k < info.components; ++k)
        {
            entry.write(std::bit_cast<std::uint32_t>(info.origin[k]));
        }
        entry.write(std::bit_cast<std::uint32_t>(info.cell));
    }
    entry.write_bytes(std::as_bytes(std::span(info.name)));
    out.write_varint(entry.size());
    out.write_bytes(entry.view());
}

void write_grid(ByteWriter& out, const QuantizationGrid& grid, bool attributes)
{
    const bool single = fits_single_precision(grid);
    out.write(static_cast<std::uint8_t>(
        grid.bits | (single ? proto::kSinglePrecisionGrid : 0) |
        (attributes ? proto::kHasAttributes : 0)
    ));
    for (const double number : {grid.origin[0], grid.origin[1], grid.origin[2], grid.cell})
    {
        if (single)
        {
            out.write(std::bit_cast<std::uint32_t>(static_cast<float>(number)));
        }
        else
        {
            out.write_f64(number);
        }
    }
}

}  // namespace

std::vector<std::byte> write_stream_header(
    const StreamInfo& info, const std::array<std::int32_t, 3>& extent
)
{
    ByteWriter body;
    const bool attributes = info.wedge_count > 0 || !info.attributes.empty();
    write_grid(body, info.grid, attributes);
    body.write(info.content_checksum);
    if (attributes)
    {
        body.write_varint(info.wedge_count);
        body.write_varint(info.attributes.size());
        for (const AttributeInfo& attribute : info.attributes)
        {
            write_attribute(body, attribute);
        }
    }
    BitEncoder bits;
    code_extent(bits, info.grid, extent);
    RowWriter rows(bits, info, stored_diagonal(info, extent));
    rows.write_count();
    for (std::size_t i = 0; i < info.chunks.size(); ++i)
    {
        rows.write(i);
    }
    bits.finish(body);

    ByteWriter header;
    header.write(proto::kStreamMagic);
    header.write(static_cast<std::uint8_t>(proto::kStreamMajor << 4 | proto::kStreamMinor));
    // The length counts its own bytes.
    const std::size_t rest = header.size() + body.size() + proto::kChunkChecksumBytes;
    std::size_t length_bytes = 1;
    while ((rest + length_bytes) >> (7 * length_bytes) != 0)
    {
        ++length_bytes;
    }
    header.write_varint(rest + length_bytes);
    header.write_bytes(body.view());
    header.write(crc32c(header.view()));
    return header.take();
}

Result<std::vector<std::byte>> replace_errors(
    std::span<const std::byte> file, std::span<const LevelErrors> errors
)
{
    auto info = parse_stream_info(file);
    VSPLIT_TRY(info);
    std::size_t level = 0;
    for (ChunkInfo& chunk : info->chunks)
    {
        if (is_optional(chunk.kind) || !chunk.ends_level)
        {
            continue;
        }
        if (level == errors.size())
        {
            return fail(ErrorCode::Internal, "the stream has more levels than errors");
        }
        chunk.rms_error = errors[level].rms;
        chunk.max_error = errors[level].max;
        ++level;
    }
    if (level != errors.size())
    {
        return fail(ErrorCode::Internal, "the stream has fewer levels than errors");
    }
    std::vector<std::byte> result = write_stream_header(*info, info->extent);
    const auto payload = file.subspan(info->header_bytes);
    result.insert(result.end(), payload.begin(), payload.end());
    return result;
}

Result<std::vector<std::byte>> insert_chunks(
    std::span<const std::byte> file,
    std::span<const ExtraChunk> extra,
    std::span<const std::uint32_t> tags
)
{
    auto info = parse_stream_info(file);
    VSPLIT_TRY(info);
    ByteWriter payload;
    std::vector<ChunkInfo> chunks;
    std::uint32_t checksum = 0;
    const auto append = [&](const ChunkInfo& chunk, std::span<const std::byte> bytes) {
        chunks.push_back(chunk);
        payload.write_bytes(bytes);
        checksum = crc32c(bytes.last(proto::kChunkChecksumBytes), checksum);
    };
    for (std::size_t i = 0; i < info->chunks.size(); ++i)
    {
        ChunkInfo& chunk = info->chunks[i];
        chunk.tag = tags.empty() ? chunk.tag : tags[i];
        append(chunk, file.subspan(chunk.offset, chunk.bytes));
        for (; !extra.empty() && extra.front().after <= i; extra = extra.subspan(1))
        {
            ByteWriter bytes;
            bytes.write_bytes(extra.front().bytes);
            bytes.write(crc32c(bytes.view()));
            ChunkInfo added = chunk;
            added.kind = extra.front().kind;
            added.codec = extra.front().codec;
            added.tag = extra.front().tag;
            added.bytes = static_cast<std::uint32_t>(bytes.size());
            append(added, bytes.view());
        }
    }
    if (!extra.empty())
    {
        return fail(ErrorCode::Internal, "a chunk follows none of the stream");
    }
    info->chunks = std::move(chunks);
    info->content_checksum = checksum;
    std::vector<std::byte> result = write_stream_header(*info, info->extent);
    const auto view = payload.view();
    result.insert(result.end(), view.begin(), view.end());
    return result;
}

}  // namespace vsplit::codec
