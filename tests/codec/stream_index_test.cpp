#include "codec/header_sample.h"
#include "codec/index_coder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace vsplit::test {
namespace {

using codec::ChunkInfo;
using codec::parse_stream_info;
using codec::StreamInfo;
using proto::ChunkKind;

TEST(StreamIndex, KeepsEveryRowOfTheIndex)
{
    const StreamInfo written = sample_info();
    const auto read = parse_stream_info(write_header(written));
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
        EXPECT_EQ(read->chunks[i].shift, written.chunks[i].shift);
        EXPECT_EQ(read->chunks[i].offset, offset);
        offset += read->chunks[i].bytes;
    }
    for (const std::size_t i : {0U, 2U})
    {
        EXPECT_GE(read->chunks[i].rms_error, written.chunks[i].rms_error);
        EXPECT_LE(read->chunks[i].rms_error, written.chunks[i].rms_error * 1.091);
        EXPECT_GE(read->chunks[i].max_error, written.chunks[i].max_error);
        EXPECT_LE(read->chunks[i].max_error, written.chunks[i].max_error * 1.091);
    }
}

/// Levels of every kind: much growth and little, a boundary or none, one chunk or many.
StreamInfo random_info(std::mt19937& random)
{
    const auto below = [&](std::uint32_t most) {
        return static_cast<std::uint32_t>(random() % most);
    };
    StreamInfo info = sample_info();
    ChunkInfo last{.kind = ChunkKind::Base, .bytes = 4 + below(1U << below(20))};
    last.vertices = 3 + below(1U << below(16));
    last.faces = below(2) == 0 ? 2 * last.vertices - 4 : 1 + below(2 * last.vertices);
    last.faces = std::max(last.faces, 1U);
    last.shift = static_cast<int>(below(10));
    info.chunks = {last};
    last.kind = ChunkKind::Batch;
    for (std::uint32_t rows = below(40); rows > 0; --rows)
    {
        const bool starts = info.chunks.back().ends_level;
        const int drop = starts && below(3) == 0
                             ? static_cast<int>(below(1U + static_cast<unsigned>(last.shift)))
                             : 0;
        last.shift -= drop;
        // Refinement of more vertices than fit comes in chunks of its own.
        const std::uint32_t refined =
            drop > 0 ? (last.vertices - 1) / codec::refined_per_chunk(drop) : 0;
        last.ends_level = false;
        last.bytes = 4 + below(1U << below(17));
        info.chunks.insert(info.chunks.end(), refined, last);
        last.ends_level = rows == 1 || below(3) == 0;
        const std::uint32_t splits = below(1U << below(16));
        last.vertices += splits;
        last.faces += 2 * splits - (below(2) == 0 ? 0 : below(splits + 1));
        last.bytes = 4 + below(1U << below(17));
        info.chunks.push_back(last);
        if (below(8) == 0)
        {
            ChunkInfo optional = last;
            optional.kind = static_cast<ChunkKind>(64 + below(100));
            optional.codec = static_cast<std::uint8_t>(below(256));
            info.chunks.push_back(optional);
        }
    }
    return info;
}

TEST(StreamIndex, KeepsTheRowsOfAnyStream)
{
    std::mt19937 random(7);
    for (int round = 0; round < 2000; ++round)
    {
        SCOPED_TRACE(round);
        const StreamInfo written = random_info(random);
        const auto read = parse_stream_info(write_header(written));
        ASSERT_TRUE(read.has_value()) << describe(read.error());
        ASSERT_EQ(read->chunks.size(), written.chunks.size());
        for (std::size_t i = 0; i < written.chunks.size(); ++i)
        {
            const ChunkInfo& chunk = read->chunks[i];
            ASSERT_EQ(chunk.kind, written.chunks[i].kind);
            ASSERT_EQ(chunk.codec, written.chunks[i].codec);
            ASSERT_EQ(chunk.ends_level, written.chunks[i].ends_level);
            ASSERT_EQ(chunk.bytes, written.chunks[i].bytes);
            ASSERT_EQ(chunk.vertices, written.chunks[i].vertices);
            ASSERT_EQ(chunk.faces, written.chunks[i].faces);
            ASSERT_EQ(chunk.shift, written.chunks[i].shift);
        }
    }
}

/// A stream as the encoder makes them: levels that grow by a third, in chunks as long as is to be
/// expected.
StreamInfo usual_info()
{
    StreamInfo info = sample_info();
    ChunkInfo last{
        .kind = ChunkKind::Base, .bytes = 70, .vertices = 20, .faces = 36, .rms_error = 7.0};
    last.max_error = 20.0;
    info.chunks = {last};
    last.kind = ChunkKind::Batch;
    while (last.vertices < 5000)
    {
        const std::uint32_t splits = last.vertices / 3;
        last.vertices += splits;
        last.faces += 2 * splits;
        last.bytes = 6 + splits * 14 / 8;
        last.rms_error *= 0.75;
        last.max_error *= 0.75;
        info.chunks.push_back(last);
    }
    return info;
}

TEST(StreamIndex, SpendsLittleOnWhatIsToBeExpected)
{
    const StreamInfo info = usual_info();
    EXPECT_LT(write_header(info).size(), 50 + 2 * info.chunks.size());
}

TEST(StreamIndex, GroupsChunksIntoLevels)
{
    const auto read = parse_stream_info(write_header(sample_info()));
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

TEST(StreamIndex, KeepsErrorsOfZero)
{
    StreamInfo info = sample_info();
    for (ChunkInfo& chunk : info.chunks)
    {
        chunk.rms_error = 0.0;
        chunk.max_error = 0.0;
    }
    const auto read = parse_stream_info(write_header(info));
    ASSERT_TRUE(read.has_value());
    for (const ChunkInfo& chunk : read->chunks)
    {
        EXPECT_EQ(chunk.rms_error, 0.0);
        EXPECT_EQ(chunk.max_error, 0.0);
    }
}

TEST(StreamIndex, RejectsBytesThatNoRowNeeds)
{
    Bytes header = write_header(sample_info());
    header.insert(header.begin() + kIndexOffset, 2, std::byte{0});
    header[kLengthOffset] = static_cast<std::byte>(header.size());
    repair_checksums(header);
    EXPECT_EQ(code_of(header), ErrorCode::BadHeader);
}

TEST(StreamIndex, HoldsMoreRowsThanALengthOfOneOrTwoBytesCounts)
{
    for (const std::size_t rows : {20U, 200U, 20000U})
    {
        StreamInfo info = sample_info();
        info.chunks.resize(1);
        std::mt19937 random(3);
        for (std::size_t i = 0; i < rows; ++i)
        {
            ChunkInfo next = info.chunks.back();
            next.kind = ChunkKind::Batch;
            next.ends_level = i + 1 == rows;
            next.vertices += 100;
            next.faces += 200;
            next.bytes = static_cast<std::uint32_t>(100 + random() % 500);
            info.chunks.push_back(next);
        }
        const Bytes header = write_header(info);
        const auto read = parse_stream_info(header);
        ASSERT_TRUE(read.has_value()) << describe(read.error());
        EXPECT_EQ(read->header_bytes, header.size());
        EXPECT_EQ(read->chunks.size(), rows + 1);
        EXPECT_EQ(read->chunks.back().bytes, info.chunks.back().bytes);
    }
}

TEST(StreamIndex, RefusesUnknownRequiredKindsAndCodecs)
{
    StreamInfo info = sample_info();
    info.chunks[1].kind = static_cast<ChunkKind>(4);
    EXPECT_EQ(code_of(write_header(info)), ErrorCode::UnknownRequiredChunk);
    info = sample_info();
    info.chunks[1].codec = 1;
    EXPECT_EQ(code_of(write_header(info)), ErrorCode::UnknownRequiredChunk);
    info = sample_info();
    info.chunks[0].codec = 2;
    EXPECT_EQ(code_of(write_header(info)), ErrorCode::UnknownRequiredChunk);
}

TEST(StreamIndex, AcceptsUnknownOptionalKindsAndCodecs)
{
    StreamInfo info = sample_info();
    info.chunks[3].kind = static_cast<ChunkKind>(200);
    EXPECT_EQ(code_of(write_header(info)), ErrorCode::Ok);
    info.chunks[3].kind = ChunkKind::Stitch;
    info.chunks[3].codec = 9;
    EXPECT_EQ(code_of(write_header(info)), ErrorCode::Ok);
}

TEST(StreamIndex, WantsOnlyOneBase)
{
    StreamInfo info = sample_info();
    info.chunks[3] = info.chunks[0];
    EXPECT_EQ(code_of(write_header(info)), ErrorCode::BadHeader);
}

/// A level of parts in two chunks behind the base of sample_info().
StreamInfo parts_info()
{
    StreamInfo info = sample_info();
    const ChunkInfo first{
        .kind = ChunkKind::Parts, .ends_level = false, .bytes = 33, .vertices = 13, .faces = 17};
    ChunkInfo last{.kind = ChunkKind::Parts, .bytes = 90, .vertices = 19, .faces = 24};
    last.rms_error = 1.0;
    last.max_error = 3.0;
    const auto place = info.chunks.insert(info.chunks.begin() + 1, {first, last});
    place[0].shift = 4;
    place[1].shift = 4;
    for (std::size_t i = 3; i < info.chunks.size(); ++i)
    {
        info.chunks[i].vertices += 9;
        info.chunks[i].faces += 8;
    }
    return info;
}

TEST(StreamIndex, KeepsRowsOfParts)
{
    const StreamInfo written = parts_info();
    const auto read = parse_stream_info(write_header(written));
    ASSERT_TRUE(read.has_value()) << describe(read.error());
    ASSERT_EQ(read->chunks.size(), written.chunks.size());
    for (std::size_t i = 0; i < written.chunks.size(); ++i)
    {
        SCOPED_TRACE(i);
        EXPECT_EQ(read->chunks[i].kind, written.chunks[i].kind);
        EXPECT_EQ(read->chunks[i].bytes, written.chunks[i].bytes);
        EXPECT_EQ(read->chunks[i].ends_level, written.chunks[i].ends_level);
        EXPECT_EQ(read->chunks[i].vertices, written.chunks[i].vertices);
        EXPECT_EQ(read->chunks[i].faces, written.chunks[i].faces);
        EXPECT_EQ(read->chunks[i].shift, written.chunks[i].shift);
    }
    ASSERT_EQ(read->levels.size(), 3U);
    EXPECT_EQ(read->levels[1].vertices, 19U);
    EXPECT_EQ(read->levels[1].chunk_bytes, 123U);
    EXPECT_NEAR(read->levels[1].rms_error, 1.0, 0.1);
}

TEST(StreamIndex, WantsPartsOnlyBetweenLevels)
{
    ASSERT_EQ(code_of(write_header(parts_info())), ErrorCode::Ok);
    StreamInfo info = parts_info();
    info.chunks[2].ends_level = false;  // and splits follow
    EXPECT_EQ(code_of(write_header(info)), ErrorCode::BadHeader);
    info.chunks.resize(3);  // and nothing follows
    EXPECT_EQ(code_of(write_header(info)), ErrorCode::BadHeader);
    info = parts_info();
    std::swap(info.chunks[2], info.chunks[3]);  // splits of a level that is open
    EXPECT_EQ(code_of(write_header(info)), ErrorCode::BadHeader);
    info = parts_info();
    ChunkInfo growth = info.chunks[4];
    growth.kind = ChunkKind::Growth;
    info.chunks.insert(info.chunks.begin() + 1, growth);  // behind a growth
    EXPECT_EQ(code_of(write_header(info)), ErrorCode::BadHeader);
    info = parts_info();
    info.chunks[0].kind = ChunkKind::Parts;  // the first row is that of a base whatever it is
    info.chunks[0].codec = 2;
    EXPECT_EQ(code_of(write_header(info)), ErrorCode::UnknownRequiredChunk);
}

TEST(StreamIndex, RejectsPartsOfTooManyOrTooFew)
{
    const auto with = [](std::uint32_t vertices, std::uint32_t faces) {
        StreamInfo info = sample_info();
        ChunkInfo parts = info.chunks[0];
        parts.kind = ChunkKind::Parts;
        parts.vertices += vertices;
        parts.faces += faces;
        info.chunks = {info.chunks[0], parts};
        return code_of(write_header(info));
    };
    EXPECT_EQ(with(3, 1), ErrorCode::Ok);
    EXPECT_EQ(with(4096, 3 * 4096), ErrorCode::Ok);
    EXPECT_EQ(with(2, 1), ErrorCode::BadHeader);
    EXPECT_EQ(with(3, 0), ErrorCode::BadHeader);
    EXPECT_EQ(with(3, 10), ErrorCode::BadHeader);
    EXPECT_EQ(with(4097, 4097), ErrorCode::BadHeader);
    EXPECT_EQ(with(0xFFFFFFFF, 1), ErrorCode::BadHeader);
}

TEST(StreamIndex, RefusesPartsBeyondItsLimits)
{
    const Bytes header = write_header(parts_info());
    EXPECT_EQ(code_of(header, {.max_vertices = 38}), ErrorCode::LimitExceeded);
    EXPECT_EQ(code_of(header, {.max_chunk_bytes = 89}), ErrorCode::LimitExceeded);
}

TEST(StreamIndex, WantsTheLastLevelToEnd)
{
    StreamInfo info = sample_info();
    info.chunks[2].ends_level = false;
    EXPECT_EQ(code_of(write_header(info)), ErrorCode::BadHeader);
}

TEST(StreamIndex, WantsABase)
{
    StreamInfo info = sample_info();
    info.chunks.clear();
    EXPECT_EQ(code_of(write_header(info)), ErrorCode::BadHeader);
    info = sample_info();
    info.chunks[0].vertices = 2;
    EXPECT_EQ(code_of(write_header(info)), ErrorCode::BadHeader);
    info = sample_info();
    info.chunks[0].faces = 0;
    EXPECT_EQ(code_of(write_header(info)), ErrorCode::BadHeader);
    info = sample_info();
    info.chunks[0].shift = info.grid.bits;
    EXPECT_EQ(code_of(write_header(info)), ErrorCode::BadHeader);
}

TEST(StreamIndex, RejectsMoreVerticesOrFacesThanAStreamCanHave)
{
    StreamInfo info = sample_info();
    info.chunks.resize(1);
    info.chunks[0].vertices = proto::kMaxVertices;
    info.chunks[0].faces = proto::kMaxFaces;
    EXPECT_EQ(code_of(write_header(info)), ErrorCode::Ok);
    info.chunks[0].vertices = proto::kMaxVertices + 1;
    EXPECT_EQ(code_of(write_header(info)), ErrorCode::BadHeader);
    info.chunks[0].vertices = proto::kMaxVertices;
    info.chunks[0].faces = proto::kMaxFaces + 1;
    EXPECT_EQ(code_of(write_header(info)), ErrorCode::BadHeader);
    info = sample_info();
    info.chunks.resize(1);
    info.chunks[0].faces = proto::kMaxFaces;
    info.chunks.push_back({.bytes = 50, .vertices = 12, .faces = proto::kMaxFaces + 4});
    EXPECT_EQ(code_of(write_header(info)), ErrorCode::BadHeader);
}

}  // namespace
}  // namespace vsplit::test
