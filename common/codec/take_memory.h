#pragma once

#include "core/result.h"

#include <new>

namespace vsplit::codec {

/// Runs what allocates within the limits: they may allow more than there is.
/// Error: LimitExceeded when there is not enough memory.
template <typename Allocate>
[[nodiscard]] Result<void> take_memory(const Allocate& allocate)
{
    try
    {
        allocate();
    }
    catch (const std::bad_alloc&)
    {
        return fail(ErrorCode::LimitExceeded, "there is not enough memory for the mesh");
    }
    return {};
}

}  // namespace vsplit::codec
