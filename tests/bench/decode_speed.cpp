// Decodes streams and Draco's coding of the same meshes alternately, and compares the processor times.
// The machine's load and its clock change both in the same way, so that the ratio is worth more than
// the times.

#include "codec/stream_decoder.h"
#include "core/file_io.h"

#include <CLI/CLI.hpp>
#include <draco/compression/decode.h>
#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace vsplit::bench {
namespace {

using Json = nlohmann::ordered_json;

/// Processor seconds of this thread.
double processor_seconds()
{
    timespec now{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double median(std::vector<double> values)
{
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Decodes a stream from its first byte to its last.
Result<codec::StreamDecoder> decode_stream(std::span<const std::byte> file)
{
    codec::StreamDecoder decoder;
    while (!decoder.complete())
    {
        const auto taken = decoder.feed(file);
        VSPLIT_TRY(taken);
        file = file.subspan(*taken);
        const auto step = decoder.step();
        VSPLIT_TRY(step);
        if (step->kind == codec::StepKind::NeedBytes && file.empty())
        {
            return fail(ErrorCode::Truncated, "the stream ends early");
        }
    }
    return decoder;
}

std::unique_ptr<draco::Mesh> to_draco(const IndexedMesh& mesh)
{
    auto result = std::make_unique<draco::Mesh>();
    const auto points = static_cast<std::uint32_t>(mesh.positions.size());
    result->set_num_points(points);
    draco::GeometryAttribute position;
    position.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_FLOAT32, false, 12, 0);
    const int id = result->AddAttribute(position, true, points);
    for (std::uint32_t v = 0; v < points; ++v)
    {
        std::array<float, 3> value{};
        std::ranges::transform(mesh.positions[v], value.begin(), [](double coordinate) {
            return static_cast<float>(coordinate);
        });
        result->attribute(id)->SetAttributeValue(draco::AttributeValueIndex(v), value.data());
    }
    for (const Triangle& triangle : mesh.triangles)
    {
        draco::Mesh::Face face;
        std::ranges::transform(triangle, face.begin(), [](std::uint32_t v) {
            return draco::PointIndex(v);
        });
        result->AddFace(face);
    }
    return result;
}

/// What `draco_encoder -cl 10 -qp BITS` does.
std::optional<draco::EncoderBuffer> encode_with_draco(const IndexedMesh& mesh, int bits)
{
    draco::Encoder encoder;
    encoder.SetSpeedOptions(0, 0);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, bits);
    std::optional<draco::EncoderBuffer> buffer(std::in_place);
    return encoder.EncodeMeshToBuffer(*to_draco(mesh), &*buffer).ok() ? std::move(buffer)
                                                                      : std::nullopt;
}

bool decode_with_draco(const draco::EncoderBuffer& bytes)
{
    draco::DecoderBuffer buffer;
    buffer.Init(bytes.data(), bytes.size());
    draco::Decoder decoder;
    return decoder.DecodeMeshFromBuffer(&buffer).ok();
}

/// Decodes both, in turns. `rounds`: how often each.
Result<Json> measure(const std::string& path, std::uint32_t rounds)
{
    const auto file = read_file(path);
    VSPLIT_TRY(file);
    auto decoded = decode_stream(*file);
    VSPLIT_TRY(decoded);
    const auto draco =
        encode_with_draco(codec::extract_mesh(*decoded, false), decoded->info()->grid.bits);
    const auto info = *decoded->info();
    *decoded = codec::StreamDecoder();
    if (!draco || !decode_with_draco(*draco))
    {
        return fail(ErrorCode::Internal, path + ": Draco does not code this mesh");
    }
    std::vector<double> ours;
    std::vector<double> theirs;
    std::vector<double> ratios;
    for (std::uint32_t round = 0; round < rounds; ++round)
    {
        const double start = processor_seconds();
        {
            VSPLIT_TRY(decode_stream(*file));
        }
        const double between = processor_seconds();
        static_cast<void>(decode_with_draco(*draco));
        const double end = processor_seconds();
        ours.push_back(between - start);
        theirs.push_back(end - between);
        ratios.push_back(ours.back() / theirs.back());
    }
    return Json{
        {"stream", path},
        {"vertices", info.vertex_count},
        {"faces", info.face_count},
        {"rounds", rounds},
        {"stream_bytes", file->size()},
        {"draco_bytes", draco->size()},
        {"seconds", {{"vsplit", median(ours)}, {"draco", median(theirs)}}},
        {"ratio", median(ratios)},
    };
}

int run(const std::vector<std::string>& streams, std::uint32_t rounds)
{
    Json results = Json::array();
    for (const std::string& path : streams)
    {
        auto result = measure(path, rounds);
        if (!result)
        {
            std::fprintf(stderr, "decode_speed: %s\n", result.error().message.c_str());
            return 1;
        }
        results.push_back(std::move(*result));
    }
    std::printf("%s\n", results.dump(2).c_str());
    return 0;
}

}  // namespace
}  // namespace vsplit::bench

int main(int argc, char** argv)
{
    CLI::App app(
        "Compares the processor time that decoding and applying a whole stream takes with that of "
        "Draco, compression level 10, for the same mesh at the same position bits. Prints JSON: "
        "per "
        "stream the median seconds of both and the median of their ratio."
    );
    std::vector<std::string> streams;
    std::uint32_t rounds = 9;
    app.add_option("STREAM", streams, "The .vsplit files")->required();
    app.add_option("--rounds", rounds, "Decode each so often")->check(CLI::Range(1U, 10000U));
    CLI11_PARSE(app, argc, argv);
    return vsplit::bench::run(streams, rounds);
}
