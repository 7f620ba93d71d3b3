#pragma once

#include "encoded_torus.h"

#include <cstdint>
#include <vector>

namespace vsplit::client {

/// encoded_torus() with a material, of which the texture comes in chunks between the levels, and an
/// image that nothing draws. Its chunk of attributes is coded in a way that is not known yet.
struct PaintedStream
{
    TestStream stream;
    std::uint64_t appearance_bytes = 0;  ///< With checksums.
    std::uint64_t drawn_bytes = 0;       ///< Texture chunks of the image that is drawn.
    std::uint64_t idle_bytes = 0;        ///< Texture chunks of the other.
};

/// Makes it; always the same.
[[nodiscard]] const PaintedStream& painted_torus();

}  // namespace vsplit::client
