#include "precompute/curvature_shapes.h"

#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <utility>

namespace vsplit::test {

IndexedMesh sample_parametric(
    const ParametricSurface& surface,
    std::uint32_t columns,
    std::uint32_t rows,
    Closing closing,
    double jitter
)
{
    const std::uint32_t across = closing.u ? columns : columns + 1;
    const std::uint32_t along = closing.v ? rows : rows + 1;
    std::mt19937 random(7);
    const auto shift = [&](bool inner) {
        const double unit = static_cast<double>(random()) / 4294967296.0;
        return inner ? jitter * (2.0 * unit - 1.0) : 0.0;
    };
    IndexedMesh mesh;
    for (std::uint32_t j = 0; j < along; ++j)
    {
        for (std::uint32_t i = 0; i < across; ++i)
        {
            const double u = i + shift(closing.u || (i > 0 && i < columns));
            const double v = j + shift(closing.v || (j > 0 && j < rows));
            mesh.positions.push_back(surface(u / columns, v / rows));
        }
    }
    const auto vertex = [&](std::uint32_t i, std::uint32_t j) {
        return (j % along) * across + i % across;
    };
    for (std::uint32_t j = 0; j < rows; ++j)
    {
        for (std::uint32_t i = 0; i < columns; ++i)
        {
            const std::uint32_t a = vertex(i, j), b = vertex(i + 1, j);
            const std::uint32_t c = vertex(i + 1, j + 1), d = vertex(i, j + 1);
            const bool other_diagonal = (i + j) % 2 == 1;
            mesh.triangles.push_back(other_diagonal ? Triangle{a, b, d} : Triangle{a, b, c});
            mesh.triangles.push_back(other_diagonal ? Triangle{b, c, d} : Triangle{a, c, d});
        }
    }
    return mesh;
}

IndexedMesh make_sphere(double radius, int levels)
{
    const double g = std::numbers::phi;
    IndexedMesh mesh;
    mesh.positions = {
        {-1, g, 0},
        {1, g, 0},
        {-1, -g, 0},
        {1, -g, 0},
        {0, -1, g},
        {0, 1, g},
        {0, -1, -g},
        {0, 1, -g},
        {g, 0, -1},
        {g, 0, 1},
        {-g, 0, -1},
        {-g, 0, 1}};
    mesh.triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                      {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                      {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                      {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    for (int level = 0; level < levels; ++level)
    {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [place, is_new] = middles.try_emplace(
                std::minmax(a, b), static_cast<std::uint32_t>(mesh.positions.size())
            );
            if (is_new)
            {
                const auto p = mesh.positions[a], q = mesh.positions[b];
                mesh.positions.push_back({p[0] + q[0], p[1] + q[1], p[2] + q[2]});
            }
            return place->second;
        };
        std::vector<Triangle> finer;
        for (const auto& [a, b, c] : mesh.triangles)
        {
            const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        mesh.triangles = std::move(finer);
        for (auto& p : mesh.positions)
        {
            const double scale = radius / std::hypot(p[0], p[1], p[2]);
            p = {p[0] * scale, p[1] * scale, p[2] * scale};
        }
    }
    return mesh;
}

precompute::HalfEdgeMesh link(const IndexedMesh& mesh)
{
    return precompute::make_half_edge_mesh(mesh).value();
}

IndexedMesh moved(const IndexedMesh& mesh, double scale, const std::array<double, 3>& translation)
{
    const double angle = 40.0 * std::numbers::pi / 180.0;
    const double c = std::cos(angle), s = std::sin(angle), n = 1.0 / std::sqrt(14.0);
    const std::array<double, 3> k{n, 2.0 * n, 3.0 * n};
    IndexedMesh result = mesh;
    for (auto& p : result.positions)
    {
        // Rodrigues' formula.
        const double along = (k[0] * p[0] + k[1] * p[1] + k[2] * p[2]) * (1.0 - c);
        const std::array<double, 3> across{
            k[1] * p[2] - k[2] * p[1], k[2] * p[0] - k[0] * p[2], k[0] * p[1] - k[1] * p[0]};
        for (std::size_t i = 0; i < 3; ++i)
        {
            p[i] = (p[i] * c + across[i] * s + k[i] * along) * scale + translation[i];
        }
    }
    return result;
}

}  // namespace vsplit::test
