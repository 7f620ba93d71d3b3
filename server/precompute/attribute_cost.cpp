// Based on: Cohen, Olano, Manocha, "Appearance-Preserving Simplification", 1998 (texture deviation: how
// far a texture slides on the surface); Hoppe, "New Quadric Metric for Simplifying Meshes with
// Appearance Attributes", 1999 (values against those interpolated on the simplified surface).
#include "precompute/attribute_cost.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vsplit::precompute {
namespace {

constexpr double kOutside = -1e30;

/// Share of the mesh's diagonal that the whole range of a colour counts for. Measured at levels of 1/16 to
/// 1/4 of the vertices, with the default weight: swirl-color's error of colour falls by 25 to 58 % for 4 %
/// more bytes, gargo's by 4 to 20 % for 0.4 % more, and their shape is up to 11 % worse at 1/4 and less below,
/// but for gargo's coarsest level (19 %).
constexpr double kColorLength = 0.02;

/// Where a triangle has a smaller share than this of the texture that one of its area has on the average,
/// it counts as having that: a constant texture cannot slide.
constexpr double kLeastStretch = 0.04;

double length(const Vector3& a)
{
    return std::sqrt(dot(a, a));
}

double diagonal(std::span<const Vector3> positions)
{
    Vector3 low = positions.front();
    Vector3 high = low;
    for (const Vector3& p : positions)
    {
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            low[axis] = std::min(low[axis], p[axis]);
            high[axis] = std::max(high[axis], p[axis]);
        }
    }
    return length(high - low);
}

/// Twice the area of a triangle of texture coordinates.
double double_area(const float* a, const float* b, const float* c)
{
    const auto off = [](const float* p, const float* q, std::size_t k) {
        return static_cast<double>(p[k]) - static_cast<double>(q[k]);
    };
    return std::abs(off(b, a, 0) * off(c, a, 1) - off(b, a, 1) * off(c, a, 0));
}

/// How a point lies in a triangle.
struct Inside
{
    std::array<double, 3> share{1.0, 0.0, 0.0};  ///< Of each corner, none below 0.
    double least = kOutside;  ///< The least of them; below 0 before they were cut.
};

/// Finds the origin in a triangle, or in its plane.
Inside find_origin(const Vector3& a, const Vector3& b, const Vector3& c)
{
    const Vector3 normal = cross(b - a, c - a);
    const double square = dot(normal, normal);
    Inside inside;
    if (!(square > 0.0))
    {
        return inside;
    }
    inside.share = {dot(normal, cross(b, c)), dot(normal, cross(c, a)), dot(normal, cross(a, b))};
    inside.least = std::ranges::min(inside.share) / square;
    double sum = 0.0;
    for (double& share : inside.share)
    {
        share = std::max(share, 0.0);
        sum += share;
    }
    for (double& share : inside.share)
    {
        share /= sum;  // they add up to `square` before negative ones are cut off
    }
    return inside;
}

/// Share of `b` in the point of the segment from `a` to `b` that is nearest to the origin.
double share_along(const Vector3& a, const Vector3& b)
{
    const Vector3 along = b - a;
    const double square = dot(along, along);
    return square > 0.0 ? std::clamp(-dot(a, along) / square, 0.0, 1.0) : 0.0;
}

}  // namespace

AttributeCost::AttributeCost(
    const CollapseMesh& mesh,
    std::span<const Vector3> positions,
    const WedgeValues& values,
    double weight
)
    : mesh_(mesh), weight_(weight * weight)
{
    for (std::size_t i = 0; i < values.attributes.size() && weight > 0.0; ++i)
    {
        const AttributeKind kind = values.attributes[i].kind;
        if (kind == AttributeKind::TexCoord || kind == AttributeKind::Color)
        {
            add_layer(values.attributes[i], values.values[i], positions);
        }
    }
}

void AttributeCost::add_layer(
    const codec::AttributeInfo& info,
    std::span<const std::int32_t> coded,
    std::span<const Vector3> positions
)
{
    Layer layer{
        .components = info.components,
        .is_texture = info.kind == AttributeKind::TexCoord,
        .length = kColorLength * diagonal(positions),
        .values = {},
    };
    layer.values.resize(coded.size());
    codec::write_values(info, coded, layer.values);
    if (layer.is_texture)
    {
        double on_surface = 0.0;
        double in_texture = 0.0;
        const auto triangles = mesh_.triangles();
        const auto wedges = mesh_.wedges();
        for (std::size_t f = 0; f < triangles.size(); ++f)
        {
            const auto& [a, b, c] = triangles[f];
            on_surface += length(cross(positions[b] - positions[a], positions[c] - positions[a]));
            in_texture +=
                double_area(layer.at(wedges[f][0]), layer.at(wedges[f][1]), layer.at(wedges[f][2]));
        }
        if (!(in_texture > 0.0))
        {
            return;
        }
        layer.length = std::sqrt(on_surface / in_texture);
    }
    layers_.push_back(std::move(layer));
}

AttributeCost::Place AttributeCost::find_place(
    const OneRing& ring, std::span<const Vector3> offset, std::size_t kept, std::uint32_t wedge
) const
{
    Place place{.wedge = wedge};
    const std::uint32_t target = mesh_.next_wedge(ring, kept, wedge);
    double best = kOutside;
    for (std::size_t i = 0; i < ring.face_count; ++i)
    {
        const std::size_t j = (i + 1) % ring.size;
        const std::int32_t corner = ring.corner[i];
        if (mesh_.wedge(corner) != wedge)
        {
            continue;
        }
        place.area += 0.5 * length(cross(offset[i], offset[j]));
        const std::uint32_t first = mesh_.wedge(CollapseMesh::next(corner));
        const std::uint32_t second = mesh_.wedge(CollapseMesh::previous(corner));
        if (i != kept && j != kept)
        {
            const Inside inside = find_origin(offset[kept], offset[i], offset[j]);
            if (inside.least > best)
            {
                best = inside.least;
                place.corners = {target, first, second};
                place.share = inside.share;
            }
        }
        else if (best == kOutside)
        {
            // Where the wedge has no other face, an edge of this one is all that is left.
            const double share = share_along(offset[kept], offset[i == kept ? j : i]);
            place.corners = {target, i == kept ? second : first, target};
            place.share = {1.0 - share, share, 0.0};
        }
    }
    return place;
}

double AttributeCost::square_length(const Layer& layer, const OneRing& ring, const Place& place)
    const
{
    const double mean = layer.length * layer.length;
    if (!layer.is_texture || !(place.area > 0.0))
    {
        return mean;
    }
    double in_texture = 0.0;
    for (std::size_t i = 0; i < ring.face_count; ++i)
    {
        const std::int32_t corner = ring.corner[i];
        if (mesh_.wedge(corner) == place.wedge)
        {
            in_texture += 0.5 * double_area(
                                    layer.at(mesh_.wedge(corner)),
                                    layer.at(mesh_.wedge(CollapseMesh::next(corner))),
                                    layer.at(mesh_.wedge(CollapseMesh::previous(corner)))
                                );
        }
    }
    return place.area / std::max(in_texture, kLeastStretch * place.area / mean);
}

double AttributeCost::place_price(const OneRing& ring, const Place& place) const
{
    double sum = 0.0;
    for (const Layer& layer : layers_)
    {
        double square = 0.0;
        for (std::size_t k = 0; k < layer.components; ++k)
        {
            auto off = static_cast<double>(layer.at(place.wedge)[k]);
            for (std::size_t c = 0; c < 3; ++c)
            {
                off -= place.share[c] * static_cast<double>(layer.at(place.corners[c])[k]);
            }
            square += off * off;
        }
        sum += square * square_length(layer, ring, place);
    }
    return weight_ * sum * place.area / 3.0;
}

double AttributeCost::price(const OneRing& ring, std::span<const Vector3> offset, std::size_t kept)
    const
{
    double price = 0.0;
    std::uint32_t last = 0xFFFFFFFF;
    std::uint32_t before_last = 0xFFFFFFFF;
    for (std::size_t i = 0; i < ring.face_count; ++i)
    {
        // A vertex that may go has one wedge or two.
        const std::uint32_t wedge = mesh_.wedge(ring.corner[i]);
        if (wedge == last || wedge == before_last)
        {
            continue;
        }
        before_last = last;
        last = wedge;
        const Place place = find_place(ring, offset, kept, wedge);
        price += place_price(ring, place);
    }
    return price;
}

}  // namespace vsplit::precompute
