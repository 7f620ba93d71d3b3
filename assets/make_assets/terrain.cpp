// Based on: Perlin, "An Image Synthesizer", 1985 (lattice noise); Musgrave, Kolb, Mace, "The Synthesis
// and Rendering of Eroded Fractal Terrains", 1989 (octaves whose weight follows the height).
#include "make_assets/implicit.h"
#include "make_assets/models.h"
#include "make_assets/remesh.h"

#include <algorithm>
#include <cstdint>

namespace vsplit::assets {

namespace {

constexpr double kHalfSide = 2.0;
constexpr std::uint32_t kCells = 72;  // along each side of the first, regular mesh

// A fixed pseudo-random value in [-1, 1] at an integer point.
double lattice_value(std::int32_t x, std::int32_t z, std::uint32_t octave)
{
    std::uint32_t hash = static_cast<std::uint32_t>(x) * 0x9E3779B1U ^
                         static_cast<std::uint32_t>(z) * 0x85EBCA77U ^ octave * 0xC2B2AE3DU;
    hash = (hash ^ (hash >> 15)) * 0x2C1B3C6DU;
    hash = (hash ^ (hash >> 12)) * 0x297A2D39U;
    hash ^= hash >> 15;
    return static_cast<double>(hash) / 2147483648.0 - 1.0;
}

double fade(double t)
{
    return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}

// Gradient noise, about -0.7 .. 0.7.
double noise(double x, double z, std::uint32_t octave)
{
    const double floor_x = std::floor(x), floor_z = std::floor(z);
    const auto ix = static_cast<std::int32_t>(floor_x), iz = static_cast<std::int32_t>(floor_z);
    const double tx = x - floor_x, tz = z - floor_z;
    const auto slope = [=](std::int32_t dx, std::int32_t dz) {
        return lattice_value(ix + dx, iz + dz, 2 * octave) * (tx - dx) +
               lattice_value(ix + dx, iz + dz, 2 * octave + 1) * (tz - dz);
    };
    const double u = fade(tx), v = fade(tz);
    const double near = slope(0, 0) * (1.0 - u) + slope(1, 0) * u;
    const double far = slope(0, 1) * (1.0 - u) + slope(1, 1) * u;
    return near * (1.0 - v) + far * v;
}

// An island with mountains round a lake, one peak above the others. Ridges lie where the noise changes sign; the
// detail grows with the height below it, which leaves valleys smooth as sediment does.
double height(double x, double z)
{
    const double warp_x = x + 0.3 * noise(0.9 * x + 7.3, 0.9 * z, 11);
    const double warp_z = z + 0.3 * noise(0.9 * x, 0.9 * z + 3.1, 12);
    double ridges = 0.0, weight = 1.0, size = 0.6, frequency = 0.7;
    for (std::uint32_t octave = 0; octave < 5; ++octave)
    {
        const double value = noise(frequency * warp_x + 19.7, frequency * warp_z - 4.3, octave);
        const double ridge = 1.0 - 2.2 * std::sqrt(value * value + 0.0006);
        ridges += size * weight * ridge;
        weight = std::clamp(1.4 * weight * ridge, 0.0, 1.0);
        size *= 0.42;
        frequency *= 2.1;
    }
    const double lake_x = warp_x - 0.45, lake_z = warp_z - 0.55;
    const double lake = lake_x * lake_x + 1.6 * lake_z * lake_z;
    const double peak_x = x + 0.9, peak_z = z + 0.8;
    const double peak = 0.5 / (1.0 + 3.5 * (peak_x * peak_x + peak_z * peak_z));
    const double edge_x = x * x / 4.6, edge_z = z * z / 4.6;  // the sea all round
    const double coast = (1.0 - edge_x * edge_x) * (1.0 - edge_z * edge_z);
    const double land = (ridges + peak + 0.1) * coast * lake / (lake + 0.4) - 0.16;
    return -smooth_minimum(-land, 0.0, 0.02);  // the water's surface is flat
}

IndexedMesh regular_sheet()
{
    IndexedMesh mesh;
    for (std::uint32_t j = 0; j <= kCells; ++j)
    {
        for (std::uint32_t i = 0; i <= kCells; ++i)
        {
            const double x = kHalfSide * (2.0 * i / kCells - 1.0);
            const double z = kHalfSide * (2.0 * j / kCells - 1.0);
            mesh.positions.push_back({x, height(x, z), z});
        }
    }
    for (std::uint32_t j = 0; j < kCells; ++j)
    {
        for (std::uint32_t i = 0; i < kCells; ++i)
        {
            const std::uint32_t a = j * (kCells + 1) + i, b = a + 1;
            const std::uint32_t c = a + kCells + 1, d = c + 1;
            mesh.triangles.push_back({a, c, b});
            mesh.triangles.push_back({b, c, d});
        }
    }
    return mesh;
}

}  // namespace

IndexedMesh make_terrain()
{
    TargetSurface surface;
    surface.project = [](const Vector3& p) { return Vector3{p.x, height(p.x, p.z), p.z}; };
    surface.normal = [](const Vector3& p) {
        constexpr double kStep = 0.004;
        const double slope_x = height(p.x + kStep, p.z) - height(p.x - kStep, p.z);
        const double slope_z = height(p.x, p.z + kStep) - height(p.x, p.z - kStep);
        return unit({-slope_x, 2.0 * kStep, -slope_z});
    };
    return remesh(
        regular_sheet(),
        surface,
        {.chord_error = 0.0024, .shortest_edge = 0.018, .longest_edge = 0.16}
    );
}

}  // namespace vsplit::assets
