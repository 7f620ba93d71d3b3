// Writes a closed mesh of about so many triangles: a torus with fractal bumps, its vertices displaced in
// the surface, too, so that it is as irregular as a scan. The same bytes on every run.
// Based on: Perlin, "An Image Synthesizer", 1985 (octaves of noise; here sums of waves).
#include "precompute/mesh_io.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <random>
#include <string>

namespace {

/// A travelling wave over the torus: whole numbers of periods both ways, so that it closes.
struct Wave
{
    double around = 0.0, across = 0.0, phase = 0.0, height = 0.0;
};

std::vector<Wave> make_waves(std::mt19937& random)
{
    constexpr int kOctaves = 7;
    constexpr int kWavesPerOctave = 5;
    constexpr double kHeight = 0.08;
    std::vector<Wave> waves;
    for (int octave = 0; octave < kOctaves; ++octave)
    {
        const int highest = 3 << octave;
        for (int i = 0; i < kWavesPerOctave; ++i)
        {
            // Differences of raw numbers: distributions are not the same in every standard library.
            const auto signed_up_to = [&](int most) {
                return static_cast<int>(random() % static_cast<unsigned>(2 * most + 1)) - most;
            };
            waves.push_back(
                {static_cast<double>(2 * signed_up_to(highest)),
                 static_cast<double>(signed_up_to(highest)),
                 static_cast<double>(random() % 6283U) / 1000.0,
                 kHeight / std::pow(1.9, octave) / kWavesPerOctave}
            );
        }
    }
    return waves;
}

vsplit::IndexedMesh make_torus(std::uint32_t triangles)
{
    std::mt19937 random(1985);
    const std::vector<Wave> waves = make_waves(random);
    const auto across = static_cast<std::uint32_t>(std::sqrt(triangles / 4.0));
    const std::uint32_t around = 2 * across;
    const auto jitter = [&random] {
        return 0.5 * (static_cast<double>(random() % 1001U) / 1000.0 - 0.5);
    };
    vsplit::IndexedMesh mesh;
    for (std::uint32_t i = 0; i < around * across; ++i)
    {
        const double u = (i % around + jitter()) * 2.0 * std::numbers::pi / around;
        const double v = (i / around + jitter()) * 2.0 * std::numbers::pi / across;
        double bump = 0.0;
        for (const Wave& wave : waves)
        {
            bump += wave.height * std::sin(wave.around * u + wave.across * v + wave.phase);
        }
        const double radius = 0.5 + bump;
        const double distance = 1.0 + radius * std::cos(v);
        mesh.positions.push_back(
            {distance * std::cos(u), distance * std::sin(u), radius * std::sin(v)}
        );
    }
    for (std::uint32_t row = 0; row < across; ++row)
    {
        for (std::uint32_t column = 0; column < around; ++column)
        {
            const std::uint32_t right = (column + 1) % around, above = (row + 1) % across * around;
            const std::uint32_t a = row * around + column, b = row * around + right;
            const std::uint32_t c = above + column, d = above + right;
            mesh.triangles.push_back({a, b, d});
            mesh.triangles.push_back({a, d, c});
        }
    }
    return mesh;
}

}  // namespace

int main(int argc, char** argv)
{
    constexpr long kFewest = 64;
    constexpr long kMost = 100'000'000;
    const long triangles = argc == 3 ? std::strtol(argv[2], nullptr, 10) : 0;
    if (triangles < kFewest || triangles > kMost)
    {
        std::fprintf(stderr, "usage: make_big_mesh OUT TRIANGLES\n");
        return 2;
    }
    const auto mesh = make_torus(static_cast<std::uint32_t>(triangles));
    if (const auto written = vsplit::precompute::write_mesh(argv[1], mesh); !written)
    {
        std::fprintf(stderr, "make_big_mesh: %s\n", vsplit::describe(written.error()).c_str());
        return vsplit::exit_status(written.error().code);
    }
    return 0;
}
