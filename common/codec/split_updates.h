#pragma once

#include "codec/refinement_mesh.h"
#include "codec/triangle_updates.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace vsplit::codec {

/// Tells which triangles a chunk changed, from the mesh as it is after it. Not thread safe.
class SplitUpdates final : public UpdateSource
{
public:
    /// Tells of `mesh`, which must outlive this.
    explicit SplitUpdates(const RefinementMesh& mesh) : mesh_(mesh) {}

    /// From now on tells of every triangle.
    void show_all() { show_from(0); }

    /// From now on tells of the triangles from a place in the array of faces on. Precondition: 0, or
    /// nothing was split since they were put there.
    void show_from(std::uint32_t first)
    {
        shows_all_ = true;
        first_shown_ = first;
    }

    /// From now on tells of the wedges and new triangles of splits that are carried out next. They must
    /// stay, and the batch must not end, while it is read.
    void show(std::span<const Split> splits);

    /// As UpdateSource says.
    std::size_t read(Cursor& cursor, std::span<TriangleUpdate> out) const override;

private:
    std::size_t read_all(Cursor& cursor, std::span<TriangleUpdate> out) const;
    std::size_t read_split(Cursor& cursor, std::span<TriangleUpdate> out) const;

    const RefinementMesh& mesh_;
    bool shows_all_ = false;
    std::uint32_t first_shown_ = 0;
    std::span<const Split> splits_;
    std::uint32_t first_added_ = 0;  ///< The first new face is the one before.
};

}  // namespace vsplit::codec
