// Based on: Doi, Koide, "An Efficient Method of Triangulating Equi-Valued Surfaces by Using
// Tetrahedral Cells", 1991. Each cube is cut into the six tetrahedra round its main diagonal (Kuhn),
// whose faces match those of the next cube: the result is closed and manifold without special cases.
#include "make_assets/polygonise.h"

#include <algorithm>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace vsplit::assets {

namespace {

class Polygoniser
{
public:
    Polygoniser(const Field& field, const Lattice& lattice) : lattice_(lattice)
    {
        const Vector3 extent = lattice.high - lattice.low;
        counts_ = {points_along(extent.x), points_along(extent.y), points_along(extent.z)};
        const std::uint64_t count = counts_[0] * counts_[1] * counts_[2];
        values_.reserve(count);
        while (values_.size() < count)
        {
            const double value = field(point(values_.size()));
            // This point's ball of one sign also holds the next points of its row and their
            // neighbours, whose values are then never used for a crossing.
            const double ball = std::abs(value) / (kSteepest * lattice.cell) - 2.0;
            const std::uint64_t row_left = counts_[0] - values_.size() % counts_[0];
            const auto same = std::min(row_left, static_cast<std::uint64_t>(std::max(ball, 1.0)));
            values_.insert(values_.end(), same, value);
        }
    }

    IndexedMesh run()
    {
        for (std::uint64_t z = 0; z + 1 < counts_[2]; ++z)
        {
            for (std::uint64_t y = 0; y + 1 < counts_[1]; ++y)
            {
                for (std::uint64_t x = 0; x + 1 < counts_[0]; ++x)
                {
                    add_cube(x + counts_[0] * (y + counts_[1] * z));
                }
            }
        }
        return std::move(mesh_);
    }

private:
    using Corners = std::array<std::uint64_t, 4>;  // the lattice points of a tetrahedron

    [[nodiscard]] std::uint64_t points_along(double extent) const
    {
        return static_cast<std::uint64_t>(extent / lattice_.cell) + 2;
    }

    [[nodiscard]] Vector3 point(std::uint64_t index) const
    {
        const auto x = static_cast<double>(index % counts_[0]);
        const auto y = static_cast<double>(index / counts_[0] % counts_[1]);
        const auto z = static_cast<double>(index / (counts_[0] * counts_[1]));
        return lattice_.low + Vector3{x, y, z} * lattice_.cell;
    }

    void add_cube(std::uint64_t origin)
    {
        const std::array<std::uint64_t, 3> step{1, counts_[0], counts_[0] * counts_[1]};
        const std::uint64_t far = origin + step[0] + step[1] + step[2];
        // Even permutations of the axes give positively oriented tetrahedra, odd ones the others.
        static constexpr std::array<std::array<std::size_t, 3>, 6> kPaths{
            {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
        for (std::size_t i = 0; i < kPaths.size(); ++i)
        {
            const std::uint64_t first = origin + step[kPaths[i][0]];
            const std::uint64_t second = first + step[kPaths[i][1]];
            add_tetrahedron(
                i < 3 ? Corners{origin, first, second, far} : Corners{origin, second, first, far}
            );
        }
    }

    void add_tetrahedron(const Corners& corners)
    {
        // Inside corners first, keeping the orientation (each exchange of two flips another two).
        Corners sorted = corners;
        bool odd = false;
        std::size_t inside = 0;
        for (std::size_t i = 0; i < 4; ++i)
        {
            if (values_[sorted[i]] < 0.0)
            {
                odd = odd != (i != inside);
                std::swap(sorted[i], sorted[inside]);
                ++inside;
            }
        }
        if (odd)
        {
            const std::size_t pair = inside == 1 ? 2 : 0;  // two on the same side
            std::swap(sorted[pair], sorted[pair + 1]);
        }
        // Braces, not arguments: they are evaluated from left to right on every compiler, and the order
        // of evaluation numbers the vertices.
        const auto [a, b, c, d] = sorted;
        if (inside == 1)
        {
            mesh_.triangles.push_back({crossing(a, b), crossing(a, c), crossing(a, d)});
        }
        else if (inside == 2)
        {
            mesh_.triangles.push_back({crossing(a, c), crossing(a, d), crossing(b, d)});
            mesh_.triangles.push_back({crossing(a, c), crossing(b, d), crossing(b, c)});
        }
        else if (inside == 3)
        {
            mesh_.triangles.push_back({crossing(a, d), crossing(b, d), crossing(c, d)});
        }
    }

    std::uint32_t crossing(std::uint64_t inner, std::uint64_t outer)
    {
        const std::uint64_t low = std::min(inner, outer);
        const std::uint64_t high = std::max(inner, outer);
        const auto [place, is_new] = crossings_.try_emplace(
            low * values_.size() + high, static_cast<std::uint32_t>(mesh_.positions.size())
        );
        if (is_new)
        {
            const double t = values_[low] / (values_[low] - values_[high]);
            mesh_.positions.push_back(to_array(point(low) + (point(high) - point(low)) * t));
        }
        return place->second;
    }

    Lattice lattice_;
    std::array<std::uint64_t, 3> counts_{};
    std::vector<double> values_;
    std::unordered_map<std::uint64_t, std::uint32_t> crossings_;
    IndexedMesh mesh_;
};

}  // namespace

IndexedMesh polygonise(const Field& field, const Lattice& lattice)
{
    return Polygoniser(field, lattice).run();
}

}  // namespace vsplit::assets
