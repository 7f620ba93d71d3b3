#pragma once

#include "codec/refinement_mesh.h"
#include "codec/vector3.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
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
    static constexpr float kFar = std::numeric_limits<float>::infinity();

public:
    /// Looks at a mesh whose positions lack `shift` bits of precision.
    CoarseSurface(const RefinementMesh& mesh, int shift, const GrownPositions& positions)
        : mesh_(&mesh),
          positions_(&positions),
          centre_{static_cast<float>((1 << shift) - 1) * 0.5F, 0.0F},
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

    /// A coarse vertex and its squared distance from the place asked; infinite when it was met.
    struct Candidate
    {
        std::uint32_t vertex = 0;
        float square = kFar;
    };

    /// The vertices of a face and of its neighbours, which a place may be. Written without branches: whether
    /// a vertex was met cannot be guessed.
    struct Candidates
    {
        std::array<Candidate, 6> list{};

        /// The least squared distance and the next one.
        [[nodiscard]] std::array<float, 2> nearest() const
        {
            float first = kFar;
            float second = kFar;
            for (const Candidate& candidate : list)
            {
                const float larger = first > candidate.square ? first : candidate.square;
                second = second < larger ? second : larger;
                first = first < candidate.square ? first : candidate.square;
            }
            return {first, second};
        }

        /// Puts the nearest first, equal ones as they are. Returns those that were not met.
        [[nodiscard]] std::span<const Candidate> sort()
        {
            for (std::size_t end = 1; end < list.size(); ++end)
            {
                for (std::size_t i = end; i > 0 && list[i - 1].square > list[i].square; --i)
                {
                    std::swap(list[i - 1], list[i]);
                }
            }
            const auto first_met = std::ranges::find(list, kFar, &Candidate::square);
            return {list.begin(), first_met};
        }
    };

    /// A face with its corners and twice its vector area.
    struct Ground
    {
        std::int32_t face = -1;
        std::array<Vector3, 3> corner{};
        Vector3 area{};
    };

    /// Walks from a face to the one that a point lies above, a few steps at most. The result is valid until
    /// the next call or meet().
    [[nodiscard]] const Ground& walk(std::int32_t face, const Vector3& point)
    {
        constexpr int kMostSteps = 12;
        // Most vertices lie above the face of the one before.
        if (face != ground_.face)
        {
            ground_ = ground_of(face);
        }
        for (int i = 0; i < kMostSteps; ++i)
        {
            const Corner beyond = leaves_across(ground_, point);
            if (beyond < 0)
            {
                break;
            }
            ground_ = ground_of(face_of(beyond));
        }
        return ground_;
    }

    /// Finds the vertices of a face and of its neighbours that have not been met.
    [[nodiscard]] Candidates candidates(const Ground& ground, const Vector3& place) const
    {
        Candidates found;
        const Face& here = mesh_->faces()[ground.face];
        for (std::size_t k = 0; k < 3; ++k)
        {
            found.list[k] = candidate(here.vertex[k], place);
        }
        for (std::size_t k = 0; k < 3; ++k)
        {
            const Corner beyond = here.opposite[k];
            // Where there is no face the vertex itself, which then is there twice.
            const Corner there = beyond < 0 ? ground.face * 4 + static_cast<Corner>(k) : beyond;
            found.list[3 + k] = candidate(mesh_->vertex(there), place);
        }
        for (std::size_t i = 3; i < 6; ++i)
        {
            bool again = false;
            for (std::size_t j = 0; j < i; ++j)
            {
                again |= found.list[j].vertex == found.list[i].vertex;
            }
            found.list[i].square = again ? kFar : found.list[i].square;
        }
        return found;
    }

    /// Position of a vertex on the full grid: the centre of the cell that is known.
    [[nodiscard]] Vector3 point(std::uint32_t vertex) const
    {
        return from_cell(vertex, centre_[met_[vertex]]);
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
        ground_.face = -1;  // the vertex is elsewhere now
    }

    /// Vertices met so far.
    [[nodiscard]] std::uint32_t met_count() const { return met_count_; }

    /// Vertices of the coarse mesh.
    [[nodiscard]] std::uint32_t vertex_count() const { return mesh_->vertex_count(); }

private:
    [[nodiscard]] Vector3 from_cell(std::uint32_t vertex, float offset) const
    {
        const auto& [x, y, z] = (*positions_)[vertex];
        return {
            static_cast<float>(x) + offset,
            static_cast<float>(y) + offset,
            static_cast<float>(z) + offset,
        };
    }

    [[nodiscard]] Ground ground_of(std::int32_t face) const
    {
        Ground ground{.face = face};
        for (std::size_t k = 0; k < 3; ++k)
        {
            ground.corner[k] = point(mesh_->faces()[face].vertex[k]);
        }
        ground.area =
            cross(ground.corner[1] - ground.corner[0], ground.corner[2] - ground.corner[0]);
        return ground;
    }

    /// The corner beyond the edge across which a point lies farthest outside; -1 when inside or at a
    /// boundary.
    [[nodiscard]] Corner leaves_across(const Ground& ground, const Vector3& point) const
    {
        float worst = 0.0F;
        Corner beyond = -1;
        for (std::size_t k = 0; k < 3; ++k)
        {
            const Vector3& from = ground.corner[(k + 1) % 3];
            const Vector3 edge = ground.corner[(k + 2) % 3] - from;
            const float side = dot(cross(edge, point - from), ground.area);
            if (side < 0.0F)
            {
                const float outside = side * side / (dot(edge, edge) + 1.0F);
                if (outside > worst)
                {
                    worst = outside;
                    beyond = mesh_->faces()[ground.face].opposite[k];
                }
            }
        }
        return beyond;
    }

    [[nodiscard]] Candidate candidate(std::uint32_t vertex, const Vector3& place) const
    {
        const Vector3 off = from_cell(vertex, centre_[0]) - place;
        constexpr std::array<float, 2> kMetBefore{0.0F, kFar};
        return {vertex, dot(off, off) + kMetBefore[met_[vertex]]};
    }

    const RefinementMesh* mesh_;
    const GrownPositions* positions_;
    std::array<float, 2> centre_;  ///< Of a cell; 0 for a vertex that was met.
    std::vector<std::uint8_t> met_;
    std::vector<std::int32_t> face_of_;
    std::uint32_t met_count_ = 0;
    Ground ground_;  ///< Where the last walk ended.
};

}  // namespace vsplit::codec
