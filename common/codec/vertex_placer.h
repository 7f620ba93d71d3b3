#pragma once

// New here: the surface and the vertices of a coarse mesh are known. Its vertices are recognised near
// where a vertex is expected, the others are coded against the traversal's prediction and its surface.

#include "codec/choose.h"
#include "codec/coarse_surface.h"
#include "codec/grown_mesh.h"
#include "codec/growth_model.h"
#include "codec/growth_source.h"
#include "codec/vertex_front.h"
#include "codec/vertex_guess.h"
#include "codec/vertex_residual.h"
#include "core/result.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

namespace vsplit::codec {

/// What positions are predicted from, eighths.
struct PredictionShares
{
    int surface = 0;  ///< How far the coarse surface counts against the parallelograms, 0 .. 7.
    int curved = 0;   ///< How far these bend, 0 .. 8.
};

/// Codes which vertices of the grown mesh are coarse ones, and the positions of the others, as many at
/// a time as a chunk holds. One object serves the whole stage.
class VertexPlacer
{
public:
    /// Prepares for a grown mesh whose faces are all there. `max_index`: largest coordinate; `shift`:
    /// bits of precision that the coarse mesh lacks; `shares`: what predictions are made of.
    void start(
        const GrownMesh& mesh, std::int32_t max_index, int shift, const PredictionShares& shares
    )
    {
        max_index_ = max_index;
        shift_ = shift;
        shares_ = shares;
        front_.start(mesh);
        hint_.assign(mesh.vertex_count(), 0);
        sizes_.assign(mesh.vertex_count(), {});
    }

    /// Places `count` more vertices. `positions`: those of the coarse mesh to begin with, all in the
    /// end; `source`: what to code, encoder only.
    /// Error: BadChunk (off the grid, a coarse vertex twice, no vertex left). Safe on untrusted input.
    template <typename Coder>
    [[nodiscard]] Result<void> run(
        Coder& coder,
        const GrownMesh& mesh,
        CoarseSurface& surface,
        GrownPositions& positions,
        GrowthModel& model,
        std::uint32_t count,
        const GrowthSource* source
    )
    {
        for (std::uint32_t i = 0; i < count; ++i)
        {
            const Corner corner = front_.take(mesh);
            if (corner < 0)
            {
                return fail(ErrorCode::BadChunk, "a chunk places more vertices than there are");
            }
            const auto number = code_vertex(coder, mesh, surface, positions, model, corner, source);
            VSPLIT_TRY(number);
            if (!front_.place(mesh, *number))
            {
                return fail(ErrorCode::BadChunk, "too many vertices wait to be placed");
            }
        }
        return {};
    }

    /// Says whether a mesh whose vertices are all placed is a manifold.
    [[nodiscard]] bool saw_manifold(const GrownMesh& mesh) const
    {
        return front_.saw_manifold(mesh);
    }

    /// Final numbers by grown vertex.
    [[nodiscard]] const std::vector<std::uint32_t>& numbers() const { return front_.numbers(); }

    /// Vertices placed so far.
    [[nodiscard]] std::uint32_t placed() const { return front_.placed(); }

private:
    /// What the encoder wants of a vertex.
    struct Wanted
    {
        std::uint32_t coarse = kUnknownVertex;  ///< Its number in the coarse mesh, if it has one.
        std::array<std::int32_t, 3> position{};
    };

    /// Codes one vertex; its position is in place afterwards. Result: its final number.
    template <typename Coder>
    Result<std::uint32_t> code_vertex(
        Coder& coder,
        const GrownMesh& mesh,
        CoarseSurface& surface,
        GrownPositions& positions,
        GrowthModel& model,
        Corner corner,
        [[maybe_unused]] const GrowthSource* source
    )
    {
        const std::uint32_t vertex = mesh.vertex(corner);
        Wanted wanted;
        if constexpr (Coder::kEncodes)
        {
            wanted = {source->coarse(vertex), source->position(vertex)};
        }
        const auto ring = front_.look_around(mesh, corner);
        Surroundings seen;
        Gathering(mesh, front_, positions, sizes_, seen).run(ring, shares_.curved > 0);
        if (seen.known == 0)
        {
            // The first vertex of a component is a coarse one.
            const auto number = code_number(coder, surface, wanted.coarse);
            VSPLIT_TRY(number);
            const Vector3 expected = surface.point(*number);
            return meet(coder, surface, positions, model, vertex, *number, expected, wanted);
        }
        const Vector3 expected = seen.average(static_cast<float>(shares_.curved) * 0.125F);
        const auto& ground = surface.walk(hint_[seen.some], expected);
        hint_[vertex] = ground.face;
        auto near = surface.candidates(ground, expected);
        const bool coarse = wanted.coarse != kUnknownVertex;
        if (!code_is_coarse(coder, model, near, seen, expected, coarse))
        {
            return code_new(coder, ground, positions, model, vertex, seen, expected, wanted);
        }
        sizes_[vertex] = {
            static_cast<std::uint8_t>(seen.tangential), static_cast<std::uint8_t>(seen.normal)};
        const auto number = code_which(coder, model, surface, near, wanted.coarse);
        VSPLIT_TRY(number);
        return meet(coder, surface, positions, model, vertex, *number, expected, wanted);
    }

    /// Codes a vertex that is not in the coarse mesh.
    template <typename Coder>
    Result<std::uint32_t> code_new(
        Coder& coder,
        const CoarseSurface::Ground& ground,
        GrownPositions& positions,
        GrowthModel& model,
        std::uint32_t vertex,
        const Surroundings& seen,
        Vector3 expected,
        const Wanted& wanted
    )
    {
        const GuessKind kind = code_guess(coder, model, seen, expected, wanted.position);
        const auto position = code_residual(
            coder,
            model,
            ground,
            static_cast<float>(shares_.surface) * 0.125F,
            seen,
            kind,
            expected,
            wanted.position,
            sizes_[vertex]
        );
        VSPLIT_TRY(check(position));
        if (positions.size() >= hint_.size())
        {
            return fail(ErrorCode::BadChunk, "a chunk places more new vertices than there are");
        }
        positions.push_back(position);
        return static_cast<std::uint32_t>(positions.size() - 1);
    }

    Result<void> check(const std::array<std::int32_t, 3>& position) const
    {
        const bool inside = std::ranges::all_of(position, [this](std::int32_t coordinate) {
            return coordinate >= 0 && coordinate <= max_index_;
        });
        return inside ? Result<void>{}
                      : fail(ErrorCode::BadChunk, "a vertex lies outside the grid");
    }

    /// Recognises a coarse vertex and completes its position.
    template <typename Coder>
    Result<std::uint32_t> meet(
        Coder& coder,
        CoarseSurface& surface,
        GrownPositions& positions,
        GrowthModel& model,
        std::uint32_t vertex,
        std::uint32_t number,
        const Vector3& expected,
        const Wanted& wanted
    )
    {
        code_coarse_position(coder, model, shift_, expected, wanted.position, positions[number]);
        VSPLIT_TRY(check(positions[number]));
        surface.meet(number);
        hint_[vertex] = surface.face_at(number);
        return number;
    }

    /// Codes the number of any coarse vertex that has not been met.
    template <typename Coder>
    static Result<std::uint32_t> code_number(
        Coder& coder, const CoarseSurface& surface, std::uint32_t wanted
    )
    {
        const int bits = static_cast<int>(std::bit_width(surface.vertex_count() - 1));
        const std::uint32_t number = coder.raw(wanted, bits);
        if (number >= surface.vertex_count() || surface.is_met(number))
        {
            return fail(ErrorCode::BadChunk, "a coarse vertex is met twice");
        }
        return number;
    }

    /// Codes whether a vertex is a coarse one, by how near those are that it could be.
    template <typename Coder>
    static bool code_is_coarse(
        Coder& coder,
        GrowthModel& model,
        const CoarseSurface::Candidates& near,
        const Surroundings& seen,
        const Vector3& expected,
        bool wanted
    )
    {
        constexpr std::int32_t kRate = 6000;
        const Vector3 off = seen.some_position - expected;
        const float reach = dot(off, off) + 1.0F;
        const auto distance = [reach](float square) {
            const std::int32_t steps = steps_log2<1>((square + 0.25F) / reach) + 22;
            const bool is_far = square == std::numeric_limits<float>::infinity();
            return static_cast<std::size_t>(choose(is_far, 31, clamp_int(steps, 0, 30)));
        };
        const auto [first, second] = near.nearest();
        const std::size_t nearest = distance(first);
        const std::size_t size = std::min<std::size_t>(seen.tangential, 15);
        return code_logistic<Coder, 3>(
            coder,
            {&model.coarse_nearest[nearest],
             &model.coarse_residual[nearest * 16 + size],
             &model.coarse_second[nearest * 32 + distance(second)]},
            wanted,
            kRate
        );
    }

    /// Codes which coarse vertex it is: one of those near by, or any.
    template <typename Coder>
    static Result<std::uint32_t> code_which(
        Coder& coder,
        GrowthModel& model,
        const CoarseSurface& surface,
        CoarseSurface::Candidates& near,
        std::uint32_t wanted
    )
    {
        const auto sorted = near.sort();
        for (std::size_t i = 0; i < sorted.size(); ++i)
        {
            if (code_bit(coder, model.candidate[i], sorted[i].vertex == wanted))
            {
                return sorted[i].vertex;
            }
        }
        return code_number(coder, surface, wanted);
    }

    VertexFront front_;
    std::vector<std::int32_t> hint_;    ///< By grown vertex a coarse face near it.
    std::vector<ResidualSizes> sizes_;  ///< By grown vertex.
    std::int32_t max_index_ = 0;
    int shift_ = 0;
    PredictionShares shares_;
};

}  // namespace vsplit::codec
