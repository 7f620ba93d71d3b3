#include "encoded_torus.h"

#include "precompute/encode_mesh.h"

#include <cmath>
#include <cstdint>
#include <numbers>
#include <stdexcept>

namespace vsplit::client {
namespace {

constexpr std::uint32_t kAround = 72;
constexpr std::uint32_t kTube = 48;

IndexedMesh bumpy_torus()
{
    IndexedMesh mesh;
    for (std::uint32_t i = 0; i < kAround; ++i)
    {
        const double u = 2 * std::numbers::pi * i / kAround;
        for (std::uint32_t j = 0; j < kTube; ++j)
        {
            const double v = 2 * std::numbers::pi * j / kTube;
            const double tube = 1.0 + 0.15 * std::sin(5 * u) * std::cos(3 * v);
            const double ring = 3.0 + tube * std::cos(v);
            mesh.positions.push_back({ring * std::cos(u), tube * std::sin(v), ring * std::sin(u)});
            const std::uint32_t next_i = (i + 1) % kAround;
            const std::uint32_t next_j = (j + 1) % kTube;
            const std::uint32_t a = i * kTube + j;
            const std::uint32_t b = next_i * kTube + j;
            const std::uint32_t c = next_i * kTube + next_j;
            const std::uint32_t d = i * kTube + next_j;
            mesh.triangles.push_back({a, c, b});
            mesh.triangles.push_back({a, d, c});
        }
    }
    return mesh;
}

}  // namespace

const TestStream& encoded_torus()
{
    static const TestStream kStream = [] {
        auto encoded = precompute::encode_mesh(bumpy_torus(), {}, {});
        if (!encoded)
        {
            throw std::runtime_error(describe(encoded.error()));
        }
        return TestStream{std::move(encoded->file), std::move(encoded->info)};
    }();
    return kStream;
}

}  // namespace vsplit::client
