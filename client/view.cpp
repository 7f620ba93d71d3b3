#include "view.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vsplit::client {
namespace {

constexpr double kTilt = 18.0 * std::numbers::pi / 180.0;
constexpr double kFieldOfView = 30.0 * std::numbers::pi / 180.0;  // of the shorter side
constexpr double kMargin = 0.96;
constexpr int kCircleSteps = 64;

// Brings the axis that points up to y, keeping the axes right-handed.
std::array<double, 3> upright(const std::array<double, 3>& p, UpAxis up)
{
    switch (up)
    {
        case UpAxis::X:
            return {p[1], p[0], -p[2]};
        case UpAxis::Z:
            return {p[0], p[2], -p[1]};
        case UpAxis::Y:
            break;
    }
    return p;
}

struct HalfAngles
{
    double horizontal;  ///< Tangent of half the horizontal field of view.
    double vertical;    ///< Tangent of half the vertical field of view.
};

HalfAngles half_angles(double aspect)
{
    const double shorter = std::tan(kFieldOfView / 2);
    return aspect < 1.0 ? HalfAngles{shorter, shorter / aspect}
                        : HalfAngles{shorter * aspect, shorter};
}

// The turning box sweeps a cylinder; the nearest distance that keeps both its rims in the picture.
double fitting_distance(double cylinder_radius, double half_height, double aspect)
{
    const HalfAngles half = half_angles(aspect);
    double distance = 0.0;
    for (int i = 0; i < 2 * kCircleSteps; ++i)
    {
        const double angle = 2 * std::numbers::pi * i / kCircleSteps;
        const double x = cylinder_radius * std::cos(angle);
        const double depth = cylinder_radius * std::sin(angle);
        const double y = i < kCircleSteps ? half_height : -half_height;
        const double eye_y = y * std::cos(kTilt) - depth * std::sin(kTilt);
        const double eye_z = y * std::sin(kTilt) + depth * std::cos(kTilt);
        distance = std::max(distance, std::abs(x) / (kMargin * half.horizontal) + eye_z);
        distance = std::max(distance, std::abs(eye_y) / (kMargin * half.vertical) + eye_z);
    }
    return distance;
}

}  // namespace

Turntable::Turntable(
    const std::array<double, 3>& box_min,
    const std::array<double, 3>& box_max,
    double aspect,
    UpAxis up
)
    : up_(up), aspect_(aspect)
{
    std::array<double, 3> half{};
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        centre_[axis] = box_min[axis] + (box_max[axis] - box_min[axis]) / 2;
        half[axis] = std::max(0.0, (box_max[axis] - box_min[axis]) / 2);
    }
    const auto extent = upright(half, up);
    const double cylinder_radius = std::hypot(extent[0], extent[2]);
    const double half_height = std::abs(extent[1]);
    radius_ = std::hypot(cylinder_radius, half_height);
    if (!(radius_ > 0.0))
    {
        radius_ = 1.0;
    }
    distance_ = std::max(fitting_distance(cylinder_radius, half_height, aspect), radius_ * 1.05);
}

View Turntable::view(double angle) const
{
    const double cos_turn = std::cos(angle);
    const double sin_turn = std::sin(angle);
    const double cos_tilt = std::cos(kTilt);
    const double sin_tilt = std::sin(kTilt);
    View view;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        std::array<double, 3> unit{};
        unit[axis] = 1.0;
        const auto p = upright(unit, up_);
        const double x = cos_turn * p[0] + sin_turn * p[2];
        const double z = cos_turn * p[2] - sin_turn * p[0];
        view.to_eye[4 * axis + 0] = static_cast<float>(x);
        view.to_eye[4 * axis + 1] = static_cast<float>(cos_tilt * p[1] - sin_tilt * z);
        view.to_eye[4 * axis + 2] = static_cast<float>(sin_tilt * p[1] + cos_tilt * z);
    }
    for (std::size_t row = 0; row < 3; ++row)
    {
        double moved = row == 2 ? -distance_ : 0.0;
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            moved -= static_cast<double>(view.to_eye[4 * axis + row]) * centre_[axis];
        }
        view.to_eye[12 + row] = static_cast<float>(moved);
    }
    view.to_eye[15] = 1.0F;

    const HalfAngles half = half_angles(aspect_);
    const double near = std::max(distance_ - 1.05 * radius_, 0.01 * radius_);
    const double far = distance_ + 1.05 * radius_;
    view.to_clip[0] = static_cast<float>(1.0 / half.horizontal);
    view.to_clip[5] = static_cast<float>(1.0 / half.vertical);
    view.to_clip[10] = static_cast<float>((near + far) / (near - far));
    view.to_clip[11] = -1.0F;
    view.to_clip[14] = static_cast<float>(2.0 * near * far / (near - far));
    return view;
}

}  // namespace vsplit::client
