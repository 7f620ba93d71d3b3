#include "codec/growth_planner.h"

#include "codec/bit_counter.h"

#include <algorithm>
#include <utility>

namespace vsplit::codec {
namespace {

/// Faces or vertices after which the length is looked at.
constexpr std::uint32_t kStep = 512;

/// Length at which a chunk is closed: one more step keeps it within proto::kTargetChunkBytes.
constexpr std::size_t kFullChunk = 48U * 1024U;

/// Bits a vertex from which the rest may come as one level: finer prefixes hardly differ on a screen.
/// Small meshes have few bytes at any rate, and less of them to gain.
constexpr double kGrowthBits = 3.2;
constexpr double kGrowthBitsOfSmall = 2.0;
constexpr std::uint32_t kSmallMesh = 8000;

}  // namespace

bool shows_enough(std::size_t bytes, std::uint32_t vertices, int shift)
{
    const double bits = 8.0 * static_cast<double>(bytes) / vertices;
    // Without a bit missing the surface is off by no more than a cell.
    return shift == 0 || bits >= (vertices < kSmallMesh ? kGrowthBitsOfSmall : kGrowthBits);
}

Result<GrowthPlan> plan_growth(
    const GridMesh& mesh,
    std::span<const std::uint32_t> coarse,
    const BatchState& state,
    int surface_share
)
{
    BatchState trial = state;
    GrowthSource source(mesh, coarse);
    const auto vertices = static_cast<std::uint32_t>(mesh.positions.size());
    const auto faces = static_cast<std::uint32_t>(mesh.triangles.size());
    Growth growth(vertices, faces);
    BitCounter bits;
    GrowthPlan plan{.chunks = {{}}, .surface_share = surface_share};
    std::uint32_t faces_left = faces;
    std::uint32_t vertices_left = vertices;
    std::size_t start = 0;
    while (faces_left > 0 || vertices_left > 0)
    {
        GrowthShare share;
        share.faces = std::min(faces_left, kStep);
        share.vertices = faces_left > 0 ? 0 : std::min(vertices_left, kStep);
        VSPLIT_TRY(growth.run(bits, trial, share, surface_share, &source));
        faces_left -= share.faces;
        vertices_left -= share.vertices;
        plan.chunks.back().faces += share.faces;
        plan.chunks.back().vertices += share.vertices;
        if (bits.bytes() - start > kFullChunk && faces_left + vertices_left > 0)
        {
            start = bits.bytes();
            plan.chunks.emplace_back();
        }
    }
    plan.bytes = bits.bytes();
    return plan;
}

std::optional<GrowthPlan> cheapest_growth(
    const GridMesh& mesh, std::span<const std::uint32_t> coarse, const BatchState& state
)
{
    std::optional<GrowthPlan> best;
    for (const int share : kSurfaceShares)
    {
        auto plan = plan_growth(mesh, coarse, state, share);
        if (plan && (!best || plan->bytes < best->bytes))
        {
            best = std::move(*plan);
        }
    }
    return best;
}

}  // namespace vsplit::codec
