// The decoder promises what memory it needs before it takes any. This program counts every
// allocation, so it has an executable of its own.

#include "codec/attributed_samples.h"
#include "codec/base_mesh_encoder.h"
#include "codec/encoded_samples.h"
#include "codec/shapes.h"
#include "codec/stream_decoder.h"
#include "codec/stream_header_writer.h"
#include "precompute/mesh_io.h"
#include "tools/heap_meter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <sys/resource.h>

namespace vsplit::test {
namespace {

/// Largest heap while a stream is fed and decoded, the bytes fed not counted.
std::uint64_t peak_while_decoding(
    std::span<const std::byte> file, const codec::DecodeLimits& limits = {}
)
{
    tools::start_heap_meter();
    {
        codec::StreamDecoder decoder(limits);
        while (!decoder.complete() && decoder.step())
        {
            const auto taken = decoder.feed(file);
            if (!taken || (*taken == 0 && decoder.wanted_bytes() != 0))
            {
                break;
            }
            file = file.subspan(*taken);
        }
    }
    return tools::stop_heap_meter();
}

void expect_within_promise(const Bytes& file, const codec::StreamInfo& info)
{
    EXPECT_LE(peak_while_decoding(file), codec::decoder_heap_bytes(info));
    const auto levels = static_cast<std::uint32_t>(info.levels.size());
    for (std::uint32_t level = 0; level + 1 < levels; ++level)
    {
        const std::uint64_t promise = codec::decoder_heap_bytes(codec::prefix_info(info, level));
        EXPECT_LE(peak_while_decoding(file, {.max_level = level}), promise) << level;
    }
}

void expect_within_promise(const EncodedSample& sample)
{
    expect_within_promise(sample.file, sample.info);
}

TEST(DecoderHeap, StaysWithinItsPromiseForSmallMeshes)
{
    for (const NamedMesh& mesh : small_meshes())
    {
        SCOPED_TRACE(mesh.name);
        expect_within_promise(encode(mesh.make()));
    }
}

TEST(DecoderHeap, StaysWithinItsPromiseForTheAssets)
{
    for (const char* name : {"beast", "bracket", "terrain", "pair", "dirty"})
    {
        SCOPED_TRACE(name);
        const std::string path = std::string(VSPLIT_SOURCE_DIR "/assets/") + name + ".ply";
        expect_within_promise(encode(precompute::read_mesh(path).value()));
    }
}

TEST(DecoderHeap, StaysWithinItsPromiseForAttributes)
{
    for (const TexturedShape& shape : textured_shapes())
    {
        SCOPED_TRACE(shape.name);
        const AttributedSample sample = encode(attributed(shape, every_kind()));
        expect_within_promise(sample.file, sample.info);
    }
}

TEST(DecoderHeap, StaysWithinItsPromiseForManyAttributes)
{
    // Large, so that what the promise adds for everything else does not hide the attributes.
    const IndexedMesh mesh = torus(120, 100, 0.02, 1);
    const TexturedShape few = textured("few seams", mesh, 5, 0.01, 1);
    const TexturedShape many = textured("all split", mesh, 4000, 1.0, 1);
    for (const TexturedShape* shape : {&few, &many})
    {
        for (const bool grown : {true, false})
        {
            std::vector<codec::AttributeInfo> infos(
                8, {.kind = AttributeKind::Scalar, .components = 4, .bits = 3}
            );
            infos[5] = {.kind = AttributeKind::Normal, .components = 3, .bits = 5};
            for (const auto& chosen : {every_kind(), infos, std::vector<codec::AttributeInfo>{}})
            {
                SCOPED_TRACE(shape->name + std::to_string(chosen.size()));
                const AttributedSample sample =
                    encode(attributed(*shape, chosen), {.grow_last_level = grown, .threads = 2});
                const std::uint64_t peak = peak_while_decoding(sample.file);
                const std::uint64_t promise = codec::decoder_heap_bytes(sample.info);
                EXPECT_LE(peak, promise);
                // The base of the other one is so large that what Draco may need decides.
                EXPECT_TRUE(shape == &many || 2 * peak > promise) << peak << " of " << promise;
            }
        }
    }
}

TEST(DecoderHeap, StaysWithinItsPromiseForLargeBases)
{
    const precompute::EncodeOptions options{
        .metric = precompute::Metric::Qem, .base_vertices = 100000};
    expect_within_promise(encode(torus(300, 200, 0.01, 1), options));
    expect_within_promise(encode(height_field(200, 200, 0.3, 2), options));
}

TEST(DecoderHeap, StaysWithinItsPromiseWhereMuchIsStitched)
{
    // Large, so that what the promise adds for everything else does not hide the stitches.
    const EncodedSample large =
        encode(book(240), {.metric = precompute::Metric::Qem, .threads = 2});
    EXPECT_LE(peak_while_decoding(large.file), codec::decoder_heap_bytes(large.info));
    // Every square an island of its own whose corners repair leaves apart.
    expect_within_promise(encode(with_holes(height_field(150, 150, 0.3, 2), 0.5, 3)));
}

TEST(DecoderHeap, StaysWithinItsPromiseForABaseThatClaimsWideAttributes)
{
    const precompute::EncodeOptions options{
        .metric = precompute::Metric::Qem, .base_vertices = 100000};
    StreamParts parts = take_apart(encode(torus(120, 100, 0.01, 1), options).file);
    // Draco's description of the one attribute: position, 32-bit integers, three components.
    constexpr std::array kPositions{
        std::byte{1}, std::byte{0}, std::byte{5}, std::byte{3}, std::byte{0}, std::byte{0}};
    Bytes& base = parts.chunks[0];
    const auto place = std::ranges::search(base, kPositions).begin();
    ASSERT_NE(place, base.end());
    place[3] = std::byte{255};
    const Bytes file = put_together(parts);
    EXPECT_LE(peak_while_decoding(file), codec::decoder_heap_bytes(parts.info));
    EXPECT_EQ(decode(file).error.value().code, ErrorCode::BadChunk);
}

TEST(DecoderHeap, StaysWithinItsPromiseForABaseOfManySymbols)
{
    for (const int bits : {8, 12, 16, 20})
    {
        for (const std::uint32_t across : {3U, 10U, 40U})
        {
            SCOPED_TRACE(::testing::Message() << bits << " bits, " << across << " across");
            expect_within_promise(
                encode(torus(40, across, 0.5, 1), {.position_bits = bits, .base_vertices = 10000})
            );
        }
    }
}

TEST(DecoderHeap, StaysWithinItsPromiseForATinyBaseThatClaimsLargeTables)
{
    const Bytes small = encode(octahedron(), {.position_bits = 8}).file;
    StreamParts parts = take_apart(small);
    parts.info.chunks[0].codec = proto::kDracoBaseCodec;
    parts.chunks[0] = codec::encode_draco_base(decode(small).levels[0].mesh).value().bytes;
    // Draco's description of the attribute and of how it is coded: the last byte sizes a table.
    constexpr std::array kCoding{
        std::byte{1}, std::byte{0}, std::byte{5}, std::byte{3}, std::byte{0}, std::byte{0}};
    Bytes& base = parts.chunks[0];
    const auto place = std::ranges::search(base, kCoding).begin();
    ASSERT_NE(place, base.end());
    ASSERT_EQ(place[11], std::byte{5});
    place[11] = std::byte{18};
    const Bytes file = put_together(parts);
    EXPECT_LE(peak_while_decoding(file), codec::decoder_heap_bytes(parts.info));
    EXPECT_EQ(decode(file).error.value().code, ErrorCode::BadChunk);
}

/// A stream that claims the largest mesh of all and then ends.
Bytes huge_header()
{
    codec::StreamInfo info;
    info.grid.bits = 12;
    info.vertex_count = proto::kMaxVertices;
    info.face_count = proto::kMaxVertices * 2 - 4;
    info.chunks = {
        {.bytes = 1000, .vertices = info.vertex_count - 1000, .faces = info.face_count - 2000},
        {.bytes = 1U << 27, .vertices = info.vertex_count, .faces = info.face_count},
    };
    info.chunks[0].kind = proto::ChunkKind::Base;
    Bytes file = codec::write_stream_header(info, {4095, 4095, 4095});
    file.resize(file.size() + 2000);
    return file;
}

TEST(DecoderHeap, IsNotTakenForAHeaderThatIsRefused)
{
    const Bytes file = huge_header();
    for (const codec::DecodeLimits& limits : {
             codec::DecodeLimits{.max_vertices = 1U << 24},
             codec::DecodeLimits{.max_faces = 1U << 24},
             codec::DecodeLimits{.max_chunk_bytes = 1U << 20},
             codec::DecodeLimits{.max_heap_bytes = 1U << 28},
             codec::DecodeLimits{.max_header_bytes = 20},
         })
    {
        EXPECT_LT(peak_while_decoding(file, limits), 200000U);
        EXPECT_EQ(decode(file, limits).error.value().code, ErrorCode::LimitExceeded);
    }
}

#ifndef VSPLIT_SHADOW_MEMORY  // that needs terabytes

/// Decodes with little memory; exits with 0 when that is an error like others.
[[noreturn]] void decode_in_little_memory(const Bytes& file)
{
    constexpr rlimit kLittle{std::uint64_t{1} << 30, std::uint64_t{1} << 30};
    const bool limited = ::setrlimit(RLIMIT_AS, &kLittle) == 0;
    const Decoded decoded = decode(file);
    const bool refused = decoded.error && decoded.error->code == ErrorCode::LimitExceeded;
    std::fputs(decoded.error ? describe(*decoded.error).c_str() : "decoded", stderr);
    std::_Exit(limited && refused ? 0 : 1);
}

TEST(DecoderHeapDeathTest, GivesAnErrorWhenThereIsNotEnough)
{
    StreamParts parts = take_apart(encode(torus(20, 15, 0.0, 0)).file);
    parts.info.vertex_count = proto::kMaxVertices;
    parts.info.face_count = proto::kMaxVertices * 2 - 4;
    parts.info.chunks.back().vertices = parts.info.vertex_count;
    parts.info.chunks.back().faces = parts.info.face_count;
    const Bytes file = put_together(parts);
    EXPECT_EXIT(decode_in_little_memory(file), ::testing::ExitedWithCode(0), "");
}

#endif

TEST(DecoderHeap, GrowsOnlyWithTheBytesOfALongHeader)
{
    Bytes file = encode(tetrahedron()).file;
    file.resize(20);
    for (std::size_t i = 8; i < 12; ++i)
    {
        file[i] = i == 10 ? std::byte{0xFF} : std::byte{0};  // 16 MB
    }
    EXPECT_LT(peak_while_decoding(file), 200000U);
}

}  // namespace
}  // namespace vsplit::test
