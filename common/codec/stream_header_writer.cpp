#include "codec/stream_header_writer.h"

#include "codec/error_scale.h"
#include "core/byte_writer.h"
#include "core/crc32c.h"

#include <algorithm>
#include <bit>

namespace vsplit::codec {
namespace {

std::uint64_t zigzag(std::int64_t value)
{
    return static_cast<std::uint64_t>(value) << 1 ^ static_cast<std::uint64_t>(value >> 63);
}

/// Length of the diagonal as the reader of the header will compute it.
double stored_diagonal(const StreamInfo& info, const std::array<std::int32_t, 3>& extent)
{
    StreamInfo stored;
    stored.box_min = dequantize(info.grid, {0, 0, 0});
    stored.box_max = dequantize(info.grid, extent);
    return stored.diagonal();
}

/// Writes rows of the index; keeps what each row is coded against.
class RowWriter
{
public:
    RowWriter(ByteWriter& out, double diagonal) : out_(out), diagonal_(diagonal) {}

    void write(const ChunkInfo& chunk)
    {
        const bool base = chunk.kind == proto::ChunkKind::Base;
        const std::uint32_t splits = chunk.vertices - vertices_;
        const std::uint32_t boundary = 2 * splits - (chunk.faces - faces_);
        out_.write_varint(
            std::uint64_t{chunk.bytes} * 4 + (chunk.ends_level ? 0 : proto::kRowContinuesLevel) +
            (!base && boundary != 0 ? proto::kRowHasBoundary : 0)
        );
        if (static_cast<std::uint8_t>(chunk.kind) >= proto::kFirstOptionalChunkKind)
        {
            return;
        }
        out_.write_varint(splits);
        if (base)
        {
            out_.write_varint(chunk.faces);
        }
        else if (boundary != 0)
        {
            out_.write_varint(boundary);
        }
        vertices_ = chunk.vertices;
        faces_ = chunk.faces;
        if (chunk.ends_level)
        {
            write_error(chunk.rms_error, rms_code_);
            write_error(chunk.max_error, max_code_);
        }
    }

private:
    void write_error(double error, std::uint32_t& previous)
    {
        const std::uint32_t code = error_to_code(diagonal_ > 0.0 ? error / diagonal_ : 0.0);
        out_.write_varint(zigzag(std::int64_t{code} - std::int64_t{previous}));
        previous = code;
    }

    ByteWriter& out_;
    double diagonal_;
    std::uint32_t vertices_ = 0;
    std::uint32_t faces_ = 0;
    std::uint32_t rms_code_ = 0;
    std::uint32_t max_code_ = 0;
};

bool fits_single_precision(const QuantizationGrid& grid)
{
    const auto fits = [](double number) {
        return static_cast<double>(static_cast<float>(number)) == number;
    };
    return std::ranges::all_of(grid.origin, fits) && fits(grid.cell);
}

void write_index(ByteWriter& out, const StreamInfo& info, double diagonal)
{
    out.write_varint(info.chunks.size());
    RowWriter rows(out, diagonal);
    for (std::size_t begin = 0; begin < info.chunks.size();)
    {
        const ChunkInfo& first = info.chunks[begin];
        std::size_t end = begin + 1;
        while (end < info.chunks.size() && info.chunks[end].kind == first.kind &&
               info.chunks[end].codec == first.codec)
        {
            ++end;
        }
        out.write_varint(end - begin);
        out.write(static_cast<std::uint8_t>(first.kind));
        out.write(first.codec);
        for (; begin < end; ++begin)
        {
            rows.write(info.chunks[begin]);
        }
    }
}

}  // namespace

std::vector<std::byte> write_stream_header(
    const StreamInfo& info, const std::array<std::int32_t, 3>& extent
)
{
    ByteWriter body;
    const bool single = fits_single_precision(info.grid);
    body.write(
        static_cast<std::uint8_t>(info.grid.bits + (single ? proto::kSinglePrecisionGrid : 0))
    );
    for (const double number :
         {info.grid.origin[0], info.grid.origin[1], info.grid.origin[2], info.grid.cell})
    {
        if (single)
        {
            body.write(std::bit_cast<std::uint32_t>(static_cast<float>(number)));
        }
        else
        {
            body.write_f64(number);
        }
    }
    for (const std::int32_t index : extent)
    {
        body.write_varint(static_cast<std::uint64_t>(index));
    }
    body.write_varint(info.vertex_count);
    body.write_varint(info.face_count);
    body.write(info.content_checksum);
    body.write_varint(0);  // No attributes in version 0.
    write_index(body, info, stored_diagonal(info, extent));

    ByteWriter header;
    header.write(proto::kStreamMagic);
    header.write(proto::kStreamMajor);
    header.write(proto::kStreamMinor);
    header.write(std::uint16_t{0});
    header.write(static_cast<std::uint32_t>(proto::kFixedHeaderBytes + body.size()));
    header.write(crc32c(body.view(), crc32c(header.view())));
    header.write_bytes(body.view());
    return header.take();
}

}  // namespace vsplit::codec
