#pragma once

#include "codec/stream_info.h"
#include "core/result.h"
#include "precompute/repair.h"

#include <nlohmann/json_fwd.hpp>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <string>

namespace vsplit::tools {

/// JSON whose keys stay in the order in which they were added.
using Json = nlohmann::ordered_json;

/// Measures elapsed time from its making. Not thread safe.
class Stopwatch
{
public:
    /// Seconds since the stopwatch was made or last read.
    double lap()
    {
        const auto now = std::chrono::steady_clock::now();
        const double seconds = std::chrono::duration<double>(now - start_).count();
        start_ = now;
        return seconds;
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Writes JSON for programs. `target`: a file, "-" for standard output, or empty for nowhere.
/// Error: IoError.
[[nodiscard]] Result<void> write_json(const Json& json, const std::string& target);

/// The levels of a stream as the JSON rows that programs rely on; errors are percent of the
/// diagonal.
[[nodiscard]] Json levels_json(const codec::StreamInfo& info);

/// The attributes of a stream as JSON: kind, set, components, bits, name.
[[nodiscard]] Json attributes_json(const codec::StreamInfo& info);

/// Base mesh of a stream as JSON: vertices, faces, bytes (of its chunk).
[[nodiscard]] Json base_json(const codec::StreamInfo& info);

/// A repair report as JSON, one number a field.
[[nodiscard]] Json repair_json(const precompute::RepairReport& report);

/// A repair report in words, e.g. "dropped 1113 isolated vertices"; "nothing to do" when clean.
[[nodiscard]] std::string repair_in_words(const precompute::RepairReport& report);

/// Bits of file per vertex of the last level, for a prefix of `bytes`.
[[nodiscard]] double bits_per_vertex(const codec::StreamInfo& info, std::uint64_t bytes);

/// Prints one row a level for people: bytes, cumulative, vertices, faces, errors, bits per vertex; where there
/// are any, also the bytes of attributes among them and those of materials and images behind them.
void print_levels(std::FILE* out, const codec::StreamInfo& info);

/// Refuses an output that is one of the inputs. Error: AlreadyExists.
[[nodiscard]] Result<void> check_not_same_file(
    const std::filesystem::path& input, const std::filesystem::path& output
);

}  // namespace vsplit::tools
