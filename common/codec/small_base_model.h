#pragma once

#include "codec/context_model.h"
#include "mesh/indexed_mesh.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_map>

namespace vsplit::codec {

/// The mesh that an encoder codes; shared by attempts to code it from different faces.
class SmallBaseSource
{
public:
    /// `mesh`: a 2-manifold with boundary, which must outlive this.
    explicit SmallBaseSource(const GridMesh& mesh) : mesh_(mesh)
    {
        for (const Triangle& triangle : mesh.triangles)
        {
            for (std::size_t k = 0; k < 3; ++k)
            {
                across_[key(triangle[k], triangle[(k + 1) % 3])] = triangle[(k + 2) % 3];
            }
        }
    }

    /// The vertex that makes a triangle with a directed edge, if there is one.
    [[nodiscard]] std::optional<std::uint32_t> apex(std::uint32_t from, std::uint32_t to) const
    {
        const auto found = across_.find(key(from, to));
        return found == across_.end() ? std::nullopt : std::optional(found->second);
    }

    /// The mesh itself.
    [[nodiscard]] const GridMesh& mesh() const { return mesh_; }

    /// One number for a directed edge.
    [[nodiscard]] static std::uint64_t key(std::uint32_t from, std::uint32_t to)
    {
        return std::uint64_t{from} << 32 | to;
    }

private:
    const GridMesh& mesh_;
    std::unordered_map<std::uint64_t, std::uint32_t> across_;
};

/// Builds the model of an integer whose magnitude is likely a quarter of `range`.
[[nodiscard]] inline IntegerModel make_coordinate_model(std::int32_t range)
{
    constexpr std::uint16_t kCount = 8;
    const int exponent = static_cast<int>(std::bit_width(static_cast<std::uint32_t>(range))) - 2;
    IntegerModel model;
    model.nonzero = {60000, kCount};
    for (AdaptiveBit& sign : model.sign)
    {
        sign.count = kCount;
    }
    model.sign[0].probability = 20000;
    model.sign[2].probability = 45536;
    for (int e = 0; e < 24; ++e)
    {
        const int probability = e < exponent - 1 ? 48000 : e < exponent + 1 ? 32768 : 8000;
        model.prefix[static_cast<std::size_t>(e)] = {
            static_cast<std::uint16_t>(probability), kCount};
    }
    for (auto& mantissa : model.mantissa)
    {
        mantissa.fill({32768, 24});
    }
    return model;
}

}  // namespace vsplit::codec
