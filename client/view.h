#pragma once

#include <array>
#include <cstdint>

namespace vsplit::client {

/// A 4x4 matrix, column by column, as OpenGL takes it.
using Matrix4 = std::array<float, 16>;

/// The coordinate axis that points up.
enum class UpAxis : std::uint8_t
{
    X,
    Y,
    Z,
};

/// Where the camera stands, as matrices for the vertex shader.
struct View
{
    Matrix4 to_eye{};   ///< Model space to eye space: rotation and translation, no scale.
    Matrix4 to_clip{};  ///< Eye space to clip space.
};

/// A camera that looks slightly down on a model which turns about its vertical axis. It is framed
/// from the bounding box alone, so that the picture does not jump when the model gets finer.
/// Immutable; thread safe.
class Turntable
{
public:
    /// `box_min`, `box_max`: bounding box, model units; `aspect`: width over height, > 0.
    /// A box without extent is given one.
    Turntable(
        const std::array<double, 3>& box_min,
        const std::array<double, 3>& box_max,
        double aspect,
        UpAxis up = UpAxis::Y
    );

    /// Returns the view after the model has turned by `angle`, radians.
    [[nodiscard]] View view(double angle) const;

    /// Distance from the camera to the box's centre, model units.
    [[nodiscard]] double distance() const { return distance_; }

private:
    std::array<double, 3> centre_{};
    UpAxis up_ = UpAxis::Y;
    double radius_ = 1.0;  ///< Half the diagonal of the box.
    double distance_ = 1.0;
    double aspect_ = 1.0;
};

}  // namespace vsplit::client
