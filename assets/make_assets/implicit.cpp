// Based on: Quilez, "Distance functions" and "Smooth minimum", 2008 and 2013; Catmull, Rom, "A Class
// of Local Interpolating Splines", 1974.
#include "make_assets/implicit.h"

#include <algorithm>
#include <iterator>
#include <limits>

namespace vsplit::assets {

namespace {

constexpr int kSegments = 8;  // straight pieces between two knots

Knot mix(const Knot& a, double weight_a, const Knot& b, double weight_b)
{
    return {a.at * weight_a + b.at * weight_b, a.radius * weight_a + b.radius * weight_b};
}

// The curve from b to c at t in [0, 1].
Knot catmull_rom(const Knot& a, const Knot& b, const Knot& c, const Knot& d, double t)
{
    const double t2 = t * t, t3 = t2 * t;
    const Knot outer = mix(a, -0.5 * t + t2 - 0.5 * t3, d, 0.5 * t3 - 0.5 * t2);
    const Knot inner = mix(b, 1.0 - 2.5 * t2 + 1.5 * t3, c, 0.5 * t + 2.0 * t2 - 1.5 * t3);
    return mix(outer, 1.0, inner, 1.0);
}

std::vector<Knot> subdivide(const std::vector<Knot>& axis)
{
    const std::size_t last = axis.size() - 1;
    std::vector<Knot> fine{axis.front()};
    for (std::size_t i = 0; i < last; ++i)
    {
        // Beyond the ends the curve goes on straight.
        const Knot before = i > 0 ? axis[i - 1] : mix(axis[0], 2.0, axis[1], -1.0);
        const Knot after = i + 2 <= last ? axis[i + 2] : mix(axis[last], 2.0, axis[last - 1], -1.0);
        for (int s = 1; s <= kSegments; ++s)
        {
            const double t = static_cast<double>(s) / kSegments;
            fine.push_back(catmull_rom(before, axis[i], axis[i + 1], after, t));
        }
    }
    return fine;
}

// Stretching space along one direction makes what is measured in it thinner.
Vector3 stretched(const Part& part, const Vector3& point)
{
    return point + part.flat_along * ((part.flatness - 1.0) * dot(point, part.flat_along));
}

}  // namespace

double smooth_minimum(double a, double b, double blend)
{
    const double near = std::max(blend - std::abs(a - b), 0.0) / blend;
    return std::min(a, b) - near * near * blend * 0.25;
}

Body::Body(const std::vector<Part>& parts)
{
    std::transform(parts.begin(), parts.end(), std::back_inserter(members_), make_member);
}

Body::Ball Body::ball_round(std::span<const Knot> axis)
{
    Ball ball;
    for (const Knot& knot : axis)
    {
        ball.centre = ball.centre + knot.at * (1.0 / static_cast<double>(axis.size()));
    }
    for (const Knot& knot : axis)
    {
        ball.radius = std::max(ball.radius, length(knot.at - ball.centre) + knot.radius);
    }
    return ball;
}

Body::Member Body::make_member(const Part& part)
{
    std::vector<Knot> axis = subdivide(part.axis);
    Member member{part, ball_round(axis), {}};
    for (Knot& knot : axis)
    {
        knot.at = stretched(part, knot.at);
    }
    axis.push_back(axis.back());  // a single knot makes a ball
    for (std::size_t i = 0; i + 1 < axis.size(); ++i)
    {
        if (i % kSegments == 0)
        {
            const std::size_t count = std::min<std::size_t>(kSegments + 1, axis.size() - i);
            member.stretches.push_back({ball_round(std::span(axis).subspan(i, count)), {}});
        }
        const Vector3 along = axis[i + 1].at - axis[i].at;
        const double square = dot(along, along);
        const double inverse = square > 0.0 ? 1.0 / square : 0.0;
        const double growth = axis[i + 1].radius - axis[i].radius;
        member.stretches.back().segments.push_back(
            {axis[i].at, along, inverse, axis[i].radius, growth}
        );
    }
    return member;
}

double Body::distance(const Member& member, const Vector3& point)
{
    const Vector3 p = stretched(member.part, point);
    double nearest = std::numeric_limits<double>::max();
    for (const Stretch& stretch : member.stretches)
    {
        if (stretch.bound.is_farther(p, nearest))
        {
            continue;
        }
        for (const Segment& segment : stretch.segments)
        {
            const Vector3 offset = p - segment.from;
            const double along =
                std::clamp(dot(offset, segment.axis) * segment.inverse_square, 0.0, 1.0);
            const Vector3 away = offset - segment.axis * along;
            nearest = std::min(nearest, length(away) - segment.radius - along * segment.growth);
        }
    }
    return nearest;
}

double Body::operator()(const Vector3& point) const
{
    double result = distance(members_.front(), point);
    for (std::size_t i = 1; i < members_.size(); ++i)
    {
        // Both blends leave the result alone where the part is farther by the blend's width.
        const Part& part = members_[i].part;
        const double sign = part.carve ? -1.0 : 1.0;
        if (!members_[i].bound.is_farther(point, sign * result + part.blend))
        {
            result = sign * smooth_minimum(sign * result, distance(members_[i], point), part.blend);
        }
    }
    return result;
}

void add_mirrored(std::vector<Part>& parts, const Part& part)
{
    Part other = part;
    for (Knot& knot : other.axis)
    {
        knot.at.z = -knot.at.z;
    }
    other.flat_along.z = -other.flat_along.z;
    parts.push_back(part);
    parts.push_back(other);
}

double torus_distance(
    const Vector3& point, const Vector3& centre, const Vector3& axis, double radius, double tube
)
{
    const Vector3 offset = point - centre;
    const double height = dot(offset, axis);
    const double out = length(offset - axis * height) - radius;
    return std::sqrt(out * out + height * height) - tube;
}

}  // namespace vsplit::assets
