#pragma once

#include "codec/initial_model.h"
#include "codec/stream_info.h"
#include "core/result.h"
#include "mesh/indexed_mesh.h"
#include "precompute/metric.h"

#include <cstdint>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

namespace vsplit::precompute {

/// Choices of an encode; the defaults are what `vsplit encode` uses.
struct EncodeOptions
{
    int position_bits = 12;  ///< 8 .. 20.
    Metric metric = Metric::Curvature;
    std::uint32_t base_vertices = 0;  ///< Aim for the base mesh; 0 lets the encoder choose.
    /// Numbers of vertices, in any order, that a level is to have exactly, as far as topology lets it.
    std::vector<std::uint32_t> level_vertices{};
    /// Per vertex 0 .. 1, 1 for what is to be kept for long, or empty; see CollapseCost.
    std::vector<float> importance{};
    /// Of errors of textures and colours beside those of the shape, when collapses are priced. Measured: 0.5
    /// takes 21 to 27 % off how far spot's texture slides at 1/8 and 1/4 of the vertices, 7 to 16 % off
    /// african-head's, and adds 5 to 7 and 6 to 22 % to the errors of their shapes; files shrink by 1 %.
    double attribute_weight = 0.5;
    /// For training only, see codec::StreamPlan::training.
    codec::LearnedModel* training = nullptr;
    /// False: only splits, no last level that is grown where that is smaller.
    bool grow_last_level = true;
    /// Bits of positions and texture coordinates that come last, in a level that adds no vertex and behind it, so
    /// that other things may come before them: they are a good part of the bytes and hardly seen. Only without
    /// a last level that is grown.
    int late_bits = 0;
    bool cut_levels = true;  ///< False: one chunk a level, however long; to see what the cuts cost.
    unsigned threads = 1;    ///< Worker threads, at least 1; the bytes do not depend on it.
};

/// A repaired mesh and what is known of its faces.
struct EncodeInput
{
    IndexedMesh mesh;                     ///< As encode_mesh() takes it.
    std::vector<std::uint32_t> stitches;  ///< As encode_mesh() takes them.
    std::vector<Triangle> wedges;       ///< By triangle, as split_wedges() makes them; empty: none.
    std::vector<std::uint32_t> groups;  ///< One number a triangle; empty: all in 0.
    std::vector<codec::AttributeInfo> attributes;
    std::vector<std::vector<std::int32_t>> values;  ///< By attribute and wedge the coded numbers.
};

/// Called now and then with the stage's name and its share done, 0 .. 1; from the encoding thread.
using ProgressSink = std::function<void(std::string_view stage, double share)>;

/// Seconds that each stage took.
struct EncodeSeconds
{
    double metric = 0.0;    ///< Curvature and other precomputed vertex values.
    double collapse = 0.0;  ///< Collapse sequence.
    double distance =
        0.0;            ///< How levels are shown and their errors, as far as not beside the others.
    double code = 0.0;  ///< Prediction and entropy coding.
    double total = 0.0;
};

/// A finished stream and what it took.
struct EncodedMesh
{
    std::vector<std::byte> file;
    codec::StreamInfo info;
    EncodeSeconds seconds;
};

/// Encodes a repaired mesh into a stream file whose last level is the quantised mesh exactly.
/// `mesh`: every vertex used, no degenerate or duplicate triangle, 2-manifold with boundary and
/// consistently oriented (what repair_mesh() returns); `stitches`: per vertex the representative of
/// the source vertex it was cut from (as RepairedMesh::stitches), or empty; vertices that share one
/// are never removed, so that no level cracks.
/// Preconditions: options.importance has one number a vertex, or none; options.late_bits is 0 .. 4.
/// Errors: EmptyMesh, InputTooLarge, BadIndex and UnsupportedInput (not such a mesh; see
/// check_manifold()), Internal (the result failed its own check).
/// Cost: about 12 microseconds and 400 bytes a vertex, with several threads 550 bytes. Deterministic: the same input and options
/// give the same bytes for any number of threads. Thread safe.
[[nodiscard]] Result<EncodedMesh> encode_mesh(
    const IndexedMesh& mesh,
    std::span<const std::uint32_t> stitches,
    const EncodeOptions& options,
    const ProgressSink& progress = {}
);

/// The same, but takes the mesh over and lets go of it as soon as it can: 48 bytes a vertex less.
[[nodiscard]] Result<EncodedMesh> encode_mesh(
    IndexedMesh&& mesh,
    std::span<const std::uint32_t> stitches,
    const EncodeOptions& options,
    const ProgressSink& progress = {}
);

/// The same for a mesh with wedges: seams are kept at every level. Errors: also UnsupportedInput when
/// there are not as many wedges or groups as triangles, though some.
[[nodiscard]] Result<EncodedMesh> encode_surface(
    EncodeInput&& input, const EncodeOptions& options, const ProgressSink& progress = {}
);

}  // namespace vsplit::precompute
