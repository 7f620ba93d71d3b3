#include "precompute/wedge_mesh.h"

#include <algorithm>
#include <limits>

namespace vsplit::precompute {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// Finds wedges again: those of a vertex are a list.
class WedgeFinder
{
public:
    WedgeFinder(std::span<const SurfaceAttribute* const> attributes, std::size_t vertex_count)
        : attributes_(attributes), first_(vertex_count, kNone), wanted_(attributes.size())
    {
    }

    std::uint32_t find(
        std::uint32_t vertex, std::uint32_t face, std::size_t corner, WedgeMesh& mesh
    )
    {
        for (std::size_t i = 0; i < attributes_.size(); ++i)
        {
            wanted_[i] = attributes_[i]->corners[face][corner];
        }
        std::uint32_t last = kNone;
        for (std::uint32_t wedge = first_[vertex]; wedge != kNone; wedge = next_[wedge])
        {
            const auto begin =
                mesh.values.begin() + wedge * static_cast<std::ptrdiff_t>(wanted_.size());
            if (std::equal(wanted_.begin(), wanted_.end(), begin))
            {
                return wedge;
            }
            last = wedge;
        }
        const auto added = static_cast<std::uint32_t>(mesh.vertices.size());
        (last == kNone ? first_[vertex] : next_[last]) = added;
        next_.push_back(kNone);
        mesh.vertices.push_back(vertex);
        mesh.values.insert(mesh.values.end(), wanted_.begin(), wanted_.end());
        return added;
    }

private:
    std::span<const SurfaceAttribute* const> attributes_;
    std::vector<std::uint32_t> first_;  ///< By vertex its first wedge.
    std::vector<std::uint32_t> next_;   ///< By wedge the next one of its vertex.
    std::vector<std::uint32_t> wanted_;
};

}  // namespace

WedgeMesh split_wedges(
    std::span<const Triangle> triangles,
    std::span<const SurfaceAttribute* const> attributes,
    std::span<const std::uint32_t> faces,
    std::size_t vertex_count
)
{
    WedgeMesh mesh;
    WedgeFinder finder(attributes, vertex_count);
    mesh.triangles.reserve(faces.size());
    for (const std::uint32_t face : faces)
    {
        Triangle triangle{};
        for (std::size_t corner = 0; corner < 3; ++corner)
        {
            triangle[corner] = finder.find(triangles[face][corner], face, corner, mesh);
        }
        mesh.triangles.push_back(triangle);
    }
    return mesh;
}

}  // namespace vsplit::precompute
