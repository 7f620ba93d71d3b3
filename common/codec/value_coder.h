#pragma once

// Values of wedges, coded as the difference to what their surroundings let expect. Encoder and decoder run
// this same code.

#include "codec/attribute_state.h"
#include "codec/float_log.h"
#include "codec/level_mesh.h"
#include "codec/value_fit.h"
#include "codec/value_precision.h"
#include "codec/wedge_neighbours.h"
#include "core/result.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

namespace vsplit::codec {

/// Least and greatest of one coded number of an attribute.
struct NumberRange
{
    std::int32_t low = 0;
    std::int32_t high = 0;
};

/// Colours are coded as brightness and two differences (YCoCg-R, Malvar, Sullivan, 2003), of which the
/// differences need a sign.
[[nodiscard]] inline NumberRange number_range(const AttributeInfo& info, std::size_t k)
{
    const std::int32_t high = (1 << info.bits) - 1;
    const bool difference = info.kind == AttributeKind::Color && !info.rgb && (k == 1 || k == 2);
    return {difference ? -high : 0, high};
}

/// Codes the values of a level's new wedges, normals excepted. Not thread safe. Safe on untrusted input.
class ValueCoder
{
public:
    /// `mesh`: of the level; `state`: with its wedges, those from `first_new` on without values. All must
    /// outlive this.
    ValueCoder(
        std::span<const AttributeInfo> attributes,
        const LevelMesh& mesh,
        AttributeState& state,
        std::uint32_t first_new
    )
        : attributes_(attributes),
          mesh_(mesh),
          state_(state),
          neighbours_(
              mesh,
              state.shown.wedges,
              static_cast<std::uint32_t>(state.shown.wedge_vertices.size()),
              first_new
          ),
          first_new_(first_new),
          left_(static_cast<std::uint32_t>(state.shown.wedge_vertices.size()) - first_new)
    {
        sizes_.resize(attributes.size());
        state_.shown.values.resize(attributes.size());
        for (std::size_t a = 0; a < attributes.size(); ++a)
        {
            if (is_coded(a))
            {
                state_.shown.values[a].resize(
                    state.shown.wedge_vertices.size() * coded_components(attributes[a])
                );
                sizes_[a].resize(left_ * coded_components(attributes[a]));
            }
        }
    }

    /// Wedges that still lack values.
    [[nodiscard]] std::uint32_t left() const { return left_; }

    /// Codes the values of `count` wedges. `wanted`: encoder only, by attribute and wedge of the stream.
    /// Precondition: count <= left(). Error: BadChunk.
    template <typename Coder>
    [[nodiscard]] Result<void> run(
        Coder& coder,
        std::uint32_t count,
        [[maybe_unused]] std::span<const std::vector<std::int32_t>> wanted
    )
    {
        for (; count > 0; --count, --left_)
        {
            const std::uint32_t wedge = neighbours_.take();
            fit_.look_at(mesh_, neighbours_, state_.shown.wedge_vertices, wedge);
            twin_ = known_twin(wedge);
            for (std::size_t a = 0; a < attributes_.size(); ++a)
            {
                if (is_coded(a))
                {
                    VSPLIT_TRY(code_value(coder, a, wedge, wanted));
                }
            }
            neighbours_.know(wedge);
        }
        return {};
    }

private:
    [[nodiscard]] bool is_coded(std::size_t attribute) const
    {
        return attributes_[attribute].kind != AttributeKind::Normal;
    }

    /// Another wedge of the vertex whose values are known, or kNoWedge.
    [[nodiscard]] std::uint32_t known_twin(std::uint32_t wedge) const
    {
        std::uint32_t twin = state_.first_wedge[state_.shown.wedge_vertices[wedge]];
        for (std::size_t n = 0; n < kMostTwins && twin != kNoWedge; ++n)
        {
            if (neighbours_.is_known(twin))
            {
                return twin;
            }
            twin = state_.next_wedge[twin];
        }
        return kNoWedge;
    }

    template <typename Coder>
    [[nodiscard]] Result<void> code_value(
        Coder& coder,
        std::size_t attribute,
        std::uint32_t wedge,
        [[maybe_unused]] std::span<const std::vector<std::int32_t>> wanted
    )
    {
        const std::size_t numbers = coded_components(attributes_[attribute]);
        auto& values = state_.shown.values[attribute];
        const auto value = std::span(values).subspan(wedge * numbers, numbers);
        if constexpr (Coder::kEncodes)
        {
            std::ranges::transform(
                std::span(wanted[attribute]).subspan(wedge * numbers, numbers),
                value.begin(),
                [&](std::int32_t number) { return middle_of(number, state_.lacks[attribute]); }
            );
        }
        if (twin_ != kNoWedge)
        {
            const auto other = std::span(values).subspan(twin_ * numbers, numbers);
            const bool same = Coder::kEncodes && std::ranges::equal(other, value);
            if (code_bit(coder, state_.value_models[attribute].same_value, same))
            {
                std::ranges::copy(other, value.begin());
                return {};
            }
        }
        return code_numbers(coder, attribute, wedge, value);
    }

    template <typename Coder>
    [[nodiscard]] Result<void> code_numbers(
        Coder& coder, std::size_t attribute, std::uint32_t wedge, std::span<std::int32_t> value
    )
    {
        const AttributeInfo& info = attributes_[attribute];
        std::array<ExpectedNumber, 4> expected{};
        for (std::size_t k = 0; k < value.size(); ++k)
        {
            expected[k] = expect(attribute, value.size(), k);
        }
        const int lacks = state_.lacks[attribute];
        const auto step = static_cast<double>(1 << lacks);
        const auto middle = static_cast<double>(middle_of(0, lacks));
        double before = 0.0;
        for (std::size_t k = 0; k < value.size(); ++k)
        {
            const NumberRange range = number_range(info, k);
            const std::int32_t low = range.low >> lacks;
            const std::int32_t high = range.high >> lacks;
            const double likely = std::clamp(
                (expected[k].value - middle) / step,
                static_cast<double>(low),
                static_cast<double>(high)
            );
            const double rounded = std::floor(likely + 0.5);
            const double rest = likely - rounded;
            const std::size_t sign = rest < -0.171875 ? 2 : rest > 0.171875 ? 0 : 1;
            const double size = expected_size(attribute, wedge, k, value.size(), expected[k]);
            before = k == 0 ? size : before;
            auto& model = state_.value_models[attribute]
                              .residual[k][residual_context(kOwn * size + kBefore * before)];
            const auto base = static_cast<std::int32_t>(rounded);
            const std::int32_t residual =
                code_integer(coder, model, (value[k] >> lacks) - base, sign);
            const std::int32_t cell = base + residual;
            if (cell < low || cell > high)
            {
                return fail(ErrorCode::BadChunk, "a value of an attribute is out of its range");
            }
            value[k] = middle_of(cell << lacks, lacks);
            before = static_cast<double>(std::abs(residual));
            sizes_[attribute][(wedge - first_new_) * value.size() + k] =
                static_cast<float>(1.0 + before);
        }
        return {};
    }

    [[nodiscard]] ExpectedNumber expect(std::size_t attribute, std::size_t numbers, std::size_t k)
        const
    {
        if (fit_.size() > 0)
        {
            return fit_.expect(state_.shown.values[attribute], numbers, k);
        }
        const NumberRange range = number_range(attributes_[attribute], k);
        const std::uint32_t twin = twin_;
        ExpectedNumber expected;
        expected.value =
            twin == kNoWedge
                ? static_cast<double>((range.low + range.high) / 2)
                : static_cast<double>(state_.shown.values[attribute][twin * numbers + k]);
        return expected;
    }

    /// How large the residual of number `k` of `numbers` is expected to be, in steps of the level's precision: as
    /// those of the neighbours, and as the fit is off.
    [[nodiscard]] double expected_size(
        std::size_t attribute,
        std::uint32_t wedge,
        std::size_t k,
        std::size_t numbers,
        const ExpectedNumber& expected
    ) const
    {
        const auto step = static_cast<double>(1 << state_.lacks[attribute]);
        if (fit_.size() == 0)
        {
            return static_cast<double>(1 << attributes_[attribute].bits) / step;
        }
        double sum = 0.0;
        double count = 0.0;
        for (const Corner corner : neighbours_.corners(wedge))
        {
            for (const Corner beside : {next_corner(corner), previous_corner(corner)})
            {
                const std::uint32_t other = neighbours_.wedge(beside);
                const float seen = other < first_new_
                                       ? 0.0F
                                       : sizes_[attribute][(other - first_new_) * numbers + k];
                sum = sum + (seen > 0.0F ? static_cast<double>(seen) - 1.0 : 0.0);
                count = count + (seen > 0.0F ? 1.0 : 0.0);
            }
        }
        const double steep = std::sqrt(expected.slope_squared * fit_.reach_squared()) / step;
        const double error = std::sqrt(expected.error_squared) / step;
        const bool fits = fit_.size() > 3;
        double size = 0.2 * steep;
        if (count > 0.0)
        {
            const double seen = sum / count;
            size = fits ? (2.0 * seen + error) / 3.0 : seen;
        }
        else if (fits)
        {
            size = error;
        }
        if (fit_.size() < 3)
        {
            size = std::max(size, 0.1 * steep + 0.5);
        }
        return fit_.size() == 1 ? std::max(size, 4.0) : size;
    }

    [[nodiscard]] static std::size_t residual_context(double size)
    {
        const std::int32_t steps = steps_log2<1>(static_cast<float>(size + 0.25)) + 4;
        return static_cast<std::size_t>(
            clamp_int(steps, 0, static_cast<std::int32_t>(kResidualContexts) - 1)
        );
    }

    /// Wedges of a vertex among which a known one is looked for; bounds the time.
    static constexpr std::size_t kMostTwins = 64;

    /// What the residual of the number before tells of the next one, beside what is expected of it.
    static constexpr double kOwn = 0.75;
    static constexpr double kBefore = 0.25;

    std::span<const AttributeInfo> attributes_;
    const LevelMesh& mesh_;
    AttributeState& state_;
    WedgeNeighbours neighbours_;
    ValueFit fit_;
    std::uint32_t twin_ = kNoWedge;
    std::uint32_t first_new_;
    std::uint32_t left_;
    /// By attribute and number of each new wedge 1 + the size of its residual; 0 where there is none.
    std::vector<std::vector<float>> sizes_;
};

}  // namespace vsplit::codec
