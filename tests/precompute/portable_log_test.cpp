#include "core/portable_log.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace vsplit::test {
namespace {

TEST(PortableLog, AgreesWithTheLibrary)
{
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> exponent(-1000.0, 1000.0);
    for (int i = 0; i < 20'000; ++i)
    {
        const double value = std::exp2(exponent(random));
        ASSERT_NEAR(portable_log(value), std::log(value), 1e-12 * std::abs(std::log(value)));
    }
    for (double above = 1e-9; above < 1.0; above *= 1.3)
    {
        ASSERT_NEAR(portable_log(1.0 + above), std::log1p(above), 1e-12 * above + 1e-15);
    }
}

TEST(PortableLog, IsExactAtOneAndNeverFalls)
{
    EXPECT_EQ(portable_log(1.0), 0.0);
    for (double value = 0.25; value < 4.0; value += 1.0 / 1024.0)
    {
        ASSERT_LT(portable_log(value), portable_log(value + 1.0 / 1024.0));
    }
}

TEST(PortableLog, HasTheBitsOfEveryMachine)
{
    EXPECT_EQ(portable_log(3.0), 0x1.193ea7aad030dp+0);
    EXPECT_EQ(portable_log(0.7), -0x1.6d3c324e13fdp-2);
    EXPECT_EQ(portable_exp2(0.3), 0x1.3b2c47bff8329p+0);
}

TEST(PortableExp2, AgreesWithTheLibrary)
{
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> exponent(-1000.0, 1000.0);
    for (int i = 0; i < 20'000; ++i)
    {
        const double x = exponent(random);
        ASSERT_NEAR(portable_exp2(x) / std::exp2(x), 1.0, 1e-14) << x;
    }
    EXPECT_EQ(portable_exp2(0.0), 1.0);
    EXPECT_EQ(portable_exp2(-3.0), 0.125);
}

}  // namespace
}  // namespace vsplit::test
