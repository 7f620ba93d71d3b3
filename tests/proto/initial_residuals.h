#pragma once

#include "codec/attribute_state.h"

#include <cstdint>
#include <vector>

namespace vsplit::test {

/// Probabilities of the initial residual models, in the order in which the document lists them.
[[nodiscard]] inline std::vector<std::uint16_t> initial_residuals()
{
    std::vector<std::uint16_t> table;
    for (const codec::IntegerModel& model : codec::detail::kInitialResiduals)
    {
        table.push_back(model.nonzero.probability);
        for (const codec::AdaptiveBit& bit : model.prefix)
        {
            table.push_back(bit.probability);
        }
    }
    return table;
}

}  // namespace vsplit::test
