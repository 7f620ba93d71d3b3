#include "view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace vsplit::client {
namespace {

using Vector4 = std::array<double, 4>;

Vector4 multiply(const Matrix4& matrix, const Vector4& v)
{
    Vector4 result{};
    for (std::size_t row = 0; row < 4; ++row)
    {
        for (std::size_t column = 0; column < 4; ++column)
        {
            result[row] += static_cast<double>(matrix[4 * column + row]) * v[column];
        }
    }
    return result;
}

std::array<double, 3> project(const View& view, const std::array<double, 3>& p)
{
    const Vector4 clip = multiply(view.to_clip, multiply(view.to_eye, {p[0], p[1], p[2], 1.0}));
    return {clip[0] / clip[3], clip[1] / clip[3], clip[2] / clip[3]};
}

constexpr std::array<double, 3> kLow{10.0, -2.0, 5.0};
constexpr std::array<double, 3> kHigh{13.0, 6.0, 6.0};

TEST(Turntable, KeepsTheBoxInThePictureAtEveryAngle)
{
    for (const double aspect : {0.75, 1.0, 1.6})
    {
        for (const UpAxis up : {UpAxis::X, UpAxis::Y, UpAxis::Z})
        {
            const Turntable turntable(kLow, kHigh, aspect, up);
            double widest = 0.0;
            for (int step = 0; step < 360; step += 5)
            {
                const View view = turntable.view(step * 0.0174532925);
                for (unsigned corner = 0; corner < 8; ++corner)
                {
                    const auto p = project(
                        view,
                        {corner & 1U ? kHigh[0] : kLow[0],
                         corner & 2U ? kHigh[1] : kLow[1],
                         corner & 4U ? kHigh[2] : kLow[2]}
                    );
                    ASSERT_LE(std::abs(p[0]), 0.965);
                    ASSERT_LE(std::abs(p[1]), 0.965);
                    ASSERT_LE(std::abs(p[2]), 1.0);
                    widest = std::max({widest, std::abs(p[0]), std::abs(p[1])});
                }
            }
            EXPECT_GE(widest, 0.85);  // and fills it
        }
    }
}

TEST(Turntable, ShowsTheUpAxisPointingUp)
{
    const std::array<double, 3> low{-1.0, -1.0, -1.0};
    const std::array<double, 3> high{1.0, 1.0, 1.0};
    const std::array<std::array<double, 3>, 3> tips{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const Turntable turntable(low, high, 1.0, static_cast<UpAxis>(axis));
        const auto p = project(turntable.view(0.7), tips[axis]);
        EXPECT_NEAR(p[0], 0.0, 1e-6);
        EXPECT_GT(p[1], 0.3);
    }
}

TEST(Turntable, KeepsRightHandedAxes)
{
    for (const UpAxis up : {UpAxis::X, UpAxis::Y, UpAxis::Z})
    {
        const View view = Turntable(kLow, kHigh, 1.0, up).view(1.0);
        const auto& m = view.to_eye;
        const double determinant = m[0] * (m[5] * m[10] - m[6] * m[9]) -
                                   m[4] * (m[1] * m[10] - m[2] * m[9]) +
                                   m[8] * (m[1] * m[6] - m[2] * m[5]);
        EXPECT_NEAR(determinant, 1.0, 1e-5);
    }
}

TEST(Turntable, IsFiniteForAPoint)
{
    const View view = Turntable(kLow, kLow, 0.75).view(0.0);
    for (std::size_t i = 0; i < 16; ++i)
    {
        EXPECT_TRUE(std::isfinite(view.to_eye[i]));
        EXPECT_TRUE(std::isfinite(view.to_clip[i]));
    }
}

}  // namespace
}  // namespace vsplit::client
