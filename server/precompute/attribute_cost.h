#pragma once

#include "codec/level_attributes.h"
#include "precompute/collapse_mesh.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::precompute {

/// What lies on a mesh, for AttributeCost: numbers by wedge of the mesh.
struct WedgeValues
{
    std::span<const codec::AttributeInfo> attributes;
    std::span<const std::vector<std::int32_t>> values;  ///< By attribute and wedge, coded.
};

/// Prices what a collapse does to texture coordinates and colours. Immutable, but for the mesh.
class AttributeCost
{
public:
    /// `mesh`: with wedges, in its complete state; must outlive this. `positions`: V points, grid units.
    /// `weight`: of an error of texture and colour beside one of the shape; at 0 there is no price.
    AttributeCost(
        const CollapseMesh& mesh,
        std::span<const Vector3> positions,
        const WedgeValues& values,
        double weight
    );

    /// True when nothing has a price.
    [[nodiscard]] bool empty() const { return layers_.empty(); }

    /// Squared error times area, grid units: how far values at the ring's centre are from those that the
    /// new triangles have there, as a distance on the surface. `offset`: by neighbour its place, relative
    /// to the centre's. Precondition: CollapseMesh::keeps_seams().
    [[nodiscard]] double price(
        const OneRing& ring, std::span<const Vector3> offset, std::size_t kept
    ) const;

private:
    /// Values of one attribute.
    struct Layer
    {
        std::size_t components = 0;
        bool is_texture = false;
        double length = 1.0;        ///< Grid units that a difference of 1 counts for.
        std::vector<float> values;  ///< By wedge.

        [[nodiscard]] const float* at(std::uint32_t wedge) const
        {
            return values.data() + components * wedge;
        }
    };

    /// Where the centre lies among the new triangles of one of its wedges.
    struct Place
    {
        std::uint32_t wedge = 0;
        std::array<std::uint32_t, 3> corners{};  ///< Wedges at the corners of the triangle.
        std::array<double, 3> share{};           ///< Of each corner.
        double area = 0.0;                       ///< Of the wedge's faces before.
    };

    void add_layer(
        const codec::AttributeInfo& info,
        std::span<const std::int32_t> coded,
        std::span<const Vector3> positions
    );
    [[nodiscard]] Place find_place(
        const OneRing& ring, std::span<const Vector3> offset, std::size_t kept, std::uint32_t wedge
    ) const;
    [[nodiscard]] double square_length(const Layer& layer, const OneRing& ring, const Place& place)
        const;
    [[nodiscard]] double place_price(const OneRing& ring, const Place& place) const;

    const CollapseMesh& mesh_;
    double weight_;  ///< Of squares.
    std::vector<Layer> layers_;
};

}  // namespace vsplit::precompute
