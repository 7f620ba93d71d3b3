#include "codec/growth_source.h"

#include <algorithm>
#include <utility>

namespace vsplit::codec {
namespace {

Corner rotate(Corner corner, Corner times)
{
    for (; times > 0; --times)
    {
        corner = next_corner(corner);
    }
    return corner;
}

/// An edge with the corner across from it, by which equal edges are found.
struct SourceEdge
{
    std::uint32_t low = 0;
    std::uint32_t high = 0;
    Corner corner = -1;
};

}  // namespace

GrowthSource::GrowthSource(const GridMesh& mesh, std::span<const std::uint32_t> coarse)
    : mesh_(mesh), coarse_(coarse), opposite_(mesh.triangles.size() * 4, -1)
{
    // Edges are grouped by their lower vertex (counting sort), then matched within the small groups.
    std::vector<std::uint32_t> start(mesh.positions.size() + 1, 0);
    const auto edge_at = [&](Corner corner) {
        const auto [low, high] =
            std::minmax({vertex_at(next_corner(corner)), vertex_at(previous_corner(corner))});
        return SourceEdge{low, high, corner};
    };
    const auto for_each_corner = [&](const auto& use) {
        for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
        {
            for (Corner k = 0; k < 3; ++k)
            {
                use(static_cast<Corner>(f) * 4 + k);
            }
        }
    };
    for_each_corner([&](Corner corner) { ++start[edge_at(corner).low + 1]; });
    for (std::size_t v = 1; v < start.size(); ++v)
    {
        start[v] += start[v - 1];
    }
    std::vector<Corner> sorted(mesh.triangles.size() * 3);
    std::vector<std::uint32_t> end(start.begin(), start.end() - 1);
    for_each_corner([&](Corner corner) {
        const SourceEdge edge = edge_at(corner);
        for (std::uint32_t i = start[edge.low]; i < end[edge.low]; ++i)
        {
            if (edge_at(sorted[i]).high == edge.high)
            {
                opposite_[static_cast<std::size_t>(corner)] = sorted[i];
                opposite_[static_cast<std::size_t>(sorted[i])] = corner;
                return;
            }
        }
        sorted[end[edge.low]++] = corner;
    });
    restart();
}

void GrowthSource::restart()
{
    first_.clear();
    first_.reserve(face_count());
    vertex_of_.clear();
    vertex_of_.reserve(vertex_count());
    grown_.assign(face_count(), -1);
    known_.assign(vertex_count(), 0);
    next_seed_ = 0;
}

Corner GrowthSource::to_source(Corner grown) const
{
    return rotate(first_[static_cast<std::size_t>(grown >> 2)], grown & 3);
}

Corner GrowthSource::to_grown(Corner source) const
{
    const std::int32_t face = grown_[static_cast<std::size_t>(source >> 2)];
    const Corner first = first_[static_cast<std::size_t>(face)];
    return face * 4 + ((source & 3) + 3 - (first & 3)) % 3;
}

void GrowthSource::take(Corner first)
{
    grown_[static_cast<std::size_t>(first >> 2)] = static_cast<std::int32_t>(first_.size());
    first_.push_back(first);
}

Result<void> GrowthSource::take_seed()
{
    for (; next_seed_ < grown_.size(); ++next_seed_)
    {
        for (Corner k = 0; k < 3 && grown_[next_seed_] < 0; ++k)
        {
            const Corner corner = static_cast<Corner>(next_seed_) * 4 + k;
            if (coarse_[vertex_at(corner)] != kNone)
            {
                take(corner);
                for (Corner i = 0; i < 3; ++i)
                {
                    vertex_of_.push_back(vertex_at(rotate(corner, i)));
                    known_[vertex_of_.back()] = 1;
                }
                return {};
            }
        }
    }
    return fail(ErrorCode::Internal, "a component has no coarse vertex");
}

void GrowthSource::take_face(Corner gate)
{
    const Corner across = opposite(to_source(gate));
    take(across);
    const std::uint32_t tip = vertex_at(across);
    if (std::exchange(known_[tip], std::uint8_t{1}) == 0)
    {
        vertex_of_.push_back(tip);
    }
}

Result<GrowthChoice> GrowthSource::choose(const GrownMesh& mesh, const BorderGate& gate) const
{
    const Corner across = opposite(to_source(gate.corner));
    if (across < 0)
    {
        return GrowthChoice{GrowthStep::Boundary, -1};
    }
    if (known_[vertex_at(across)] == 0)
    {
        return GrowthChoice{GrowthStep::NewVertex, -1};
    }
    const auto is_at = [&](Corner corner, std::int32_t node) {
        const Corner beyond = opposite(corner);
        return beyond >= 0 && is_done(beyond) && mesh.node_at(to_grown(beyond)) == node;
    };
    if (!gate.previous_closed && is_at(next_corner(across), gate.previous))
    {
        return GrowthChoice{GrowthStep::Previous, -1};
    }
    if (!gate.next_closed && is_at(previous_corner(across), gate.next))
    {
        return GrowthChoice{GrowthStep::Next, -1};
    }
    const std::int32_t place = find_place(mesh, across);
    if (place < 0)
    {
        return fail(ErrorCode::Internal, "the border does not reach a known vertex");
    }
    return GrowthChoice{GrowthStep::Touch, place};
}

std::int32_t GrowthSource::find_place(const GrownMesh& mesh, Corner across) const
{
    // Around the third vertex, away from the edge that will begin the gap, to the first grown face.
    Corner beyond = opposite(next_corner(across));
    while (beyond >= 0 && !is_done(beyond))
    {
        beyond = opposite(previous_corner(beyond));
    }
    if (beyond >= 0)
    {
        return mesh.node_at(to_grown(beyond));
    }
    // The boundary is in the way: the other way round to the edge that comes before.
    beyond = opposite(previous_corner(across));
    while (beyond >= 0 && !is_done(beyond))
    {
        beyond = opposite(next_corner(beyond));
    }
    if (beyond < 0)
    {
        return -1;
    }
    const std::int32_t before = mesh.node_at(to_grown(beyond));
    return before < 0 ? -1 : mesh.next_on_border(before);
}

}  // namespace vsplit::codec
