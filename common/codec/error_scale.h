#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace vsplit::codec {

/// Steps per factor of two on the logarithmic scale on which the index stores errors.
inline constexpr int kErrorStepsPerOctave = 32;

/// Code for an error of zero; larger codes do not occur.
inline constexpr std::uint32_t kZeroErrorCode = 1280;

/// 2^(-i/32): written out so that every machine reads the same error from a code.
inline constexpr std::array<double, kErrorStepsPerOctave> kErrorSteps{
    1.0,
    0.9785720620877001,
    0.9576032806985737,
    0.93708381705515,
    0.9170040432046712,
    0.8973545375015536,
    0.8781260801866497,
    0.859309649061239,
    0.8408964152537145,
    0.8228777390769825,
    0.8052451659746271,
    0.7879904225539432,
    0.7711054127039704,
    0.7545822137967114,
    0.7384130729697497,
    0.7225904034885233,
    0.7071067811865476,
    0.691954940981916,
    0.6771277734684463,
    0.6626183215798707,
    0.6484197773255048,
    0.6345254785958666,
    0.620928906036742,
    0.6076236799902345,
    0.5946035575013605,
    0.5818624293887887,
    0.5693943173783458,
    0.5571933712979462,
    0.5452538663326288,
    0.5335702003384118,
    0.5221368912137069,
    0.5109485743270583,
};

/// Turns an error code into a share of the bounding-box diagonal.
/// `code`: 0 .. kZeroErrorCode.
[[nodiscard]] inline double error_from_code(std::uint32_t code)
{
    if (code >= kZeroErrorCode)
    {
        return 0.0;
    }
    const auto octaves = static_cast<int>(code) / kErrorStepsPerOctave;
    return std::ldexp(kErrorSteps[code % kErrorStepsPerOctave], -octaves);
}

/// Finds the largest code whose error is not below `share` of the diagonal, so that the index never
/// promises too much. Shares above 1 are stored as 1, below 2^-39.9 as zero.
[[nodiscard]] inline std::uint32_t error_to_code(double share)
{
    if (!(share > std::ldexp(1.0, -39)))
    {
        return kZeroErrorCode;
    }
    // One more than the logarithm says, which may be rounded down.
    auto code = static_cast<std::uint32_t>(
        std::fmax(0.0, std::floor(-std::log2(share) * kErrorStepsPerOctave) + 1.0)
    );
    while (code > 0 && error_from_code(code) < share)
    {
        --code;
    }
    return code;
}

}  // namespace vsplit::codec
