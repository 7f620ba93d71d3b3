#pragma once

#include "codec/context_model.h"
#include "codec/level_attributes.h"

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace vsplit::codec {

/// Number of a wedge that is not known.
inline constexpr std::uint32_t kNoWedge = std::numeric_limits<std::uint32_t>::max();

/// Contexts of the residuals of one number of a value, by how large they are expected to be.
inline constexpr std::size_t kResidualContexts = 24;

namespace detail {

/// Observations that the initial state of a residual's model stands for.
inline constexpr std::uint16_t kInitialObservations = 4;

/// A probability as an AdaptiveBit has it.
[[nodiscard]] constexpr AdaptiveBit initial_bit(double probability)
{
    const double kept = probability < 0.01 ? 0.01 : probability > 0.99 ? 0.99 : probability;
    return {static_cast<std::uint16_t>(kept * 65536.0 + 0.5), kInitialObservations};
}

/// What residuals of mean size 2^((context - 4) / 2) look like when they decay exponentially.
[[nodiscard]] constexpr IntegerModel initial_residual(std::size_t context)
{
    constexpr double kRootHalf = 0.70710678118654752440;
    double size = 0.25;
    for (std::size_t c = 0; c < context; c += 2)
    {
        size *= c + 1 == context ? 1.0 / kRootHalf : 2.0;
    }
    IntegerModel model;
    model.nonzero = initial_bit(table_exp(-0.5 / size));
    double power = 1.0;
    for (std::size_t e = 0; e < model.prefix.size(); ++e)
    {
        const double exponent = power / size;
        model.prefix[e] = initial_bit(exponent > 16.0 ? 0.0 : table_exp(-exponent));
        power *= 2.0;
    }
    return model;
}

/// The same for all contexts.
[[nodiscard]] constexpr std::array<IntegerModel, kResidualContexts> initial_residuals()
{
    std::array<IntegerModel, kResidualContexts> models{};
    for (std::size_t context = 0; context < models.size(); ++context)
    {
        models[context] = initial_residual(context);
    }
    return models;
}

inline constexpr auto kInitialResiduals = initial_residuals();

}  // namespace detail

/// Learned statistics of wedges and groups.
struct WedgeModel
{
    std::array<AdaptiveBit, 16> has_breaks{};  ///< By breaks known at other ends, two bits each.
    std::array<AdaptiveBit, 36> is_break{};    ///< See WedgeCoder::break_context().
    std::array<AdaptiveBit, 18> same{};        ///< Of vertices with several known wedges.
    AdaptiveBit follows{};                     ///< The wedge that comes next around the vertex.
    std::array<AdaptiveBit, 3> group{};        ///< The neighbour's group again.
};

/// Learned statistics of one attribute.
struct ValueModel
{
    AdaptiveBit same_value{};  ///< As another wedge of the vertex.
    /// By number of a value.
    std::vector<std::array<IntegerModel, kResidualContexts>> residual;

    /// The initial state of a model for values of `numbers` numbers.
    explicit ValueModel(std::size_t numbers) : residual(numbers, detail::kInitialResiduals) {}
};

/// Everything that lasts from one level's attributes to the next.
struct AttributeState
{
    LevelAttributes shown;
    /// By vertex the first of its wedges and by wedge the next one of its vertex, counter-clockwise;
    /// kNoWedge behind the last.
    std::vector<std::uint32_t> first_wedge;
    std::vector<std::uint32_t> next_wedge;
    WedgeModel wedge_model;
    std::vector<ValueModel> value_models;  ///< By attribute.
    std::vector<std::uint8_t> lacks;       ///< By attribute the low bits that its numbers lack.
};

}  // namespace vsplit::codec
