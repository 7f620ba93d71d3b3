#pragma once

#include "core/error.h"

#include <tl/expected.hpp>

#include <cstdint>
#include <string>
#include <utility>

namespace vsplit {

/// Either a value or the Error that explains why there is none.
template <typename T>
using Result = tl::expected<T, Error>;

/// Builds the failing side of a Result.
/// `code`: the reason; `message`: one line for people; `offset`: byte offset in the data, 0 if none.
[[nodiscard]] inline tl::unexpected<Error> fail(
    ErrorCode code, std::string message, std::uint64_t offset = 0
)
{
    return tl::unexpected<Error>(Error{code, std::move(message), offset});
}

}  // namespace vsplit

/// Returns the error of a Result-valued expression from the enclosing function, if it has one.
#define VSPLIT_TRY(expression)                                                 \
    do                                                                         \
    {                                                                          \
        if (auto&& vsplit_try_result = (expression); !vsplit_try_result)       \
        {                                                                      \
            return tl::unexpected<::vsplit::Error>(vsplit_try_result.error()); \
        }                                                                      \
    }                                                                          \
    while (false)
