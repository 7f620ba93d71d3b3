#pragma once

#include "codec/refinement_mesh.h"
#include "codec/vector3.h"

#include <array>
#include <cstdint>
#include <vector>

namespace vsplit::codec {

/// Positions on the full grid by final number: coarse vertices keep theirs, the others follow in the
/// order in which they are placed.
using GrownPositions = std::vector<std::array<std::int32_t, 3>>;

/// The coarse mesh as the known surface on which finer vertices are expected: where a point lies on it,
/// and which of its vertices have not been met yet. Refers to the mesh, which must outlive it. All
/// floats in a fixed order, as in vector3.h.
class CoarseSurface
{
public:
    /// Looks at a mesh whose positions lack `shift` bits of precision.
    CoarseSurface(const RefinementMesh& mesh, int shift, const GrownPositions& positions)
        : mesh_(&mesh),
          positions_(&positions),
          centre_(static_cast<float>((1 << shift) - 1) * 0.5F),
          met_(mesh.vertex_count(), 0)
    {
        face_of_.assign(mesh.vertex_count(), 0);
        for (std::uint32_t f = 0; f < mesh.face_count(); ++f)
        {
            for (const std::uint32_t v : mesh.faces()[f].vertex)
            {
                face_of_[v] = static_cast<std::int32_t>(f);
            }
        }
    }

    /// A coarse vertex that has not been met, and its squared distance from the place asked.
    struct Candidate
    {
        std::uint32_t vertex = 0;
        float square = 0.0F;
    };

    /// The candidates near a place, nearest first.
    struct Candidates
    {
        static constexpr std::size_t kMost = 6;
        std::array<Candidate, kMost> list{};
        std::size_t size = 0;
    };

    /// Walks from a face to the one that a point lies above, a few steps at most. Returns a face.
    [[nodiscard]] std::int32_t walk(std::int32_t face, const Vector3& point) const
    {
        constexpr int kMostSteps = 12;
        for (int i = 0; i < kMostSteps; ++i)
        {
            const Corner beyond = leaves_across(face, point);
            if (beyond < 0)
            {
                break;
            }
            face = face_of(beyond);
        }
        return face;
    }

    /// Finds the vertices of a face and of its neighbours that have not been met.
    [[nodiscard]] Candidates candidates(std::int32_t face, const Vector3& point) const
    {
        Candidates found;
        const Face& here = mesh_->faces()[face];
        for (const std::uint32_t v : here.vertex)
        {
            add(found, v, point);
        }
        for (const Corner beyond : here.opposite)
        {
            if (beyond >= 0)
            {
                add(found, mesh_->vertex(beyond), point);
            }
        }
        return found;
    }

    /// Twice the vector area of a face.
    [[nodiscard]] Vector3 area(std::int32_t face) const
    {
        const Vector3 origin = corner_point(face, 0);
        return cross(corner_point(face, 1) - origin, corner_point(face, 2) - origin);
    }

    /// Position of a face's k-th vertex.
    [[nodiscard]] Vector3 corner_point(std::int32_t face, std::size_t k) const
    {
        return point(mesh_->faces()[face].vertex[k]);
    }

    /// Position of a vertex on the full grid: the centre of the cell that is known.
    [[nodiscard]] Vector3 point(std::uint32_t vertex) const
    {
        const auto& [x, y, z] = (*positions_)[vertex];
        const float centre = is_met(vertex) ? 0.0F : centre_;
        return {
            static_cast<float>(x) + centre,
            static_cast<float>(y) + centre,
            static_cast<float>(z) + centre,
        };
    }

    /// A face at a vertex.
    [[nodiscard]] std::int32_t face_at(std::uint32_t vertex) const { return face_of_[vertex]; }

    /// True once meet() was called for a vertex.
    [[nodiscard]] bool is_met(std::uint32_t vertex) const { return met_[vertex] != 0; }

    /// Takes a vertex out of the candidates.
    void meet(std::uint32_t vertex)
    {
        met_[vertex] = 1;
        ++met_count_;
    }

    /// Vertices met so far.
    [[nodiscard]] std::uint32_t met_count() const { return met_count_; }

    /// Vertices of the coarse mesh.
    [[nodiscard]] std::uint32_t vertex_count() const { return mesh_->vertex_count(); }

private:
    /// The corner beyond the edge across which a point lies farthest outside; -1 when inside or at a
    /// boundary.
    [[nodiscard]] Corner leaves_across(std::int32_t face, const Vector3& point) const
    {
        const Face& here = mesh_->faces()[face];
        const Vector3 normal = area(face);
        float worst = 0.0F;
        Corner beyond = -1;
        for (std::size_t k = 0; k < 3; ++k)
        {
            const Vector3 from = corner_point(face, (k + 1) % 3);
            const Vector3 edge = corner_point(face, (k + 2) % 3) - from;
            const float side = dot(cross(edge, point - from), normal);
            if (side < 0.0F)
            {
                const float outside = side * side / (dot(edge, edge) + 1.0F);
                if (outside > worst)
                {
                    worst = outside;
                    beyond = here.opposite[k];
                }
            }
        }
        return beyond;
    }

    void add(Candidates& found, std::uint32_t vertex, const Vector3& place) const
    {
        if (is_met(vertex))
        {
            return;
        }
        const Vector3 off = point(vertex) - place;
        const float square = dot(off, off);
        std::size_t i = found.size;
        for (std::size_t j = 0; j < found.size; ++j)
        {
            if (found.list[j].vertex == vertex)
            {
                return;
            }
        }
        for (; i > 0 && found.list[i - 1].square > square; --i)
        {
            found.list[i] = found.list[i - 1];
        }
        found.list[i] = {vertex, square};
        ++found.size;
    }

    const RefinementMesh* mesh_;
    const GrownPositions* positions_;
    float centre_;
    std::vector<std::uint8_t> met_;
    std::vector<std::int32_t> face_of_;
    std::uint32_t met_count_ = 0;
};

}  // namespace vsplit::codec
