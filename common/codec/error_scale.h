#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace vsplit::codec {

/// Steps per factor of two on the logarithmic scale on which the index stores errors.
inline constexpr int kErrorStepsPerOctave = 8;

/// Code for an error of zero; larger codes do not occur.
inline constexpr std::uint32_t kZeroErrorCode = 320;

/// 2^(-i/8): written out so that every machine reads the same error from a code.
inline constexpr std::array<double, kErrorStepsPerOctave> kErrorSteps{
    1.0,
    0.9170040432046712,
    0.8408964152537145,
    0.7711054127039704,
    0.7071067811865476,
    0.6484197773255048,
    0.5946035575013605,
    0.5452538663326288,
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
