#pragma once

#include "connection.h"
#include "refiner.h"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace vsplit::client {

/// How long frames took.
struct FrameTimes
{
    double median_ms = 0.0;
    double p95_ms = 0.0;  ///< 95th percentile.
    double fps = 0.0;     ///< Frames divided by the time they took together.
};

/// One level as the device saw it.
struct LevelRow
{
    std::uint32_t level = 0;
    std::uint32_t vertices = 0;
    std::uint32_t faces = 0;
    ChunkBytes bytes;                    ///< Of its chunks.
    std::uint64_t cumulative_bytes = 0;  ///< Length of the stream prefix that shows it.
    double seconds = 0.0;    ///< From the start of connecting until it was on the screen.
    double decode_ms = 0.0;  ///< Decoding its chunks and updating the arrays.
    std::size_t images = 0;  ///< Images decoded while it was the last complete level.
    double image_ms = 0.0;   ///< Time for that.
    /// Textures with mipmaps and the coded images that are kept, after its last frame.
    std::uint64_t texture_memory_bytes = 0;
    std::vector<double> frame_ms;      ///< Every frame drawn while it was the last complete level.
    std::uint64_t resident_bytes = 0;  ///< Resident memory of this process, OpenGL driver included.
};

/// Everything a run found out.
struct Report
{
    std::string model;
    std::string device;
    std::string link;
    std::uint64_t memory_cap_bytes = 0;
    std::uint64_t memory_planned_bytes = 0;   ///< See MemoryPlan::needed_bytes.
    std::uint64_t texture_planned_bytes = 0;  ///< See MemoryPlan::texture_bytes; part of the above.
    std::uint32_t texture_limit = 0;  ///< Longest side of a texture, pixels; 0: no textures.
    bool surface = false;  ///< The stream has attributes or materials, and they are drawn.
    std::vector<LevelRow> levels;
    TransferCounters transferred;
    double seconds = 0.0;   ///< From the start of connecting to the end of the last level's frames.
    bool complete = false;  ///< Every chunk was applied, checksums and counts agree.
};

/// Returns the value below which `share` of the samples lie, interpolated between neighbours.
/// `samples`: any order; `share`: 0 .. 1. Result: 0 when there are none. Thread safe.
/// Source: Hyndman and Fan, "Sample Quantiles in Statistical Packages", 1996, definition 7.
[[nodiscard]] double percentile(std::span<const double> samples, double share);

/// Summarises frame times, milliseconds; all zero when there are none. Thread safe.
[[nodiscard]] FrameTimes summarize(std::span<const double> frame_ms);

/// Returns the report with the names that programs rely on.
[[nodiscard]] nlohmann::ordered_json to_json(const Report& report);

/// Returns the two lines that head the table of levels; with columns for attributes and textures when
/// the report has them.
[[nodiscard]] std::string table_head(const Report& report);

/// Returns the table's line for one level of the report.
[[nodiscard]] std::string table_row(const Report& report, const LevelRow& row);

/// Returns the line of totals under the table.
[[nodiscard]] std::string totals_line(const Report& report);

/// Returns this process's resident memory, bytes; 0 where the system does not tell.
[[nodiscard]] std::uint64_t resident_bytes();

}  // namespace vsplit::client
