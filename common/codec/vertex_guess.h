#pragma once

// Based on: Touma, Gotsman, "Triangle Mesh Compression", 1998 (parallelogram prediction); Isenburg,
// Alliez, "Compressing Polygon Mesh Geometry with Parallelogram Prediction", 2002, and the constrained
// multi-parallelograms of Draco (the encoder chooses among several).

#include "codec/coarse_surface.h"
#include "codec/float_log.h"
#include "codec/growth_model.h"
#include "codec/vector3.h"
#include "codec/vertex_front.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::codec {

/// A grid position as floats, exactly.
[[nodiscard]] inline Vector3 to_vector(const std::array<std::int32_t, 3>& position)
{
    return {
        static_cast<float>(position[0]),
        static_cast<float>(position[1]),
        static_cast<float>(position[2]),
    };
}

/// Size of a residual in half octaves, 0 .. 30.
[[nodiscard]] inline std::uint32_t residual_size(float residual)
{
    return static_cast<std::uint32_t>(clamp_int(steps_log2<1>(std::fabs(residual) + 1.0F), 0, 30));
}

/// Sizes of the residuals at a vertex, in half octaves: along the surface and across.
struct ResidualSizes
{
    std::uint8_t tangential = 0;
    std::uint8_t normal = 0;

    /// What to remember of a size: between what was near and what came.
    [[nodiscard]] static std::uint8_t blend(std::uint32_t before, float residual)
    {
        return static_cast<std::uint8_t>((before + 2 * residual_size(residual) + 2) / 3);
    }
};

/// What the known vertices around an unknown one say of it.
struct Surroundings
{
    static constexpr std::size_t kMostGuesses = 4;
    std::array<Vector3, kMostGuesses> guess{};  ///< By parallelograms.
    std::size_t guesses = 0;
    Vector3 mean{};                ///< Of the known neighbours.
    std::uint32_t known = 0;       ///< Known neighbours.
    std::uint32_t tangential = 0;  ///< Mean sizes of their residuals.
    std::uint32_t normal = 0;
    std::uint32_t some = 0;   ///< One of them
    Vector3 some_position{};  ///< and where it is.

    /// The prediction from all parallelograms, or from the neighbours where there is none.
    [[nodiscard]] Vector3 average() const
    {
        if (guesses == 0)
        {
            return mean;
        }
        Vector3 sum{};
        for (std::size_t i = 0; i < guesses; ++i)
        {
            sum = sum + guess[i];
        }
        return sum * (1.0F / static_cast<float>(guesses));
    }
};

/// Gathers what the neighbours of an unknown vertex say, from the faces around it.
[[nodiscard]] inline Surroundings look_around(
    const GrownMesh& mesh,
    const VertexFront& front,
    std::span<const RingFace> ring,
    const GrownPositions& positions,
    const std::vector<ResidualSizes>& sizes
)
{
    Surroundings seen;
    const auto see = [&](std::uint32_t v, const Vector3& place) {
        seen.mean = seen.mean + place;
        seen.tangential += sizes[v].tangential;
        seen.normal += sizes[v].normal;
        seen.some = v;
        seen.some_position = place;
        ++seen.known;
    };
    for (const RingFace& face : ring)
    {
        Vector3 next{};
        const bool next_known = face.next_number != kUnknownVertex;
        if (next_known)
        {
            next = to_vector(positions[face.next_number]);
            see(face.next, next);
        }
        if (face.previous_number == kUnknownVertex || !(next_known || face.ends))
        {
            continue;
        }
        const Vector3 previous = to_vector(positions[face.previous_number]);
        if (face.ends)
        {
            see(face.previous, previous);
        }
        const Corner beyond = mesh.opposite(face.corner);
        if (!next_known || beyond < 0 || seen.guesses == Surroundings::kMostGuesses)
        {
            continue;
        }
        const std::uint32_t across = front.number(mesh.vertex(beyond));
        if (across != kUnknownVertex)
        {
            seen.guess[seen.guesses++] = next + previous - to_vector(positions[across]);
        }
    }
    if (seen.known > 0)
    {
        seen.mean = seen.mean * (1.0F / static_cast<float>(seen.known));
        seen.tangential /= seen.known;
        seen.normal /= seen.known;
    }
    return seen;
}

/// Encoder: 0 for the average, i for the i-th parallelogram, by what residuals would cost about.
[[nodiscard]] inline std::size_t best_guess(
    const Surroundings& seen, const Vector3& average, const std::array<std::int32_t, 3>& wanted
)
{
    const auto price = [&](const Vector3& guess) {
        const Vector3 off = to_vector(wanted) - guess;
        const auto eighths = [](float value) { return steps_log2<3>(1.0F + value * value); };
        return eighths(off.x) + eighths(off.y) + eighths(off.z);
    };
    constexpr std::int32_t kChoicePrice = 8;
    std::int32_t least = price(average);
    std::size_t best = 0;
    for (std::size_t i = 0; i < seen.guesses; ++i)
    {
        const std::int32_t cost = price(seen.guess[i]) + kChoicePrice;
        if (cost < least)
        {
            least = cost;
            best = i + 1;
        }
    }
    return best;
}

/// How a position was predicted; residuals are modelled apart.
enum class GuessKind : std::uint8_t
{
    Mean,     ///< From the neighbours.
    Only,     ///< By the only parallelogram.
    Average,  ///< By all parallelograms.
    Chosen,   ///< By one of several.
};

/// Codes by which parallelogram a vertex is predicted when there are several that differ. `expected`:
/// their average; the chosen one afterwards. `wanted`: the position, encoder only.
template <typename Coder>
[[nodiscard]] GuessKind code_guess(
    Coder& coder,
    GrowthModel& model,
    const Surroundings& seen,
    Vector3& expected,
    const std::array<std::int32_t, 3>& wanted
)
{
    if (seen.guesses < 2)
    {
        return seen.guesses == 0 ? GuessKind::Mean : GuessKind::Only;
    }
    float spread = 0.0F;
    for (std::size_t i = 0; i < seen.guesses; ++i)
    {
        const Vector3 off = seen.guess[i] - expected;
        const float square = dot(off, off);
        spread = square > spread ? square : spread;
    }
    constexpr float kSame = 0.5F;
    if (spread < kSame)
    {
        return GuessKind::Average;
    }
    std::size_t best = 0;
    if constexpr (Coder::kEncodes)
    {
        best = best_guess(seen, expected, wanted);
    }
    const std::size_t size = std::min<std::size_t>(seen.tangential / 3, 3);
    const auto apart = static_cast<std::size_t>(clamp_int(steps_log2<0>(spread + 1.0F), 0, 15));
    auto& models = model.choice[seen.guesses - 2][size][apart];
    if (!code_bit(coder, models[0], best != 0))
    {
        return GuessKind::Average;
    }
    std::size_t i = 1;
    while (i < seen.guesses && !code_bit(coder, models[i], best == i))
    {
        ++i;
    }
    expected = seen.guess[i - 1];
    return GuessKind::Chosen;
}

}  // namespace vsplit::codec
