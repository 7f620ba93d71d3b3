#include "codec/shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace vsplit::test {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

/// Evenly distributed between -size and size, alike with every standard library.
double noise_of(std::mt19937& random, double size)
{
    return size * (static_cast<double>(random()) / 2147483647.5 - 1.0);
}

}  // namespace

IndexedMesh triangle()
{
    return {{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.5}}, {{0, 1, 2}}};
}

IndexedMesh tetrahedron()
{
    return {
        {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}},
        {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
}

IndexedMesh octahedron()
{
    return {
        {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
        {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
}

IndexedMesh strip(std::uint32_t count)
{
    IndexedMesh mesh;
    for (std::uint32_t i = 0; i <= count; ++i)
    {
        const double x = i;
        mesh.positions.push_back({x, 0.0, std::sin(x)});
        mesh.positions.push_back({x, 1.0, std::sin(x * 0.7)});
    }
    for (std::uint32_t i = 0; i < count; ++i)
    {
        mesh.triangles.push_back({2 * i, 2 * i + 2, 2 * i + 3});
        mesh.triangles.push_back({2 * i, 2 * i + 3, 2 * i + 1});
    }
    return mesh;
}

IndexedMesh fan(std::uint32_t valence)
{
    IndexedMesh mesh;
    mesh.positions.push_back({0.0, 0.0, 0.3});
    for (std::uint32_t i = 0; i < valence; ++i)
    {
        const double angle = kTurn * i / valence;
        mesh.positions.push_back({std::cos(angle), std::sin(angle), 0.05 * std::cos(9 * angle)});
        mesh.triangles.push_back({0, i + 1, (i + 1) % valence + 1});
    }
    return mesh;
}

IndexedMesh double_cone(std::uint32_t valence)
{
    IndexedMesh mesh = fan(valence);
    mesh.positions.push_back({0.0, 0.0, -0.4});
    for (std::uint32_t i = 0; i < valence; ++i)
    {
        mesh.triangles.push_back({valence + 1, (i + 1) % valence + 1, i + 1});
    }
    return mesh;
}

IndexedMesh sphere(std::uint32_t rings, std::uint32_t sectors, double noise, unsigned seed)
{
    std::mt19937 random(seed);
    IndexedMesh mesh;
    const auto add = [&](double x, double y, double z) {
        const double radius = 1.0 + noise_of(random, noise);
        mesh.positions.push_back({radius * x, radius * y, radius * z});
    };
    add(0.0, 0.0, 1.0);
    for (std::uint32_t ring = 1; ring < rings; ++ring)
    {
        const double polar = std::numbers::pi * ring / rings;
        for (std::uint32_t step = 0; step < sectors; ++step)
        {
            const double angle = kTurn * step / sectors;
            add(std::sin(polar) * std::cos(angle),
                std::sin(polar) * std::sin(angle),
                std::cos(polar));
        }
    }
    add(0.0, 0.0, -1.0);
    const auto last = static_cast<std::uint32_t>(mesh.positions.size()) - 1;
    for (std::uint32_t step = 0; step < sectors; ++step)
    {
        const std::uint32_t after = (step + 1) % sectors;
        mesh.triangles.push_back({0, 1 + step, 1 + after});
        mesh.triangles.push_back({last, last - sectors + after, last - sectors + step});
        for (std::uint32_t ring = 0; ring + 2 < rings; ++ring)
        {
            const std::uint32_t row = 1 + ring * sectors;
            mesh.triangles.push_back({row + step, row + sectors + step, row + sectors + after});
            mesh.triangles.push_back({row + step, row + sectors + after, row + after});
        }
    }
    return mesh;
}

IndexedMesh torus(std::uint32_t around, std::uint32_t across, double noise, unsigned seed)
{
    std::mt19937 random(seed);
    IndexedMesh mesh;
    for (std::uint32_t i = 0; i < around; ++i)
    {
        const double u = kTurn * i / around;
        for (std::uint32_t j = 0; j < across; ++j)
        {
            const double v = kTurn * j / across;
            const double tube = 1.0 + noise_of(random, noise);
            const double ring = 3.0 + tube * std::cos(v);
            mesh.positions.push_back({ring * std::cos(u), ring * std::sin(u), tube * std::sin(v)});
            const std::uint32_t a = i * across + j;
            const std::uint32_t b = (i + 1) % around * across + j;
            const std::uint32_t c = (i + 1) % around * across + (j + 1) % across;
            const std::uint32_t d = i * across + (j + 1) % across;
            mesh.triangles.push_back({a, b, c});
            mesh.triangles.push_back({a, c, d});
        }
    }
    return mesh;
}

IndexedMesh height_field(std::uint32_t width, std::uint32_t height, double noise, unsigned seed)
{
    std::mt19937 random(seed);
    IndexedMesh mesh;
    for (std::uint32_t y = 0; y < height; ++y)
    {
        for (std::uint32_t x = 0; x < width; ++x)
        {
            const double wave = std::sin(0.11 * x) * std::cos(0.07 * y) * 8.0;
            mesh.positions.push_back(
                {x + noise_of(random, 0.2),
                 y + noise_of(random, 0.2),
                 wave + noise_of(random, noise)}
            );
        }
    }
    for (std::uint32_t y = 0; y + 1 < height; ++y)
    {
        for (std::uint32_t x = 0; x + 1 < width; ++x)
        {
            const std::uint32_t a = y * width + x;
            const std::uint32_t c = a + width + 1;
            if (random() % 2 == 0)
            {
                mesh.triangles.push_back({a, a + 1, c});
                mesh.triangles.push_back({a, c, a + width});
            }
            else
            {
                mesh.triangles.push_back({a, a + 1, a + width});
                mesh.triangles.push_back({a + 1, c, a + width});
            }
        }
    }
    return mesh;
}

IndexedMesh joined(const IndexedMesh& a, const IndexedMesh& b, double shift)
{
    IndexedMesh mesh = a;
    const auto first = static_cast<std::uint32_t>(a.positions.size());
    for (const auto& [x, y, z] : b.positions)
    {
        mesh.positions.push_back({x + shift, y, z});
    }
    for (const Triangle& t : b.triangles)
    {
        mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
    return mesh;
}

IndexedMesh with_holes(const IndexedMesh& mesh, double share, unsigned seed)
{
    std::mt19937 random(seed);
    IndexedMesh result{mesh.positions, {mesh.triangles.front()}};
    for (std::size_t f = 1; f < mesh.triangles.size(); ++f)
    {
        if (static_cast<double>(random() % 10000) >= share * 10000.0)
        {
            result.triangles.push_back(mesh.triangles[f]);
        }
    }
    return result;
}

IndexedMesh book(std::uint32_t size)
{
    IndexedMesh mesh;
    const std::uint32_t row = size + 1;
    for (std::uint32_t sheet = 0; sheet < 3; ++sheet)
    {
        const double angle = 0.1 + kTurn * sheet / 3.0;
        for (std::uint32_t y = 0; y <= size; ++y)
        {
            for (std::uint32_t x = 0; x <= size; ++x)
            {
                const double along = x == 0 ? 0.0 : x + 0.1 * std::sin(1.7 * x * y);
                mesh.positions.push_back({along * std::cos(angle), along * std::sin(angle), 1.0 * y}
                );
                if (x < size && y < size)
                {
                    const std::uint32_t a = sheet * row * row + y * row + x;
                    mesh.triangles.push_back({a, a + 1, a + row + 1});
                    mesh.triangles.push_back({a, a + row + 1, a + row});
                }
            }
        }
    }
    return mesh;
}

std::vector<std::array<std::int32_t, 9>> face_set(const GridMesh& mesh)
{
    std::vector<std::array<std::int32_t, 9>> faces;
    for (const Triangle& t : mesh.triangles)
    {
        std::array<std::int32_t, 9> least{};
        for (std::size_t start = 0; start < 3; ++start)
        {
            std::array<std::int32_t, 9> face{};
            for (std::size_t i = 0; i < 9; ++i)
            {
                face[i] = mesh.positions[t[(start + i / 3) % 3]][i % 3];
            }
            least = start == 0 ? face : std::min(least, face);
        }
        faces.push_back(least);
    }
    std::ranges::sort(faces);
    return faces;
}

}  // namespace vsplit::test
