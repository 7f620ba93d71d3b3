// Based on: Ericson, "Real-Time Collision Detection", 2005, section 5.1.5 (closest point on a triangle).
#include "precompute/fan_distance.h"

namespace vsplit::precompute {
namespace {

using Point = std::array<float, 3>;

Point operator-(const Point& a, const Point& b)
{
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

float dot(const Point& a, const Point& b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Share of the end of an edge in its point closest to another one.
float share_of_end(float along, float beyond)
{
    return along + beyond > 0.0F ? along / (along + beyond) : 0.0F;
}

}  // namespace

std::array<float, 3> closest_shares(
    const Point& point, const Point& a, const Point& b, const Point& c
)
{
    const Point ab = b - a;
    const Point ac = c - a;
    const Point ap = point - a;
    const Point bp = point - b;
    const Point cp = point - c;
    const float d1 = dot(ab, ap);
    const float d2 = dot(ac, ap);
    if (d1 <= 0.0F && d2 <= 0.0F)
    {
        return {1.0F, 0.0F, 0.0F};
    }
    const float d3 = dot(ab, bp);
    const float d4 = dot(ac, bp);
    if (d3 >= 0.0F && d4 <= d3)
    {
        return {0.0F, 1.0F, 0.0F};
    }
    const float vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0F && d1 >= 0.0F && d3 <= 0.0F)
    {
        const float share = share_of_end(d1, -d3);
        return {1.0F - share, share, 0.0F};
    }
    const float d5 = dot(ab, cp);
    const float d6 = dot(ac, cp);
    if (d6 >= 0.0F && d5 <= d6)
    {
        return {0.0F, 0.0F, 1.0F};
    }
    const float vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0F && d2 >= 0.0F && d6 <= 0.0F)
    {
        const float share = share_of_end(d2, -d6);
        return {1.0F - share, 0.0F, share};
    }
    const float va = d3 * d6 - d5 * d4;
    if (va <= 0.0F && d4 >= d3 && d5 >= d6)
    {
        const float share = share_of_end(d4 - d3, d5 - d6);
        return {0.0F, 1.0F - share, share};
    }
    const float inverse = 1.0F / (va + vb + vc);
    return {va * inverse, vb * inverse, vc * inverse};
}

FaceFan::Closest FaceFan::closest(const CollapseMesh& mesh, const std::array<float, 3>& point) const
{
    using lanes::Vector4;
    const Vector4 centre = lanes::splat(centre_);
    const Vector4 to_point = lanes::splat(point) - centre;
    const std::size_t faces = size_ - 1;
    float best = std::numeric_limits<float>::infinity();
    std::size_t best_face = 0;
    for (std::size_t i = 0; i < faces; i += lanes::kLanes)
    {
        const Vector4 ab = lanes::load(ring_, i) - centre;
        const Vector4 ac = lanes::load(ring_, i + 1) - centre;
        const auto squares =
            lanes::store(lanes::squared_distance(to_point, ab, ac, lanes::invert(ab, ac)));
        for (std::size_t lane = 0; lane < lanes::kLanes; ++lane)
        {
            if (squares[lane] < best)
            {
                best = squares[lane];
                best_face = std::min(i + lane, faces - 1);
            }
        }
    }
    const std::array<std::uint32_t, 3> corners{
        centre_vertex_, vertex_[best_face], vertex_[best_face + 1]};
    std::array<float, 3> shares =
        closest_shares(point, centre_, ring_point(best_face), ring_point(best_face + 1));
    // The fan of a hub is long to look through and says nothing that its neighbours do not.
    for (std::size_t k = 0; k < 3; ++k)
    {
        shares[k] -= mesh.valence(corners[k]) > kMostFaces ? 2.0F : 0.0F;
    }
    const auto largest = std::max_element(shares.begin(), shares.end()) - shares.begin();
    return {best, face_[best_face], corners[static_cast<std::size_t>(largest)]};
}

}  // namespace vsplit::precompute
