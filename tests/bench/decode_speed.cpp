// Decodes streams and Draco's coding of the same meshes alternately, and compares the processor times.
// The machine's load and its clock change both in the same way, so that the ratio is worth more than
// the times.

#include "codec/stream_decoder.h"
#include "core/file_io.h"
#include "draco_mesh.h"
#include "heap_meter.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <ctime>
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

/// Heap that one call had in use at once, bytes, the decoded mesh included.
template <typename Work>
Result<std::uint64_t> heap_peak(const Work& work)
{
    tools::start_heap_meter();
    const auto done = work();
    const std::uint64_t peak = tools::stop_heap_meter();
    VSPLIT_TRY(done);
    return peak;
}

/// The processor times of each round.
struct Times
{
    std::vector<double> ours;
    std::vector<double> theirs;
    std::vector<double> ratios;
};

Result<Times> take_times(
    std::span<const std::byte> file, std::span<const char> coded, std::uint32_t rounds
)
{
    Times times;
    for (std::uint32_t round = 0; round < rounds; ++round)
    {
        const double start = processor_seconds();
        VSPLIT_TRY(decode_stream(file));
        const double between = processor_seconds();
        VSPLIT_TRY(decode_with_draco(coded));
        const double end = processor_seconds();
        times.ours.push_back(between - start);
        times.theirs.push_back(end - between);
        times.ratios.push_back(times.ours.back() / times.theirs.back());
    }
    return times;
}

/// Decodes both, in turns. `rounds`: how often each; 0 compares only sizes.
Result<Json> measure(const std::string& path, std::uint32_t rounds)
{
    const auto file = read_file(path);
    VSPLIT_TRY(file);
    auto decoded = decode_stream(*file);
    VSPLIT_TRY(decoded);
    const auto info = *decoded->info();
    // Cut vertices stay apart: Draco codes the very mesh that the stream codes.
    const auto coded = encode_with_draco(codec::extract_mesh(*decoded, false), info.grid.bits);
    VSPLIT_TRY(coded);
    *decoded = codec::StreamDecoder();
    Json json{
        {"stream", path},
        {"vertices", info.vertex_count},
        {"faces", info.face_count},
        {"rounds", rounds},
        {"stream_bytes", file->size()},
        {"draco_bytes", coded->size()},
    };
    if (rounds > 0)
    {
        const auto our_heap = heap_peak([&] { return decode_stream(*file); });
        VSPLIT_TRY(our_heap);
        const auto their_heap = heap_peak([&] { return decode_with_draco(*coded); });
        VSPLIT_TRY(their_heap);
        const auto times = take_times(*file, *coded, rounds);
        VSPLIT_TRY(times);
        json["seconds"] = {{"vsplit", median(times->ours)}, {"draco", median(times->theirs)}};
        json["ratio"] = median(times->ratios);
        json["heap_peak_bytes"] = {{"vsplit", *our_heap}, {"draco", *their_heap}};
    }
    return json;
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
        "stream the sizes, the median seconds of both, the median of their ratio and heap peaks."
    );
    std::vector<std::string> streams;
    std::uint32_t rounds = 9;
    app.add_option("STREAM", streams, "The .vsplit files")->required();
    app.add_option("--rounds", rounds, "Decode each so often; 0: sizes only")
        ->check(CLI::Range(0U, 10000U));
    CLI11_PARSE(app, argc, argv);
    return vsplit::bench::run(streams, rounds);
}
