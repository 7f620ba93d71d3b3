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
    std::array<std::array<IntegerModel, kResidualContexts>, 4> residual{};
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
};

}  // namespace vsplit::codec
