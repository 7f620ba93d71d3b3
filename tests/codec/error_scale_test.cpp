#include "codec/error_scale.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace vsplit::test {
namespace {

using codec::error_from_code;
using codec::error_to_code;
using codec::kErrorStepsPerOctave;
using codec::kZeroErrorCode;

TEST(ErrorScale, FallsWithEveryCode)
{
    EXPECT_EQ(error_from_code(0), 1.0);
    for (std::uint32_t code = 0; code < kZeroErrorCode; ++code)
    {
        EXPECT_GT(error_from_code(code), error_from_code(code + 1));
    }
    EXPECT_EQ(error_from_code(kZeroErrorCode), 0.0);
}

TEST(ErrorScale, HasEqualStepsOnALogarithmicScale)
{
    for (std::uint32_t code = 0; code + 1 < kZeroErrorCode; ++code)
    {
        EXPECT_NEAR(
            std::log2(error_from_code(code) / error_from_code(code + 1)),
            1.0 / kErrorStepsPerOctave,
            1e-12
        );
    }
}

TEST(ErrorScale, NeverPromisesTooMuchAndIsTight)
{
    for (double share = 1.0; share > std::ldexp(1.0, -39); share *= 0.99731)
    {
        const double told = error_from_code(error_to_code(share));
        EXPECT_GE(told, share);
        EXPECT_LE(told, share * std::exp2(1.0 / kErrorStepsPerOctave) * (1.0 + 1e-12));
    }
}

TEST(ErrorScale, ReturnsEveryCodeThatItGave)
{
    for (std::uint32_t code = 0; code + kErrorStepsPerOctave < kZeroErrorCode; ++code)
    {
        EXPECT_EQ(error_to_code(error_from_code(code)), code);
    }
}

TEST(ErrorScale, IsMonotone)
{
    std::uint32_t before = 0;
    for (double share = 1.5; share > 1e-13; share *= 0.995)
    {
        const std::uint32_t code = error_to_code(share);
        EXPECT_GE(code, before);
        before = code;
    }
}

TEST(ErrorScale, StoresOddSharesSafely)
{
    EXPECT_EQ(error_to_code(0.0), kZeroErrorCode);
    EXPECT_EQ(error_to_code(-1.0), kZeroErrorCode);
    EXPECT_EQ(error_to_code(std::numeric_limits<double>::denorm_min()), kZeroErrorCode);
    EXPECT_EQ(error_to_code(17.0), 0U);
    EXPECT_EQ(error_to_code(std::numeric_limits<double>::infinity()), 0U);
    EXPECT_EQ(error_to_code(std::nan("")), kZeroErrorCode);
}

}  // namespace
}  // namespace vsplit::test
