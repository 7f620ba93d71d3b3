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
    bool is_curved = false;        ///< Whether `curved` is known:
    Vector3 curved{};              ///< exact on a lattice over a quadratic surface.
    Vector3 mean{};                ///< Of the known neighbours.
    std::uint32_t known = 0;       ///< Known neighbours.
    std::uint32_t tangential = 0;  ///< Mean sizes of their residuals.
    std::uint32_t normal = 0;
    std::uint32_t some = 0;   ///< One of them
    Vector3 some_position{};  ///< and where it is.

    /// The prediction from all parallelograms, or from the neighbours where there is none. `curved_share`:
    /// how far it bends, 0 .. 1.
    [[nodiscard]] Vector3 average(float curved_share) const
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
        const Vector3 flat = sum * (1.0F / static_cast<float>(guesses));
        return is_curved ? flat + (curved - flat) * curved_share : flat;
    }
};

/// Gathers what the neighbours of an unknown vertex say, from the faces around it.
class Gathering
{
public:
    /// All must outlive this. `sizes`: by grown vertex; `seen`: what run() gathers.
    Gathering(
        const GrownMesh& mesh,
        const VertexFront& front,
        const GrownPositions& positions,
        const std::vector<ResidualSizes>& sizes,
        Surroundings& seen
    )
        : mesh_(mesh), front_(front), positions_(positions), sizes_(sizes), seen_(seen)
    {
    }

    /// `ring`: the faces around the vertex, in turn; `bends`: whether curved predictions are wanted.
    void run(std::span<const RingFace> ring, bool bends)
    {
        const RingFace* before = nullptr;  // the face before, when it gave a parallelogram
        bool first_gave = false;
        for (const RingFace& face : ring)
        {
            const bool gave = look_at(face);
            if (bends && gave && before != nullptr)
            {
                bend(*before, face, seen_.guesses - 2, seen_.guesses - 1);
            }
            before = gave ? &face : nullptr;
            first_gave = first_gave || (gave && &face == ring.data());
        }
        if (bends && first_gave && before != nullptr && seen_.guesses > 1)
        {
            bend(*before, ring.front(), seen_.guesses - 1, 0);
        }
        if (seen_.known > 0)
        {
            seen_.mean = seen_.mean * (1.0F / static_cast<float>(seen_.known));
            seen_.tangential /= seen_.known;
            seen_.normal /= seen_.known;
        }
    }

private:
    [[nodiscard]] Vector3 position(std::uint32_t number) const
    {
        return to_vector(positions_[number]);
    }

    void see(std::uint32_t v, const Vector3& place)
    {
        seen_.mean = seen_.mean + place;
        seen_.tangential += sizes_[v].tangential;
        seen_.normal += sizes_[v].normal;
        seen_.some = v;
        seen_.some_position = place;
        ++seen_.known;
    }

    /// Result: whether the face gave a parallelogram.
    bool look_at(const RingFace& face)
    {
        Vector3 next{};
        const bool next_known = face.next_number != kUnknownVertex;
        if (next_known)
        {
            next = position(face.next_number);
            see(face.next, next);
        }
        if (face.previous_number == kUnknownVertex || !(next_known || face.ends))
        {
            return false;
        }
        const Vector3 previous = position(face.previous_number);
        if (face.ends)
        {
            see(face.previous, previous);
        }
        const Corner beyond = mesh_.opposite(face.corner);
        if (!next_known || beyond < 0 || seen_.guesses == Surroundings::kMostGuesses)
        {
            return false;
        }
        const std::uint32_t across = front_.number(mesh_.vertex(beyond));
        if (across == kUnknownVertex)
        {
            return false;
        }
        seen_.guess[seen_.guesses++] = next + previous - position(across);
        return true;
    }

    /// Bends the prediction of two parallelograms, the i-th p + m - c and the j-th m + q - d, if their faces
    /// share the edge to m and none is bent yet. When six faces lie around m, the vertex e across it from
    /// the unknown one makes it exact for quadratic surfaces over a lattice: e + (p - d) + (q - c).
    void bend(const RingFace& first, const RingFace& second, std::size_t i, std::size_t j)
    {
        constexpr std::uint8_t kLattice = 6;
        const std::uint32_t middle = first.previous;
        if (seen_.is_curved || second.next != middle || mesh_.incident(middle) != kLattice)
        {
            return;
        }
        const Corner beyond = mesh_.opposite(previous_corner(mesh_.opposite(first.corner)));
        const std::uint32_t across =
            beyond < 0 ? kUnknownVertex : front_.number(mesh_.vertex(beyond));
        if (across == kUnknownVertex)
        {
            return;
        }
        const Vector3 at_middle = position(first.previous_number);
        seen_.is_curved = true;
        seen_.curved = seen_.guess[i] + seen_.guess[j] + position(across) - at_middle - at_middle;
    }

    const GrownMesh& mesh_;
    const VertexFront& front_;
    const GrownPositions& positions_;
    const std::vector<ResidualSizes>& sizes_;
    Surroundings& seen_;
};

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
