#include "codec/header_sample.h"
#include "core/byte_writer.h"
#include "core/crc32c.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace vsplit::test {
namespace {

using codec::DecodeLimits;
using codec::parse_stream_info;
using codec::StreamInfo;
using proto::ChunkKind;

TEST(StreamHeader, ComesBackAsItWasWritten)
{
    const StreamInfo written = sample_info();
    const Bytes header = write_header(written);
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

TEST(StreamHeader, KeepsAGridInDoublePrecision)
{
    StreamInfo info = sample_info();
    const std::size_t single = write_header(info).size();
    info.grid.origin[0] = 0.1;
    EXPECT_EQ(write_header(info).size(), single + 16);
    info.grid.origin = {0.1, -1e300, 1.0 / 3.0};
    info.grid.cell = 1e-9;
    const auto read = parse_stream_info(write_header(info));
    ASSERT_TRUE(read.has_value()) << describe(read.error());
    EXPECT_EQ(read->grid.origin, info.grid.origin);
    EXPECT_EQ(read->grid.cell, info.grid.cell);
}

TEST(StreamHeader, TakesABoxWithoutExtent)
{
    StreamInfo info = sample_info();
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
        StreamInfo info = sample_info();
        info.grid.bits = bits;
        const Bytes header = codec::write_stream_header(info, {1, 2, 3});
        const bool allowed = bits >= proto::kMinPositionBits && bits <= proto::kMaxPositionBits;
        EXPECT_EQ(code_of(header), allowed ? ErrorCode::Ok : ErrorCode::BadHeader) << bits;
    }
}

TEST(StreamHeader, RejectsEveryTruncation)
{
    const Bytes header = write_header(sample_info());
    for (std::size_t length = 0; length < header.size(); ++length)
    {
        const auto read = parse_stream_info(std::span(header).first(length));
        ASSERT_FALSE(read.has_value()) << length;
        EXPECT_EQ(read.error().code, ErrorCode::Truncated) << length;
    }
}

TEST(StreamHeader, RejectsEveryChangedByte)
{
    const Bytes header = write_header(sample_info());
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
    const Bytes header = write_header(sample_info());
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

TEST(StreamHeader, NeedsOnlyThePartThatIsTheHeader)
{
    Bytes longer = write_header(sample_info());
    longer.resize(longer.size() + 1000);
    EXPECT_EQ(code_of(longer), ErrorCode::Ok);
}

TEST(StreamHeader, RejectsOtherFilesAndOtherVersions)
{
    const Bytes header = write_header(sample_info());
    const auto with = [&](std::size_t index, unsigned value) {
        Bytes changed = header;
        changed[index] = static_cast<std::byte>(value);
        repair_checksums(changed);
        return code_of(changed);
    };
    EXPECT_EQ(with(0, 'X'), ErrorCode::BadMagic);
    EXPECT_EQ(with(4, 16 + proto::kStreamMinor), ErrorCode::UnsupportedVersion);
    EXPECT_EQ(with(4, 255), ErrorCode::UnsupportedVersion);
    EXPECT_EQ(with(4, proto::kStreamMinor + 1U), ErrorCode::UnsupportedVersion);
    EXPECT_EQ(
        with(kLengthOffset, 8), ErrorCode::BadHeader
    );  // shorter than magic, version and length
}

TEST(StreamHeader, RejectsALengthBeyondEveryLimit)
{
    Bytes header = write_header(sample_info());
    for (std::size_t i = 0; i < 4; ++i)
    {
        header[kLengthOffset + i] = std::byte{255};
    }
    EXPECT_EQ(code_of(header), ErrorCode::LimitExceeded);
    header[kLengthOffset + 3] = std::byte{127};
    EXPECT_EQ(code_of(header), ErrorCode::LimitExceeded);
}

TEST(StreamHeader, RejectsGridsThatAreNoGrids)
{
    const double infinity = std::numeric_limits<double>::infinity();
    for (const double bad : {infinity, -infinity, std::nan("")})
    {
        StreamInfo info = sample_info();
        info.grid.origin[1] = bad;
        EXPECT_EQ(code_of(write_header(info)), ErrorCode::BadHeader);
    }
    for (const double bad : {infinity, std::nan(""), 0.0, -1.0})
    {
        StreamInfo info = sample_info();
        info.grid.cell = bad;
        EXPECT_EQ(code_of(write_header(info)), ErrorCode::BadHeader);
    }
}

TEST(StreamHeader, RejectsABoxWithoutABound)
{
    StreamInfo info = sample_info();
    info.grid.cell = 1e306;
    EXPECT_EQ(code_of(write_header(info)), ErrorCode::BadHeader);
}

TEST(StreamHeader, KeepsTheBoxWhicheverAxisIsLongest)
{
    for (const std::array<std::int32_t, 3>& extent :
         {std::array{1023, 5, 1023},
          std::array{5, 1023, 0},
          std::array{0, 5, 1023},
          std::array{9, 8, 7}})
    {
        const StreamInfo info = sample_info();
        const auto read = parse_stream_info(codec::write_stream_header(info, extent));
        ASSERT_TRUE(read.has_value());
        EXPECT_EQ(read->box_max, dequantize(info.grid, extent));
    }
}

TEST(StreamHeader, ObeysEveryLimit)
{
    const Bytes header = write_header(sample_info());
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

/// A header with one attribute of each kind.
StreamInfo attributed_info()
{
    StreamInfo info = sample_info();
    info.wedge_count = 40;
    info.attributes.resize(4);
    info.attributes[0].origin = {0.25F, -1.0F};
    info.attributes[0].cell = 0.5F;
    info.attributes[1].kind = AttributeKind::Normal;
    info.attributes[1].components = 3;
    info.attributes[2] = {
        .kind = AttributeKind::Color, .set = 1, .components = 4, .bits = 16, .rgb = true};
    info.attributes[3].kind = AttributeKind::Scalar;
    info.attributes[3].components = 1;
    info.attributes[3].name = "warmth";
    return info;
}

TEST(StreamHeader, TellsOfAttributes)
{
    const StreamInfo wanted = attributed_info();
    const auto read = parse_stream_info(write_header(wanted));
    ASSERT_TRUE(read.has_value()) << describe(read.error());
    EXPECT_EQ(read->wedge_count, 40U);
    ASSERT_EQ(read->attributes.size(), 4U);
    for (std::size_t a = 0; a < 4; ++a)
    {
        EXPECT_EQ(read->attributes[a].kind, wanted.attributes[a].kind);
        EXPECT_EQ(read->attributes[a].set, wanted.attributes[a].set);
        EXPECT_EQ(read->attributes[a].components, wanted.attributes[a].components);
        EXPECT_EQ(read->attributes[a].bits, wanted.attributes[a].bits);
        EXPECT_EQ(read->attributes[a].rgb, wanted.attributes[a].rgb);
        EXPECT_EQ(read->attributes[a].name, wanted.attributes[a].name);
    }
    EXPECT_EQ(read->attributes[0].origin, wanted.attributes[0].origin);
    EXPECT_EQ(read->attributes[0].cell, 0.5F);
    EXPECT_EQ(read->attributes[2].cell, 1.0F / 65535.0F);
}

TEST(StreamHeader, RefusesAttributesThatCannotBe)
{
    const auto code_with = [](const std::function<void(StreamInfo&)>& change) {
        StreamInfo info = attributed_info();
        change(info);
        return code_of(write_header(info));
    };
    EXPECT_EQ(code_with([](auto&) {}), ErrorCode::Ok);
    const std::vector<std::function<void(StreamInfo&)>> changes{
        [](auto& info) { info.attributes[0].components = 3; },
        [](auto& info) { info.attributes[0].bits = 0; },
        [](auto& info) { info.attributes[0].bits = 17; },
        [](auto& info) { info.attributes[0].rgb = true; },
        [](auto& info) { info.attributes[0].cell = 0.0F; },
        [](auto& info) { info.attributes[0].origin[1] = std::numeric_limits<float>::infinity(); },
        [](auto& info) { info.attributes[1].bits = 1; },
        [](auto& info) { info.attributes[2].components = 2; },
        [](auto& info) { info.attributes[3].components = 5; },
        [](auto& info) { info.attributes[3].kind = static_cast<AttributeKind>(4); },
        [](auto& info) { info.attributes.resize(proto::kMaxAttributes + 1, info.attributes[0]); },
        [](auto& info) { info.wedge_count = info.vertex_count - 1; },
        [](auto& info) { info.wedge_count = 3 * info.face_count + 1; },
    };
    for (std::size_t i = 0; i < changes.size(); ++i)
    {
        EXPECT_EQ(code_with(changes[i]), ErrorCode::BadHeader) << i;
    }
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
