#include "codec/stream_header_writer.h"
#include "codec/stream_info.h"
#include "codec/stream_parts.h"
#include "core/byte_writer.h"
#include "core/crc32c.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vsplit::test {
namespace {

using codec::ChunkInfo;
using codec::DecodeLimits;
using codec::parse_stream_info;
using codec::StreamInfo;
using proto::ChunkKind;

/// A header with two levels, the second one in two chunks, and stitches at the end.
StreamInfo sample()
{
    StreamInfo info;
    info.grid = {.origin = {-1.5, 0.25, 100.0}, .cell = 0.125, .bits = 10};
    info.content_checksum = 0x12345678;
    info.chunks = {
        {.kind = ChunkKind::Base, .bytes = 100, .vertices = 10, .faces = 16, .rms_error = 3.0},
        {.ends_level = false, .bytes = 50, .vertices = 20, .faces = 35},
        {.bytes = 70, .vertices = 30, .faces = 55, .rms_error = 0.5, .max_error = 2.0},
        {.kind = ChunkKind::Stitch, .bytes = 9, .vertices = 30, .faces = 55},
    };
    info.chunks[0].max_error = 7.0;
    info.vertex_count = 30;
    info.face_count = 55;
    return info;
}

constexpr std::array<std::int32_t, 3> kExtent{1023, 500, 0};

Bytes write(const StreamInfo& info)
{
    return codec::write_stream_header(info, kExtent);
}

ErrorCode code_of(const Bytes& header, const DecodeLimits& limits = {})
{
    const auto info = parse_stream_info(header, limits);
    return info ? ErrorCode::Ok : info.error().code;
}

TEST(StreamHeader, ComesBackAsItWasWritten)
{
    const StreamInfo written = sample();
    const Bytes header = write(written);
    const auto read = parse_stream_info(header);
    ASSERT_TRUE(read.has_value()) << describe(read.error());
    EXPECT_EQ(read->major, proto::kStreamMajor);
    EXPECT_EQ(read->minor, proto::kStreamMinor);
    EXPECT_EQ(read->grid.origin, written.grid.origin);
    EXPECT_EQ(read->grid.cell, written.grid.cell);
    EXPECT_EQ(read->grid.bits, written.grid.bits);
    EXPECT_EQ(read->box_min, written.grid.origin);
    EXPECT_EQ(read->box_max, dequantize(written.grid, kExtent));
    EXPECT_EQ(read->vertex_count, 30U);
    EXPECT_EQ(read->face_count, 55U);
    EXPECT_EQ(read->content_checksum, 0x12345678U);
    EXPECT_EQ(read->header_bytes, header.size());
    EXPECT_EQ(read->file_bytes, header.size() + 100 + 50 + 70 + 9);
}

TEST(StreamHeader, KeepsEveryRowOfTheIndex)
{
    const StreamInfo written = sample();
    const auto read = parse_stream_info(write(written));
    ASSERT_TRUE(read.has_value());
    ASSERT_EQ(read->chunks.size(), written.chunks.size());
    std::uint64_t offset = read->header_bytes;
    for (std::size_t i = 0; i < written.chunks.size(); ++i)
    {
        SCOPED_TRACE(i);
        EXPECT_EQ(read->chunks[i].kind, written.chunks[i].kind);
        EXPECT_EQ(read->chunks[i].bytes, written.chunks[i].bytes);
        EXPECT_EQ(read->chunks[i].ends_level, written.chunks[i].ends_level);
        EXPECT_EQ(read->chunks[i].vertices, written.chunks[i].vertices);
        EXPECT_EQ(read->chunks[i].faces, written.chunks[i].faces);
        EXPECT_EQ(read->chunks[i].offset, offset);
        offset += read->chunks[i].bytes;
    }
    for (const std::size_t i : {0U, 2U})
    {
        EXPECT_GE(read->chunks[i].rms_error, written.chunks[i].rms_error);
        EXPECT_LE(read->chunks[i].rms_error, written.chunks[i].rms_error * 1.022);
        EXPECT_GE(read->chunks[i].max_error, written.chunks[i].max_error);
        EXPECT_LE(read->chunks[i].max_error, written.chunks[i].max_error * 1.022);
    }
}

TEST(StreamHeader, GroupsChunksIntoLevels)
{
    const auto read = parse_stream_info(write(sample()));
    ASSERT_TRUE(read.has_value());
    ASSERT_EQ(read->levels.size(), 2U);
    EXPECT_EQ(read->levels[0].vertices, 10U);
    EXPECT_EQ(read->levels[0].chunk_bytes, 100U);
    EXPECT_EQ(read->levels[0].cumulative_bytes, read->header_bytes + 100U);
    EXPECT_EQ(read->levels[1].level, 1U);
    EXPECT_EQ(read->levels[1].faces, 55U);
    EXPECT_EQ(read->levels[1].chunk_bytes, 50U + 70U + 9U);
    EXPECT_EQ(read->levels[1].cumulative_bytes, read->file_bytes);
}

TEST(StreamHeader, KeepsAGridInDoublePrecision)
{
    StreamInfo info = sample();
    const std::size_t single = write(info).size();
    info.grid.origin[0] = 0.1;
    EXPECT_EQ(write(info).size(), single + 16);
    info.grid.origin = {0.1, -1e300, 1.0 / 3.0};
    info.grid.cell = 1e-9;
    const auto read = parse_stream_info(write(info));
    ASSERT_TRUE(read.has_value()) << describe(read.error());
    EXPECT_EQ(read->grid.origin, info.grid.origin);
    EXPECT_EQ(read->grid.cell, info.grid.cell);
}

TEST(StreamHeader, KeepsErrorsOfZero)
{
    StreamInfo info = sample();
    for (ChunkInfo& chunk : info.chunks)
    {
        chunk.rms_error = 0.0;
        chunk.max_error = 0.0;
    }
    const auto read = parse_stream_info(write(info));
    ASSERT_TRUE(read.has_value());
    for (const ChunkInfo& chunk : read->chunks)
    {
        EXPECT_EQ(chunk.rms_error, 0.0);
        EXPECT_EQ(chunk.max_error, 0.0);
    }
}

TEST(StreamHeader, TakesABoxWithoutExtent)
{
    StreamInfo info = sample();
    const Bytes header = codec::write_stream_header(info, {0, 0, 0});
    const auto read = parse_stream_info(header);
    ASSERT_TRUE(read.has_value());
    EXPECT_EQ(read->diagonal(), 0.0);
    EXPECT_EQ(read->chunks[0].rms_error, 0.0);
}

TEST(StreamHeader, TakesEveryAllowedNumberOfPositionBits)
{
    for (int bits = 0; bits < 32; ++bits)
    {
        StreamInfo info = sample();
        info.grid.bits = bits;
        const Bytes header = codec::write_stream_header(info, {1, 2, 3});
        const bool allowed = bits >= proto::kMinPositionBits && bits <= proto::kMaxPositionBits;
        EXPECT_EQ(code_of(header), allowed ? ErrorCode::Ok : ErrorCode::BadHeader) << bits;
    }
}

TEST(StreamHeader, RejectsEveryTruncation)
{
    const Bytes header = write(sample());
    for (std::size_t length = 0; length < header.size(); ++length)
    {
        const auto read = parse_stream_info(std::span(header).first(length));
        ASSERT_FALSE(read.has_value()) << length;
        EXPECT_EQ(read.error().code, ErrorCode::Truncated) << length;
    }
}

TEST(StreamHeader, RejectsEveryChangedByte)
{
    const Bytes header = write(sample());
    for (std::size_t i = 0; i < header.size(); ++i)
    {
        for (int change = 1; change < 256; ++change)
        {
            Bytes changed = header;
            changed[i] ^= static_cast<std::byte>(change);
            EXPECT_NE(code_of(changed), ErrorCode::Ok) << "byte " << i;
        }
    }
}

TEST(StreamHeader, ChecksEveryFieldBehindARightChecksum)
{
    const Bytes header = write(sample());
    for (std::size_t i = 0; i < header.size(); ++i)
    {
        for (int change = 1; change < 256; ++change)
        {
            Bytes changed = header;
            changed[i] ^= static_cast<std::byte>(change);
            repair_checksums(changed);
            const auto read = parse_stream_info(changed);
            if (!read)
            {
                EXPECT_NE(read.error().code, ErrorCode::Internal);
                continue;
            }
            // What was accepted hangs together.
            EXPECT_EQ(read->levels.back().vertices, read->vertex_count);
            EXPECT_EQ(read->levels.back().faces, read->face_count);
            EXPECT_EQ(read->chunks.back().offset + read->chunks.back().bytes, read->file_bytes);
            EXPECT_EQ(read->chunks.front().kind, ChunkKind::Base);
        }
    }
}

TEST(StreamHeader, RejectsBytesBehindTheIndex)
{
    Bytes header = write(sample());
    header.push_back(std::byte{0});
    header[8] = static_cast<std::byte>(static_cast<unsigned>(header[8]) + 1U);
    repair_checksums(header);
    EXPECT_EQ(code_of(header), ErrorCode::BadHeader);
}

TEST(StreamHeader, NeedsOnlyThePartThatIsTheHeader)
{
    Bytes longer = write(sample());
    longer.resize(longer.size() + 1000);
    EXPECT_EQ(code_of(longer), ErrorCode::Ok);
}

TEST(StreamHeader, RejectsOtherFilesAndOtherVersions)
{
    const Bytes header = write(sample());
    const auto with = [&](std::size_t index, unsigned value) {
        Bytes changed = header;
        changed[index] = static_cast<std::byte>(value);
        repair_checksums(changed);
        return code_of(changed);
    };
    EXPECT_EQ(with(0, 'X'), ErrorCode::BadMagic);
    EXPECT_EQ(with(4, proto::kStreamMajor + 1U), ErrorCode::UnsupportedVersion);
    EXPECT_EQ(with(4, 255), ErrorCode::UnsupportedVersion);
    EXPECT_EQ(with(5, proto::kStreamMinor + 1U), ErrorCode::UnsupportedVersion);
    EXPECT_EQ(with(6, 1), ErrorCode::BadHeader);   // flags
    EXPECT_EQ(with(8, 15), ErrorCode::BadHeader);  // shorter than its fixed part
}

TEST(StreamHeader, RefusesUnknownRequiredKindsAndCodecs)
{
    StreamInfo info = sample();
    info.chunks[1].kind = static_cast<ChunkKind>(2);
    EXPECT_EQ(code_of(write(info)), ErrorCode::UnknownRequiredChunk);
    info = sample();
    info.chunks[1].codec = 1;
    EXPECT_EQ(code_of(write(info)), ErrorCode::UnknownRequiredChunk);
    info = sample();
    info.chunks[0].codec = 1;
    EXPECT_EQ(code_of(write(info)), ErrorCode::UnknownRequiredChunk);
}

TEST(StreamHeader, AcceptsUnknownOptionalKindsAndCodecs)
{
    StreamInfo info = sample();
    info.chunks[3].kind = static_cast<ChunkKind>(200);
    EXPECT_EQ(code_of(write(info)), ErrorCode::Ok);
    info.chunks[3].kind = ChunkKind::Stitch;
    info.chunks[3].codec = 9;
    EXPECT_EQ(code_of(write(info)), ErrorCode::Ok);
}

TEST(StreamHeader, WantsTheBaseFirstAndOnlyThere)
{
    StreamInfo info = sample();
    info.chunks.erase(info.chunks.begin());
    EXPECT_EQ(code_of(write(info)), ErrorCode::BadHeader);
    info = sample();
    info.chunks.insert(info.chunks.begin() + 2, info.chunks[0]);
    EXPECT_NE(code_of(write(info)), ErrorCode::Ok);
    info = sample();
    std::swap(info.chunks[0], info.chunks[3]);
    EXPECT_EQ(code_of(write(info)), ErrorCode::BadHeader);
}

TEST(StreamHeader, WantsTheLastLevelToEnd)
{
    StreamInfo info = sample();
    info.chunks[2].ends_level = false;
    EXPECT_EQ(code_of(write(info)), ErrorCode::BadHeader);
}

TEST(StreamHeader, WantsCountsThatAddUp)
{
    for (const int difference : {-1, 1})
    {
        StreamInfo info = sample();
        info.vertex_count += difference;
        EXPECT_EQ(code_of(write(info)), ErrorCode::BadHeader);
        info = sample();
        info.face_count += difference;
        EXPECT_EQ(code_of(write(info)), ErrorCode::BadHeader);
    }
    StreamInfo info = sample();
    info.chunks.clear();
    EXPECT_EQ(code_of(write(info)), ErrorCode::BadHeader);
}

TEST(StreamHeader, RejectsGridsThatAreNoGrids)
{
    const double infinity = std::numeric_limits<double>::infinity();
    for (const double bad : {infinity, -infinity, std::nan("")})
    {
        StreamInfo info = sample();
        info.grid.origin[1] = bad;
        EXPECT_EQ(code_of(write(info)), ErrorCode::BadHeader);
    }
    for (const double bad : {infinity, std::nan(""), 0.0, -1.0})
    {
        StreamInfo info = sample();
        info.grid.cell = bad;
        EXPECT_EQ(code_of(write(info)), ErrorCode::BadHeader);
    }
}

TEST(StreamHeader, RejectsABoxBeyondTheGrid)
{
    const Bytes header = codec::write_stream_header(sample(), {1024, 0, 0});
    EXPECT_EQ(code_of(header), ErrorCode::BadHeader);
}

TEST(StreamHeader, ObeysEveryLimit)
{
    const Bytes header = write(sample());
    const auto heap = codec::decoder_heap_bytes(parse_stream_info(header).value());
    const auto size = static_cast<std::uint32_t>(header.size());
    EXPECT_EQ(
        code_of(
            header,
            {.max_vertices = 30,
             .max_faces = 55,
             .max_header_bytes = size,
             .max_chunk_bytes = 100,
             .max_heap_bytes = heap}
        ),
        ErrorCode::Ok
    );
    EXPECT_EQ(code_of(header, {.max_vertices = 29}), ErrorCode::LimitExceeded);
    EXPECT_EQ(code_of(header, {.max_faces = 54}), ErrorCode::LimitExceeded);
    EXPECT_EQ(code_of(header, {.max_header_bytes = size - 1}), ErrorCode::LimitExceeded);
    EXPECT_EQ(code_of(header, {.max_chunk_bytes = 99}), ErrorCode::LimitExceeded);
    EXPECT_EQ(code_of(header, {.max_heap_bytes = heap - 1}), ErrorCode::LimitExceeded);
    EXPECT_EQ(code_of(header, {.max_heap_bytes = heap - 1, .max_level = 0}), ErrorCode::Ok);
}

TEST(StreamHeader, SkipsAnAttributeTableOfALaterVersion)
{
    // The table's count is the byte behind the content checksum.
    const Bytes header = write(sample());
    const std::size_t place = proto::kFixedHeaderBytes + 1 + 16 + 2 + 2 + 1 + 1 + 1 + 4;
    ASSERT_EQ(header[place], std::byte{0});
    Bytes longer(header.begin(), header.begin() + static_cast<std::ptrdiff_t>(place));
    for (const unsigned byte : {2U, 3U, 7U, 7U, 7U, 0U})  // two entries, of three and no bytes
    {
        longer.push_back(static_cast<std::byte>(byte));
    }
    longer.insert(
        longer.end(), header.begin() + static_cast<std::ptrdiff_t>(place) + 1, header.end()
    );
    longer[8] = static_cast<std::byte>(longer.size());
    repair_checksums(longer);
    const auto read = parse_stream_info(longer);
    ASSERT_TRUE(read.has_value()) << describe(read.error());
    EXPECT_EQ(read->chunks.size(), 4U);
}

TEST(ChunkContents, AreTheChunkWithoutItsChecksum)
{
    ByteWriter chunk;
    chunk.write(std::uint32_t{0xDEADBEEF});
    chunk.write(crc32c(chunk.view()));
    const auto contents = codec::chunk_contents(chunk.view(), 0);
    ASSERT_TRUE(contents.has_value());
    EXPECT_EQ(contents->size(), 4U);
    for (std::size_t length = 0; length < chunk.size(); ++length)
    {
        const auto bad = codec::chunk_contents(chunk.view().first(length), 77);
        ASSERT_FALSE(bad.has_value());
        EXPECT_EQ(bad.error().code, ErrorCode::BadChecksum);
        EXPECT_EQ(bad.error().offset, 77U);
    }
}

}  // namespace
}  // namespace vsplit::test
