#pragma once

// The last level of a stream may be coded by growing the complete mesh over the coarse one instead of
// by splits: a traversal keeps the regularity of scanned, subdivided or designed meshes, which an
// adaptive hierarchy breaks up. The coarse mesh is used twice: its vertices are recognised, not sent
// again, and its surface tells where the others lie. Encoder and decoder run this same code.

#include "codec/batch_coder.h"
#include "codec/coarse_surface.h"
#include "codec/face_grower.h"
#include "codec/grown_mesh.h"
#include "codec/growth_model.h"
#include "codec/vertex_placer.h"
#include "core/result.h"

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace vsplit::codec {

/// How much of the growth a chunk holds.
struct GrowthShare
{
    std::uint32_t faces = 0;     ///< Faces to grow.
    std::uint32_t vertices = 0;  ///< Vertices to place; only once all faces are there.
};

/// The growth of the complete mesh over the coarse mesh of a BatchState, chunk by chunk.
class Growth
{
public:
    /// Bits of the fields of PredictionShares.
    static constexpr int kSurfaceShareBits = 3;
    static constexpr int kCurvedShareBits = 4;
    static constexpr int kMostCurvedShare = 8;

    /// Prepares for a mesh of known size. The coarse mesh must not change after the first chunk.
    Growth(std::uint32_t vertices, std::uint32_t faces) : vertices_(vertices), faces_(faces) {}

    /// Takes the memory for the complete mesh; run() takes what is left to take.
    void reserve()
    {
        mesh_.reserve(vertices_, faces_);
        positions_.reserve(vertices_);
    }

    /// Codes one chunk. `share`, `predicted`, `source`: encoder only, what the chunk is to hold, what
    /// positions are predicted from, what to code.
    /// Error: BadChunk. Safe on untrusted input.
    template <typename Coder>
    [[nodiscard]] Result<void> run(
        Coder& coder,
        BatchState& state,
        GrowthShare share,
        const PredictionShares& predicted,
        GrowthSource* source
    )
    {
        if (!surface_)
        {
            VSPLIT_TRY(begin(coder, state, predicted));
        }
        return extend(coder, state, code_share(coder, share), source);
    }

    /// Codes what stands at the beginning of the first chunk. Arguments and errors as for run().
    template <typename Coder>
    [[nodiscard]] Result<void> begin(
        Coder& coder, BatchState& state, const PredictionShares& predicted
    )
    {
        const auto code = [&](int value, int bits) {
            return static_cast<int>(coder.raw(static_cast<std::uint32_t>(value), bits));
        };
        predicted_.surface = code(predicted.surface, kSurfaceShareBits);
        predicted_.curved = code(predicted.curved, kCurvedShareBits);
        if (predicted_.curved > kMostCurvedShare)
        {
            return fail(ErrorCode::BadChunk, "predictions bend further than they may");
        }
        start(state);
        return {};
    }

    /// Codes what stands at the beginning of every chunk. `share`: encoder only; returned.
    template <typename Coder>
    [[nodiscard]] static GrowthShare code_share(Coder& coder, const GrowthShare& share)
    {
        GrowthShare coded;
        coded.faces = code_count(coder, share.faces);
        coded.vertices = code_count(coder, share.vertices);
        return coded;
    }

    /// Codes faces and vertices. Arguments and errors as for run().
    template <typename Coder>
    [[nodiscard]] Result<void> extend(
        Coder& coder, const BatchState& state, const GrowthShare& share, GrowthSource* source
    )
    {
        if (share.faces > faces_ - mesh_.face_count())
        {
            return fail(ErrorCode::BadChunk, "a chunk grows more faces than there are");
        }
        VSPLIT_TRY(grower_.run(coder, mesh_, model_, mesh_.face_count() + share.faces, source));
        if (share.faces > 0 && mesh_.face_count() == faces_)
        {
            VSPLIT_TRY(finish_faces(state));
        }
        if (share.vertices > 0 && mesh_.face_count() < faces_)
        {
            return fail(ErrorCode::BadChunk, "a chunk places vertices before all faces are there");
        }
        return placer_.run(coder, mesh_, *surface_, positions_, model_, share.vertices, source);
    }

    /// True once every vertex is placed and every coarse vertex was met.
    [[nodiscard]] bool complete() const
    {
        return surface_ && placer_.placed() == vertices_ &&
               surface_->met_count() == surface_->vertex_count();
    }

    /// Gives the faces their final vertex numbers and frees what only the growth needs; the coarse mesh
    /// is not used any more. Precondition: complete().
    /// Error: BadChunk when the mesh is not a manifold. Safe on untrusted input.
    [[nodiscard]] Result<void> finish()
    {
        if (!placer_.saw_manifold(mesh_))
        {
            return fail(ErrorCode::BadChunk, "the complete mesh is not a manifold");
        }
        for (GrownFace& face : mesh_.faces())
        {
            for (std::uint32_t& vertex : face.vertex)
            {
                vertex = placer_.numbers()[vertex];
            }
        }
        placer_ = VertexPlacer();
        surface_.reset();
        finished_ = true;
        return {};
    }

    /// True after finish(): faces() and positions() are the complete mesh.
    [[nodiscard]] bool finished() const { return finished_; }

    /// Faces in the order in which they were grown.
    [[nodiscard]] const std::vector<GrownFace>& faces() const { return mesh_.faces(); }

    /// Positions by final number.
    [[nodiscard]] const GrownPositions& positions() const { return positions_; }

    /// Final numbers by grown vertex, before finish().
    [[nodiscard]] const std::vector<std::uint32_t>& numbers() const { return placer_.numbers(); }

private:
    void start(BatchState& state)
    {
        state.mesh.start_batch();  // sorts the faces of the last one in
        surface_.emplace(state.mesh, state.shift, positions_);
        shift_ = state.shift;
        reserve();
        for (std::uint32_t v = 0; v < state.mesh.vertex_count(); ++v)
        {
            const Point& point = state.mesh.points()[v];
            positions_.push_back(
                {static_cast<std::int32_t>(point.x) << shift_,
                 static_cast<std::int32_t>(point.y) << shift_,
                 static_cast<std::int32_t>(point.z) << shift_}
            );
        }
        grower_.start(vertices_);
    }

    Result<void> finish_faces(const BatchState& state)
    {
        if (mesh_.vertex_count() != vertices_)
        {
            return fail(ErrorCode::BadChunk, "a chunk grows fewer vertices than there are");
        }
        mesh_.finish();
        grower_.finish();
        placer_.start(mesh_, (1 << state.bits) - 1, shift_, predicted_);
        return {};
    }

    std::uint32_t vertices_;
    std::uint32_t faces_;
    int shift_ = 0;
    PredictionShares predicted_;
    bool finished_ = false;
    GrownMesh mesh_;
    FaceGrower grower_;
    VertexPlacer placer_;
    GrowthModel model_;
    GrownPositions positions_;
    std::optional<CoarseSurface> surface_;
};

}  // namespace vsplit::codec
