#pragma once

#include "codec/batch_coder.h"
#include "codec/level_attributes.h"
#include "codec/refinement_mesh.h"
#include "codec/stream_info.h"
#include "core/result.h"
#include "mesh/indexed_mesh.h"
#include "mesh/quantization_grid.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace vsplit::codec {

/// A half-edge collapse: `removed` folded into `kept`. Undone by a Split, whose drawing see.
struct Collapse
{
    std::uint32_t removed = 0;
    std::uint32_t kept = 0;
    std::uint32_t right = 0;  ///< The ring vertex at which the wedge begins.
    std::uint8_t wedge = 0;   ///< Faces that the kept vertex took over, 1 .. kMaxWedge.
    SplitKind kind = SplitKind::Interior;
};

/// What the new faces of a split bring where a mesh has wedges: the face (kept, right, removed) first,
/// then (kept, removed, left); see the drawing of Split.
struct SeamRecord
{
    /// Stands in for a face that a split at the boundary does not make.
    static constexpr std::uint32_t kNoFace = 0xFFFFFFFF;

    /// By face the wedges at its corners, in the order of the corners given above.
    std::array<std::array<std::uint32_t, 3>, 2> wedges{
        {{kNoFace, kNoFace, kNoFace}, {kNoFace, kNoFace, kNoFace}}};
    std::array<std::uint32_t, 2> faces{
        kNoFace, kNoFace};  ///< Their triangles in the complete mesh.
};

/// A vertex that is shown elsewhere than at its own position, where the surface is followed better.
struct Displacement
{
    std::uint32_t vertex = 0;
    std::array<std::int32_t, 3> position{};  ///< On the level's grid.
};

/// One level of the plan: the collapses that its batches undo, and how it looks when shown.
struct PlannedLevel
{
    /// Batches of collapses, coarsest first; within a batch the faces of their stars are disjoint. One
    /// batch, or up to kMaxBatches small ones that share a chunk. Empty for the base.
    std::vector<std::vector<Collapse>> batches;
    /// By batch and collapse what it took away; empty when the mesh has no wedges.
    std::vector<std::vector<SeamRecord>> seams;
    /// Instead of batches: components that show from this level on, in vertices of the plan's mesh; one
    /// group a chunk, within the limits of encode_small_base(). The shift is that of the level before.
    std::vector<std::vector<Triangle>> parts;
    int shift = 0;  ///< Precision of the level; never grows from level to level.
    /// From this level on, as long as the shift stays the same. Only where the shift changes, and of
    /// vertices that the level has.
    std::vector<Displacement> displaced;
    double rms_error = 0.0;  ///< Model units.
    double max_error = 0.0;  ///< Model units.
};

/// All that a stream is made of.
struct StreamPlan
{
    QuantizationGrid grid;
    const GridMesh* mesh = nullptr;        ///< The complete mesh.
    std::vector<Triangle> base_triangles;  ///< In vertices of `mesh`.
    std::vector<PlannedLevel> levels;      ///< Base first, finest last (its shift is 0).
    /// For training only: the model to start from instead of initial_model(); what was learned comes
    /// back in it. The stream is then not decodable.
    LearnedModel* training = nullptr;
    /// What the header tells of attributes, and the values; with them go `wedges` and `groups`.
    std::vector<AttributeInfo> attributes;
    std::vector<std::vector<std::int32_t>> values;  ///< By attribute and wedge the coded numbers.
    std::span<const std::uint32_t> stitches;  ///< As EncodedMesh's; empty when nothing was cut.
    /// By triangle of `mesh` the wedges at its corners, 0 .. W - 1; empty when nothing lies on it.
    std::span<const Triangle> wedges;
    std::span<const std::uint32_t> groups;  ///< By triangle of `mesh`; empty: all in 0.
    /// Bits of texture coordinates that come behind everything else; those of coarser levels then lack as
    /// many as their positions let nobody see. 0: all of them come at once.
    int late_bits = 0;
    bool grow_last_level = true;  ///< False: splits to the end.
    bool cut_levels = true;       ///< False: one chunk a level, however long.
};

/// Codes a plan. `progress`: called with the share done, 0 .. 1.
/// Result: the bytes of the stream file. Error: Internal when the plan contradicts itself.
/// Cost: about 3 microseconds a vertex. Deterministic. Thread safe.
[[nodiscard]] Result<std::vector<std::byte>> encode_stream(
    const StreamPlan& plan, const std::function<void(double)>& progress = {}
);

}  // namespace vsplit::codec
