#include "precompute/repair_steps.h"

#include <utility>

namespace vsplit::precompute {
namespace {

/// State of a face during the flood fill.
enum Visit : std::uint8_t
{
    kUnvisited = 2,
    kKept = 0,
    kReversed = 1,
};

class FloodFill
{
public:
    FloodFill(const IndexedMesh& mesh, RepairReport& report)
        : triangles_(mesh.triangles), report_(report)
    {
        result_.opposite = join_edges(mesh, report);
        result_.reversed.assign(triangles_.size(), kUnvisited);
        order_.reserve(triangles_.size());
    }

    Orientation run()
    {
        for (std::uint32_t face = 0; face < triangles_.size(); ++face)
        {
            if (result_.reversed[face] == kUnvisited)
            {
                fill_component(face);
            }
        }
        return std::move(result_);
    }

private:
    void fill_component(std::uint32_t seed)
    {
        ++result_.components;
        const std::size_t begin = order_.size();
        std::size_t reversed = 0;
        result_.reversed[seed] = kKept;
        order_.push_back(seed);
        std::size_t next = begin;
        std::size_t next_deferred = 0;
        while (next < order_.size() || next_deferred < deferred_.size())
        {
            if (next < order_.size())
            {
                reversed += result_.reversed[order_[next]] == kReversed ? 1 : 0;
                visit_neighbours(order_[next++]);
                continue;
            }
            reach_across(deferred_[next_deferred++]);
        }
        deferred_.clear();
        const std::size_t size = order_.size() - begin;
        if (2 * reversed > size)
        {
            for (std::size_t i = begin; i < order_.size(); ++i)
            {
                result_.reversed[order_[i]] ^= 1U;
            }
            reversed = size - reversed;
        }
        report_.flipped_faces += static_cast<std::uint32_t>(reversed);
    }

    void visit_neighbours(std::uint32_t face)
    {
        for (HalfEdge half = 3 * face; half < 3 * face + 3; ++half)
        {
            const HalfEdge other = result_.opposite[half];
            if (other == kNoHalfEdge)
            {
                continue;
            }
            if (agree(half, other))
            {
                reach_across(half);
            }
            else
            {
                // Later: a one-sided surface is then cut where its faces disagree already.
                deferred_.push_back(half);
            }
        }
    }

    void reach_across(HalfEdge half)
    {
        const HalfEdge other = result_.opposite[half];
        if (other == kNoHalfEdge)
        {
            return;  // cut meanwhile
        }
        const unsigned turn = agree(half, other) ? 0U : 1U;
        const auto wanted = static_cast<std::uint8_t>(result_.reversed[half / 3] ^ turn);
        std::uint8_t& state = result_.reversed[other / 3];
        if (state == kUnvisited)
        {
            state = wanted;
            order_.push_back(other / 3);
        }
        else if (state != wanted)
        {
            // Not orientable: the surface is one-sided along this edge.
            result_.opposite[half] = kNoHalfEdge;
            result_.opposite[other] = kNoHalfEdge;
            ++report_.non_manifold_edges;
        }
    }

    /// True when both faces of an edge turn the same way: they run along it in opposite directions.
    [[nodiscard]] bool agree(HalfEdge half, HalfEdge other) const
    {
        return start_of(half) != start_of(other);
    }

    [[nodiscard]] std::uint32_t start_of(HalfEdge half) const
    {
        return triangles_[half / 3][half % 3];
    }

    std::span<const Triangle> triangles_;
    RepairReport& report_;
    Orientation result_;
    std::vector<std::uint32_t> order_;  ///< Faces as they were reached.
    std::vector<HalfEdge> deferred_;    ///< Edges of the component whose faces disagree.
};

}  // namespace

Orientation orient_faces(const IndexedMesh& mesh, RepairReport& report)
{
    return FloodFill(mesh, report).run();
}

}  // namespace vsplit::precompute
