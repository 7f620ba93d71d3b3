#pragma once

// Based on: Gumhold, Strasser, "Real Time Compression of Triangle Mesh Connectivity", 1998; Touma,
// Gotsman, "Triangle Mesh Compression", 1998 (faces around one vertex after the other, so that what is
// coded amounts to valences). Contexts instead of static tables; depth first, which keeps the border
// short.

#include "codec/grown_mesh.h"
#include "codec/growth_model.h"
#include "codec/growth_source.h"
#include "core/result.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

namespace vsplit::codec {

/// Codes the faces of the complete mesh, as many at a time as a chunk holds. One object serves the whole
/// stage.
class FaceGrower
{
public:
    /// Prepares for a mesh of known size.
    void start(std::uint32_t vertices)
    {
        vertices_ = vertices;
        open_.clear();
    }

    /// Grows faces until the mesh has `until` of them. `source`: what to code, encoder only.
    /// Error: BadChunk when the bits ask for what cannot be. Safe on untrusted input.
    template <typename Coder>
    [[nodiscard]] Result<void> run(
        Coder& coder, GrownMesh& mesh, GrowthModel& model, std::uint32_t until, GrowthSource* source
    )
    {
        while (mesh.face_count() < until)
        {
            if (open_.empty())
            {
                VSPLIT_TRY(seed<Coder>(mesh, source));
                continue;
            }
            const Corner corner = open_.back();
            open_.pop_back();
            if (mesh.is_open(corner))
            {
                VSPLIT_TRY(grow_at(coder, mesh, model, mesh.gate(corner), source));
            }
        }
        return {};
    }

    /// Frees what is not needed once all faces are there.
    void finish() { open_ = {}; }

private:
    static constexpr std::int32_t kRate = 4000;
    static constexpr int kNearBits = 6;

    template <typename Coder>
    Result<void> seed(GrownMesh& mesh, [[maybe_unused]] GrowthSource* source)
    {
        if (mesh.vertex_count() + 3 > vertices_)
        {
            return bad();
        }
        const std::int32_t face = mesh.add_seed();
        if (face < 0)
        {
            return bad();
        }
        if constexpr (Coder::kEncodes)
        {
            VSPLIT_TRY(source->take_seed());
        }
        for (Corner k = 2; k >= 0; --k)
        {
            open_.push_back(face * 4 + k);
        }
        return {};
    }

    static tl::unexpected<Error> bad()
    {
        return fail(ErrorCode::BadChunk, "a chunk grows a mesh that cannot be");
    }

    template <typename Coder>
    Result<void> grow_at(
        Coder& coder,
        GrownMesh& mesh,
        GrowthModel& model,
        const BorderGate& gate,
        [[maybe_unused]] GrowthSource* source
    )
    {
        GrowthChoice wanted;
        if constexpr (Coder::kEncodes)
        {
            auto choice = source->choose(mesh, gate);
            VSPLIT_TRY(choice);
            wanted = *choice;
        }
        const GrowthStep step = code_step(coder, mesh, model, gate, wanted.step);
        history_ = (history_ * 4 + std::min<std::uint32_t>(static_cast<std::uint32_t>(step), 3)) %
                   GrowthModel::kHistories;
        if (step == GrowthStep::Boundary)
        {
            mesh.close(gate);
            return {};
        }
        bool done = true;
        const auto face = static_cast<Corner>(mesh.face_count());
        switch (step)
        {
            case GrowthStep::NewVertex:
                done = mesh.vertex_count() < vertices_ && mesh.grow_new(gate);
                break;
            case GrowthStep::Previous:
                done = mesh.grow_previous(gate);
                break;
            case GrowthStep::Next:
                done = mesh.grow_next(gate);
                break;
            default:
                done = mesh.grow_touching(gate, code_place(coder, mesh, model, gate, wanted.place));
                break;
        }
        if (!done)
        {
            return bad();
        }
        if constexpr (Coder::kEncodes)
        {
            source->take_face(gate.corner);
        }
        open_.push_back(face * 4 + 2);
        open_.push_back(face * 4 + 1);
        drop_closed(mesh);
        return {};
    }

    /// Forgets corners whose edges have got their face, once they are many.
    void drop_closed(const GrownMesh& mesh)
    {
        constexpr std::size_t kFew = 4096;
        if (open_.size() > kFew && open_.size() > 2 * std::size_t{mesh.node_count()})
        {
            std::erase_if(open_, [&](Corner corner) { return !mesh.is_open(corner); });
        }
    }

    template <typename Coder>
    GrowthStep code_step(
        Coder& coder,
        const GrownMesh& mesh,
        GrowthModel& model,
        const BorderGate& gate,
        GrowthStep wanted
    )
    {
        const auto count = [&](std::uint32_t vertex) -> std::size_t {
            return std::min<std::size_t>(mesh.incident(vertex), GrowthModel::kCounts - 1);
        };
        const std::size_t history = history_ * GrowthModel::kCounts;
        const std::size_t from = count(gate.from) * GrowthModel::kCounts;
        const std::size_t to = count(gate.to) * GrowthModel::kCounts;
        if (!gate.previous_closed && code_logistic<Coder, 3>(
                                         coder,
                                         {&model.previous_ends[from + count(gate.before)],
                                          &model.previous_across[from + count(gate.to)],
                                          &model.previous_history[history + count(gate.from)]},
                                         wanted == GrowthStep::Previous,
                                         kRate
                                     ))
        {
            return GrowthStep::Previous;
        }
        if (!gate.next_closed && code_logistic<Coder, 3>(
                                     coder,
                                     {&model.next_ends[to + count(gate.behind)],
                                      &model.next_across[to + count(gate.from)],
                                      &model.next_history[history + count(gate.to)]},
                                     wanted == GrowthStep::Next,
                                     kRate
                                 ))
        {
            return GrowthStep::Next;
        }
        const std::size_t closed = (gate.previous_closed ? 2U : 0U) + (gate.next_closed ? 1U : 0U);
        const bool is_rare = wanted == GrowthStep::Touch || wanted == GrowthStep::Boundary;
        if (!code_bit(coder, model.rare[closed], is_rare))
        {
            return GrowthStep::NewVertex;
        }
        return code_bit(coder, model.touch[closed], wanted == GrowthStep::Touch)
                   ? GrowthStep::Touch
                   : GrowthStep::Boundary;
    }

    /// Codes the border's edge at whose beginning the face touches: by its distance on the loop when
    /// that is short, else by its number.
    template <typename Coder>
    static std::uint32_t code_place(
        Coder& coder,
        const GrownMesh& mesh,
        GrowthModel& model,
        const BorderGate& gate,
        std::int32_t wanted
    )
    {
        constexpr std::uint32_t kMost = 1U << (kNearBits - 1);
        std::uint32_t distance = 2 * kMost;
        if constexpr (Coder::kEncodes)
        {
            std::int32_t ahead = gate.node;
            std::int32_t back = gate.node;
            for (std::uint32_t i = 0; i < kMost && distance == 2 * kMost; ++i)
            {
                ahead = mesh.next_on_border(ahead);
                back = mesh.previous_on_border(back);
                distance = ahead == wanted ? 2 * i : back == wanted ? 2 * i + 1 : distance;
            }
        }
        if (code_bit(coder, model.near, distance < 2 * kMost))
        {
            distance = coder.raw(distance, kNearBits);
            std::int32_t node = gate.node;
            for (std::uint32_t i = 0; i <= distance / 2; ++i)
            {
                node =
                    distance % 2 == 0 ? mesh.next_on_border(node) : mesh.previous_on_border(node);
            }
            return static_cast<std::uint32_t>(node);
        }
        const int bits = static_cast<int>(std::bit_width(mesh.node_count() - 1));
        return coder.raw(static_cast<std::uint32_t>(wanted), bits);
    }

    std::vector<Corner> open_;  ///< Corners across from edges still to ask, the next one last.
    std::uint32_t vertices_ = 0;
    std::uint32_t history_ = 0;  ///< The last four steps.
};

}  // namespace vsplit::codec
