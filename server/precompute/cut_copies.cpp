#include "precompute/cut_copies.h"

namespace vsplit::precompute {

std::vector<std::uint8_t> lock_copies(std::span<const std::uint32_t> stitches)
{
    std::vector<std::uint8_t> locked(stitches.size(), 0);
    for (std::uint32_t v = 0; v < stitches.size(); ++v)
    {
        if (stitches[v] != v)
        {
            locked[v] = 1;
            locked[stitches[v]] = 1;
        }
    }
    return locked;
}

}  // namespace vsplit::precompute
