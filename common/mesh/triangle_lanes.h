#pragma once

// Based on: Ericson, "Real-Time Collision Detection", 2005, section 5.1.5 (closest point on a triangle),
// for four triangles at once and without a branch.

#include "mesh/lanes.h"

namespace vsplit::lanes {

/// The inverses that the distance to a triangle divides by; 0 where the edge or the triangle is
/// degenerate.
struct TriangleInverses
{
    Float4 ab;
    Float4 ac;
    Float4 bc;
    Float4 determinant;  ///< Of the Gram matrix of both edges.
};

/// Returns 1 / value, or 0 where the value is not positive.
[[nodiscard]] inline Float4 inverse_or_zero(Float4 value)
{
    const Float4 zero = splat(0.0F);
    const Float4 one = splat(1.0F);
    const auto positive = value > zero;
    return positive ? one / (positive ? value : one) : zero;
}

/// Returns the inverses for four triangles with edges b - a and c - a.
[[nodiscard]] inline TriangleInverses invert(const Vector4& ab, const Vector4& ac)
{
    const Vector4 bc = ac - ab;
    const Float4 ab_ab = dot(ab, ab);
    const Float4 ab_ac = dot(ab, ac);
    const Float4 ac_ac = dot(ac, ac);
    return {
        inverse_or_zero(ab_ab),
        inverse_or_zero(ac_ac),
        inverse_or_zero(dot(bc, bc)),
        inverse_or_zero(ab_ab * ac_ac - ab_ac * ab_ac),
    };
}

/// Returns the squared distances of points to triangles, lane by lane. `ap`: point - a; `ab`, `ac`:
/// edges from a; `inverse`: see invert(). The closest point lies inside the triangle or on one of its
/// edges: all four candidates are computed and the best one wins. A sliver that is wrongly taken for
/// "outside" is covered by its edges.
[[nodiscard]] inline Float4 squared_distance(
    const Vector4& ap, const Vector4& ab, const Vector4& ac, const TriangleInverses& inverse
)
{
    const Float4 ab_ab = dot(ab, ab);
    const Float4 ab_ac = dot(ab, ac);
    const Float4 ac_ac = dot(ac, ac);
    const Float4 ab_ap = dot(ab, ap);
    const Float4 ac_ap = dot(ac, ap);
    const Vector4 bc = ac - ab;
    const Vector4 bp = ap - ab;
    const Float4 along_ab = clamp01(ab_ap * inverse.ab);
    const Float4 along_ac = clamp01(ac_ap * inverse.ac);
    const Float4 along_bc = clamp01(dot(bc, bp) * inverse.bc);
    const Float4 on_edge =
        min(min(squared_length(ap, along_ab, ab), squared_length(ap, along_ac, ac)),
            squared_length(bp, along_bc, bc));

    const Float4 s = (ac_ac * ab_ap - ab_ac * ac_ap) * inverse.determinant;
    const Float4 t = (ab_ab * ac_ap - ab_ac * ab_ap) * inverse.determinant;
    const Vector4 rest{
        ap.x - s * ab.x - t * ac.x, ap.y - s * ab.y - t * ac.y, ap.z - s * ab.z - t * ac.z};
    const Float4 zero = splat(0.0F);
    const auto inside = (s >= zero) & (t >= zero) & (s + t <= splat(1.0F));
    return inside ? min(on_edge, dot(rest, rest)) : on_edge;
}

}  // namespace vsplit::lanes
