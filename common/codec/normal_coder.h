#pragma once

// Based on: Max, "Weights for Computing Vertex Normals from Facet Normals", 1999 (the weights to choose
// from). Normals are coded last, as the difference to those that the complete mesh has by itself. Encoder and
// decoder run this same code.

#include "codec/attribute_state.h"
#include "codec/float_log.h"
#include "codec/level_mesh.h"
#include "codec/octahedron.h"
#include "codec/value_fit.h"
#include "codec/wedge_neighbours.h"
#include "core/result.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

namespace vsplit::codec {

/// How faces count in the normal of a wedge.
enum class NormalWeight : std::uint8_t
{
    Area = 0,    ///< Cross product of the edges.
    Face = 1,    ///< All alike.
    Sphere = 2,  ///< Cross product over both squared lengths: exact on spheres (Max).
    Sine = 3,    ///< Cross product over both lengths.
};

/// How an encoder had normals predicted.
struct NormalStyle
{
    NormalWeight weight = NormalWeight::Area;
    std::uint8_t corrected = 0;  ///< Eighths of the neighbours' mean deviation, 0 .. 7.
};

/// Codes one normal attribute of the complete mesh. Not thread safe. Safe on untrusted input.
class NormalCoder
{
public:
    /// `info`: of the attribute; `mesh`, `shown`: complete level; must outlive this.
    NormalCoder(const AttributeInfo& info, const LevelMesh& mesh, const LevelAttributes& shown)
        : half_((1 << (info.bits - 1)) - 1),
          mesh_(mesh),
          neighbours_(
              mesh, shown.wedges, static_cast<std::uint32_t>(shown.wedge_vertices.size()), 0
          ),
          left_(static_cast<std::uint32_t>(shown.wedge_vertices.size()))
    {
        values_.resize(2ULL * left_);
        deviations_.resize(left_);
        sizes_.resize(left_);
    }

    /// Wedges that still lack a normal.
    [[nodiscard]] std::uint32_t left() const { return left_; }

    /// Two numbers a wedge. Complete when left() is 0.
    [[nodiscard]] std::vector<std::int32_t>& values() { return values_; }

    /// Codes what stands at the beginning of the attribute's first chunk.
    template <typename Coder>
    void begin(Coder& coder, const NormalStyle& style)
    {
        style_.weight =
            static_cast<NormalWeight>(coder.raw(static_cast<std::uint32_t>(style.weight), 2));
        style_.corrected = static_cast<std::uint8_t>(coder.raw(style.corrected, 3));
    }

    /// Codes the normals of `count` wedges. `wanted`: encoder only, two numbers a wedge.
    /// Precondition: count <= left(). Error: BadChunk.
    template <typename Coder>
    [[nodiscard]] Result<void> run(
        Coder& coder, std::uint32_t count, std::span<const std::int32_t> wanted
    )
    {
        for (; count > 0; --count, --left_)
        {
            const std::uint32_t wedge = neighbours_.take();
            VSPLIT_TRY(code_normal(coder, wedge, wanted));
            neighbours_.know(wedge);
        }
        return {};
    }

private:
    static constexpr OctaSide kStored{2, 1};

    /// The normal that the faces of a wedge give, of length 1 or 0.
    [[nodiscard]] Double3 derived_normal(std::uint32_t wedge) const
    {
        Double3 sum{};
        for (const Corner corner : neighbours_.corners(wedge))
        {
            const auto& a = mesh_.positions[mesh_.vertex(corner)];
            const Double3 p = difference(mesh_.positions[mesh_.vertex(next_corner(corner))], a);
            const Double3 q = difference(mesh_.positions[mesh_.vertex(previous_corner(corner))], a);
            const Double3 n = cross(p, q);
            const double divisor = divisor_for(n, p, q);
            if (divisor > 0.0)
            {
                sum = {sum[0] + n[0] / divisor, sum[1] + n[1] / divisor, sum[2] + n[2] / divisor};
            }
        }
        const double square = dot(sum, sum);
        if (!(square > 0.0))
        {
            return {};
        }
        const double length = std::sqrt(square);
        return {sum[0] / length, sum[1] / length, sum[2] / length};
    }

    [[nodiscard]] double divisor_for(const Double3& n, const Double3& p, const Double3& q) const
    {
        switch (style_.weight)
        {
            case NormalWeight::Face:
                return std::sqrt(dot(n, n));
            case NormalWeight::Sphere:
                return dot(p, p) * dot(q, q);
            case NormalWeight::Sine:
                return std::sqrt(dot(p, p) * dot(q, q));
            default:
                return 1.0;
        }
    }

    /// Mean of what neighbours have told: deviations from their derived normals, and sizes of residuals.
    void look_around(std::uint32_t wedge, Double3& deviation, double& size) const
    {
        double count = 0.0;
        double sizes = 0.0;
        deviation = {};
        for (const Corner corner : neighbours_.corners(wedge))
        {
            for (const Corner beside : {next_corner(corner), previous_corner(corner)})
            {
                const std::uint32_t other = neighbours_.wedge(beside);
                if (neighbours_.is_known(other))
                {
                    const auto& d = deviations_[other];
                    deviation = {
                        deviation[0] + static_cast<double>(d[0]),
                        deviation[1] + static_cast<double>(d[1]),
                        deviation[2] + static_cast<double>(d[2])};
                    sizes = sizes + static_cast<double>(sizes_[other]);
                    count = count + 1.0;
                }
            }
        }
        size = count > 0.0 ? sizes / count : 2.0;
        const double share = count > 0.0 ? style_.corrected / (8.0 * count) : 0.0;
        deviation = {deviation[0] * share, deviation[1] * share, deviation[2] * share};
    }

    template <typename Coder>
    [[nodiscard]] Result<void> code_normal(
        Coder& coder, std::uint32_t wedge, [[maybe_unused]] std::span<const std::int32_t> wanted
    )
    {
        const Double3 derived = derived_normal(wedge);
        Double3 deviation;
        double size = 0.0;
        look_around(wedge, deviation, size);
        const OctaPoint expected = octa_point(
            {derived[0] + deviation[0], derived[1] + deviation[1], derived[2] + deviation[2]}, half_
        );
        const OctaSide side = nearest_side(expected);
        const OctaCoordinates from = unfold(expected, side, half_);
        OctaCoordinates to{};
        if constexpr (Coder::kEncodes)
        {
            const std::size_t i = 2ULL * wedge;
            to = unfold(
                fold({wanted[i] - half_, wanted[i + 1] - half_}, kStored, half_), side, half_
            );
        }
        double before = size;
        double sum = 0.0;
        for (std::size_t k = 0; k < 2; ++k)
        {
            auto& model = models_[k][residual_context(0.5 * size + 0.5 * before)];
            const std::int32_t residual = code_integer(coder, model, to[k] - from[k], 1);
            to[k] = from[k] + residual;
            if (std::abs(to[k]) > half_)
            {
                return fail(ErrorCode::BadChunk, "a normal lies outside of its range");
            }
            before = static_cast<double>(std::abs(residual));
            sum = sum + before;
        }
        take(wedge, fold(to, side, half_), derived, sum);
        return {};
    }

    void take(std::uint32_t wedge, const OctaPoint& normal, const Double3& derived, double sum)
    {
        const OctaCoordinates stored = unfold(normal, kStored, half_);
        values_[2ULL * wedge] = stored[0] + half_;
        values_[2ULL * wedge + 1] = stored[1] + half_;
        sizes_[wedge] = static_cast<float>(0.5 * sum);
        const Double3 exact{
            static_cast<double>(normal[0]),
            static_cast<double>(normal[1]),
            static_cast<double>(normal[2])};
        const double length = std::sqrt(dot(exact, exact));
        for (std::size_t k = 0; k < 3; ++k)
        {
            deviations_[wedge][k] = static_cast<float>(exact[k] / length - derived[k]);
        }
    }

    [[nodiscard]] static std::size_t residual_context(double size)
    {
        const std::int32_t steps = steps_log2<1>(static_cast<float>(size + 0.125)) + 6;
        return static_cast<std::size_t>(
            clamp_int(steps, 0, static_cast<std::int32_t>(kResidualContexts) - 1)
        );
    }

    std::int32_t half_;
    const LevelMesh& mesh_;
    WedgeNeighbours neighbours_;
    NormalStyle style_;
    std::uint32_t left_;
    std::vector<std::int32_t> values_;
    std::vector<std::array<float, 3>> deviations_;  ///< By wedge, from the derived normal.
    std::vector<float> sizes_;                      ///< By wedge, mean size of its residuals.
    std::array<std::array<IntegerModel, kResidualContexts>, 2> models_{
        detail::kInitialResiduals, detail::kInitialResiduals};
};

}  // namespace vsplit::codec
