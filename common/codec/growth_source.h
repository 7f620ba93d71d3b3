#pragma once

#include "codec/grown_mesh.h"
#include "core/result.h"
#include "mesh/indexed_mesh.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::codec {

/// What the encoder wants beyond an edge.
struct GrowthChoice
{
    GrowthStep step = GrowthStep::NewVertex;
    std::int32_t place = -1;  ///< For Touch: the border's edge that begins at the third vertex.
};

/// The complete mesh that an encoder grows again: which source face and vertex each grown one is.
/// Encoder only; decoders pass none. Not thread safe.
class GrowthSource
{
public:
    static constexpr std::uint32_t kNone = 0xFFFFFFFF;

    /// Links the faces of a mesh. `mesh`: 2-manifold with boundary, consistently oriented; `coarse`: by
    /// vertex its number in the coarse mesh, or kNone. Both must outlive this.
    GrowthSource(const GridMesh& mesh, std::span<const std::uint32_t> coarse);

    /// Forgets what was grown, so that the mesh can be grown once more.
    void restart();

    /// Vertices of the complete mesh.
    [[nodiscard]] std::uint32_t vertex_count() const
    {
        return static_cast<std::uint32_t>(mesh_.positions.size());
    }

    /// Faces of the complete mesh.
    [[nodiscard]] std::uint32_t face_count() const
    {
        return static_cast<std::uint32_t>(mesh_.triangles.size());
    }

    /// Takes the next component's first face for the seed just added. Error: Internal when there is
    /// none or it has no coarse vertex.
    [[nodiscard]] Result<void> take_seed();

    /// Finds how the mesh goes on beyond a gate. Error: Internal (not a manifold).
    [[nodiscard]] Result<GrowthChoice> choose(const GrownMesh& mesh, const BorderGate& gate) const;

    /// Takes the source face beyond a grown corner for the face just grown there.
    void take_face(Corner gate);

    /// The source vertex of a grown vertex.
    [[nodiscard]] std::uint32_t vertex(std::uint32_t grown) const { return vertex_of_[grown]; }

    /// Number of a grown vertex in the coarse mesh, or kNone.
    [[nodiscard]] std::uint32_t coarse(std::uint32_t grown) const
    {
        return coarse_[vertex_of_[grown]];
    }

    /// Position of a grown vertex on the full grid.
    [[nodiscard]] const std::array<std::int32_t, 3>& position(std::uint32_t grown) const
    {
        return mesh_.positions[vertex_of_[grown]];
    }

private:
    [[nodiscard]] std::uint32_t vertex_at(Corner corner) const
    {
        return mesh_
            .triangles[static_cast<std::size_t>(corner >> 2)][static_cast<std::size_t>(corner & 3)];
    }

    [[nodiscard]] Corner opposite(Corner corner) const
    {
        return opposite_[static_cast<std::size_t>(corner)];
    }

    [[nodiscard]] bool is_done(Corner corner) const
    {
        return grown_[static_cast<std::size_t>(corner >> 2)] >= 0;
    }

    [[nodiscard]] Corner to_source(Corner grown) const;
    [[nodiscard]] Corner to_grown(Corner source) const;
    [[nodiscard]] std::int32_t find_place(const GrownMesh& mesh, Corner across) const;
    void take(Corner first);

    const GridMesh& mesh_;
    std::span<const std::uint32_t> coarse_;
    std::vector<Corner> opposite_;          ///< By source corner.
    std::vector<Corner> first_;             ///< By grown face the source corner of its corner 0.
    std::vector<std::int32_t> grown_;       ///< By source face its grown face, or -1.
    std::vector<std::uint32_t> vertex_of_;  ///< By grown vertex.
    std::vector<std::uint8_t> known_;       ///< By source vertex: has it been grown?
    std::size_t next_seed_ = 0;
};

}  // namespace vsplit::codec
