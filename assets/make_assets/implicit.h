#pragma once

#include "make_assets/vector3.h"

#include <algorithm>
#include <span>
#include <vector>

namespace vsplit::assets {

/// A point on the axis of a part and the part's radius there.
struct Knot
{
    Vector3 at;
    double radius = 1.0;
};

/// A bent, tapered, possibly flattened rod: what bodies, legs, ears and horns are made of.
struct Part
{
    std::vector<Knot> axis;  ///< At least one knot; joined by a Catmull-Rom curve.
    double blend = 0.1;      ///< Width over which it flows into the parts before it, > 0.
    Vector3 flat_along{};    ///< Unit direction in which it is flattened; zero for none.
    double flatness = 1.0;   ///< How many times thinner it is along `flat_along`, >= 1.
    bool carve = false;      ///< Is taken away instead of added.
};

/// A closed surface: the zero set of parts blended in order. Negative inside.
class Body
{
public:
    /// `parts`: at least one, the first not carved.
    explicit Body(const std::vector<Part>& parts);

    /// About the signed distance of `point` from the surface. Cost: the parts near `point` count, for
    /// the others a ball round them is tested. Thread safe.
    [[nodiscard]] double operator()(const Vector3& point) const;

private:
    struct Segment  // of an axis
    {
        Vector3 from;
        Vector3 axis;
        double inverse_square;  // of the axis' length
        double radius;
        double growth;  // of the radius from end to end
    };

    struct Ball
    {
        Vector3 centre;
        double radius = 0.0;

        // True when what the ball holds is certainly farther from `point` than `distance`.
        [[nodiscard]] bool is_farther(const Vector3& point, double distance) const
        {
            const Vector3 offset = point - centre;
            const double reach = std::max(radius + distance, 0.0);
            return dot(offset, offset) > reach * reach;
        }
    };

    struct Stretch  // the segments between two knots
    {
        Ball bound;
        std::vector<Segment> segments;
    };

    struct Member
    {
        Part part;
        Ball bound;
        std::vector<Stretch> stretches;  // of the axis, in stretched space
    };

    [[nodiscard]] static Ball ball_round(std::span<const Knot> axis);
    [[nodiscard]] static Member make_member(const Part& part);
    [[nodiscard]] static double distance(const Member& member, const Vector3& point);

    std::vector<Member> members_;
};

/// Appends `part` and its mirror image in the plane z = 0.
void add_mirrored(std::vector<Part>& parts, const Part& part);

/// Distance of `point` from the circle of that `radius` round `centre` in the plane across `axis`
/// (unit length), minus `tube`: a torus.
[[nodiscard]] double torus_distance(
    const Vector3& point, const Vector3& centre, const Vector3& axis, double radius, double tube
);

/// The minimum of two distances, rounded off where they differ by less than `blend`, > 0.
/// Source: Quilez, "Smooth minimum", 2013, the quadratic polynomial variant.
[[nodiscard]] double smooth_minimum(double a, double b, double blend);

}  // namespace vsplit::assets
