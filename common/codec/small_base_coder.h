#pragma once

// Based on: Gumhold, Strasser, "Real Time Compression of Triangle Mesh Connectivity", 1998 (the border of
// a growing region is crossed edge by edge). For meshes so small that any table would cost more than it
// saves. Encoder and decoder run this same code; only the bit coder and the source differ.

#include "codec/small_base_limits.h"
#include "codec/small_base_model.h"
#include "mesh/indexed_mesh.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

namespace vsplit::codec {

/// Codes a small base mesh by growing a region over it. Not thread safe. Safe on untrusted input.
template <typename Coder>
class SmallBaseCoder
{
public:
    /// `vertices`, `faces`: as the index says; `extent`: largest coordinate per axis on the base's grid.
    /// `source`: encoder only.
    SmallBaseCoder(
        Coder& coder,
        std::uint32_t vertices,
        std::uint32_t faces,
        const std::array<std::int32_t, 3>& extent,
        ComponentStart start,
        const SmallBaseSource* source = nullptr
    )
        : coder_(coder),
          vertices_(vertices),
          faces_(faces),
          extent_(extent),
          start_(start),
          source_(source)
    {
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            coordinate_[axis] = make_coordinate_model(extent[axis]);
        }
    }

    /// Codes the mesh. `seed`: encoder only, the corner at which it begins, 3 * triangle + k.
    /// Result: false when the bits contradict themselves or the counts.
    [[nodiscard]] bool run(std::size_t seed = 0)
    {
        if constexpr (Coder::kEncodes)
        {
            number_.assign(vertices_, kNone);
            seed_ = seed;
        }
        while (mesh_.triangles.size() < faces_)
        {
            if (gates_.empty() ? !start_component() : !cross(take_gate()))
            {
                return false;
            }
            if constexpr (!Coder::kEncodes)
            {
                if (coder_.exhausted())
                {
                    return false;
                }
            }
        }
        return mesh_.positions.size() == vertices_;
    }

    /// The mesh so far: vertices and triangles in the order in which they were coded.
    [[nodiscard]] GridMesh& mesh() { return mesh_; }

    /// Encoder only: by vertex of mesh() its vertex in the source.
    [[nodiscard]] const std::vector<std::uint32_t>& order() const { return order_; }

private:
    /// A half-edge: 3 * triangle + k leads from the triangle's k-th vertex to the next one.
    using HalfEdge = std::int32_t;

    static constexpr std::uint32_t kNone = 0xFFFFFFFF;
    static constexpr HalfEdge kOpen = -1;
    static constexpr HalfEdge kBoundary = -2;

    static HalfEdge next(HalfEdge edge) { return edge % 3 == 2 ? edge - 2 : edge + 1; }

    static HalfEdge previous(HalfEdge edge) { return edge % 3 == 0 ? edge + 2 : edge - 1; }

    std::uint32_t from(HalfEdge edge) const
    {
        return mesh_
            .triangles[static_cast<std::size_t>(edge / 3)][static_cast<std::size_t>(edge % 3)];
    }

    std::uint32_t to(HalfEdge edge) const { return from(next(edge)); }

    HalfEdge& twin(HalfEdge edge) { return twins_[static_cast<std::size_t>(edge)]; }

    /// The source's vertex number `vertex` of the mesh.
    std::uint32_t source_of(std::uint32_t vertex) const { return order_[vertex]; }

    /// Takes the newest gate that nothing has been laid across yet.
    HalfEdge take_gate()
    {
        const HalfEdge gate = gates_.back();
        gates_.pop_back();
        return gate;
    }

    [[nodiscard]] bool start_component()
    {
        if (vertices_ - mesh_.positions.size() < 3)
        {
            return false;
        }
        std::array<std::uint32_t, 3> wanted{};
        if constexpr (Coder::kEncodes)
        {
            wanted = first_of_component();
        }
        const bool centred = start_ == ComponentStart::Centre || mesh_.positions.empty();
        Triangle triangle{};
        for (std::size_t k = 0; k < 3; ++k)
        {
            std::array<std::int32_t, 3> expected{};
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                expected[axis] =
                    centred && k == 0 ? extent_[axis] / 2 : mesh_.positions.back()[axis];
            }
            triangle[k] = add_vertex(wanted[k], expected);
        }
        return add_triangle(triangle);
    }

    /// Encoder only: a triangle of which no vertex was coded.
    std::array<std::uint32_t, 3> first_of_component() const
    {
        const auto& triangles = source_->mesh().triangles;
        std::size_t f = seed_ / 3;
        while (number_[triangles[f][0]] != kNone)
        {
            f = (f + 1) % triangles.size();
        }
        const std::size_t k = seed_ % 3;
        return {triangles[f][k], triangles[f][(k + 1) % 3], triangles[f][(k + 2) % 3]};
    }

    /// Says what lies across an edge.
    [[nodiscard]] bool cross(HalfEdge gate)
    {
        if (twin(gate) != kOpen)
        {
            return true;
        }
        const std::uint32_t a = from(gate);
        const std::uint32_t b = to(gate);
        std::optional<std::uint32_t> wanted;
        if constexpr (Coder::kEncodes)
        {
            wanted = source_->apex(source_of(b), source_of(a));
        }
        find_candidates(gate);
        const std::size_t context = std::min<std::size_t>(candidates_.size(), 3);
        const bool possible = mesh_.positions.size() < vertices_;
        if (possible && code_bit(coder_, new_vertex_[context], wanted && is_new(*wanted)))
        {
            add_triangle({b, a, add_vertex(wanted.value_or(0), expect(gate))});
            return true;
        }
        if (code_bit(coder_, boundary_, !wanted))
        {
            twin(gate) = kBoundary;
            return true;
        }
        const std::uint32_t known = code_known(wanted ? number_of(*wanted) : kNone);
        if (known >= mesh_.positions.size() || known == a || known == b)
        {
            return false;
        }
        return add_triangle({b, a, known});
    }

    bool is_new(std::uint32_t vertex) const { return number_[vertex] == kNone; }

    std::uint32_t number_of(std::uint32_t vertex) const { return number_[vertex]; }

    /// Collects the vertices along the border, from the gate's end on; where a boundary cuts the border,
    /// also from the gate's beginning backwards.
    void find_candidates(HalfEdge gate)
    {
        candidates_.clear();
        HalfEdge edge = gate;
        while (true)
        {
            edge = next(edge);
            while (twin(edge) >= 0)
            {
                edge = next(twin(edge));
            }
            if (twin(edge) == kBoundary || edge == gate || to(edge) == from(gate))
            {
                break;
            }
            candidates_.push_back(to(edge));
        }
        if (twin(edge) != kBoundary)
        {
            return;
        }
        for (edge = gate;;)
        {
            edge = previous(edge);
            while (twin(edge) >= 0)
            {
                edge = previous(twin(edge));
            }
            if (twin(edge) == kBoundary || from(edge) == to(gate))
            {
                return;
            }
            candidates_.push_back(from(edge));
        }
    }

    /// Codes a vertex that is there already: most often the next one along the border, or the last one.
    std::uint32_t code_known(std::uint32_t wanted)
    {
        const std::size_t count = candidates_.size();
        const std::size_t context = std::min<std::size_t>(count, 3);
        if (count > 0 && code_bit(coder_, first_[context], wanted == candidates_.front()))
        {
            return candidates_.front();
        }
        if (count > 1 && code_bit(coder_, last_, wanted == candidates_.back()))
        {
            return candidates_.back();
        }
        if (count > 2)
        {
            const auto between = static_cast<std::uint32_t>(count - 2);
            const auto found = std::find(candidates_.begin() + 1, candidates_.end() - 1, wanted);
            const std::uint32_t index = coder_.raw(
                static_cast<std::uint32_t>(found - candidates_.begin() - 1),
                static_cast<int>(std::bit_width(between))
            );
            if (index < between)
            {
                return candidates_[index + 1];
            }
        }
        const auto most = static_cast<std::uint32_t>(mesh_.positions.size() - 1);
        return coder_.raw(wanted, static_cast<int>(std::bit_width(most)));
    }

    /// The place of a new vertex across an edge: half as far from it as the vertex on the near side.
    std::array<std::int32_t, 3> expect(HalfEdge gate) const
    {
        const auto& a = mesh_.positions[from(gate)];
        const auto& b = mesh_.positions[to(gate)];
        const auto& c = mesh_.positions[from(previous(gate))];
        std::array<std::int32_t, 3> expected{};
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const std::int32_t sum = 3 * (a[axis] + b[axis]) - 2 * c[axis];
            expected[axis] = std::clamp(sum >> 2, 0, extent_[axis]);
        }
        return expected;
    }

    std::uint32_t add_vertex(std::uint32_t wanted, const std::array<std::int32_t, 3>& expected)
    {
        std::array<std::int32_t, 3> position{};
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            std::int32_t difference = 0;
            if constexpr (Coder::kEncodes)
            {
                difference = source_->mesh().positions[wanted][axis] - expected[axis];
            }
            const std::size_t context = expected[axis] * 3 < extent_[axis]       ? 0
                                        : expected[axis] * 3 > 2 * extent_[axis] ? 2
                                                                                 : 1;
            position[axis] =
                expected[axis] + code_integer(coder_, coordinate_[axis], difference, context);
        }
        if constexpr (Coder::kEncodes)
        {
            number_[wanted] = static_cast<std::uint32_t>(mesh_.positions.size());
            order_.push_back(wanted);
        }
        mesh_.positions.push_back(position);
        return static_cast<std::uint32_t>(mesh_.positions.size() - 1);
    }

    /// Adds a triangle and links it to its neighbours. Result: false when one of its edges is taken.
    bool add_triangle(const Triangle& triangle)
    {
        const auto first = static_cast<HalfEdge>(mesh_.triangles.size() * 3);
        mesh_.triangles.push_back(triangle);
        bool good = true;
        for (HalfEdge edge = first; edge < first + 3; ++edge)
        {
            good =
                edges_.try_emplace(SmallBaseSource::key(from(edge), to(edge)), edge).second && good;
            const auto across = edges_.find(SmallBaseSource::key(to(edge), from(edge)));
            const bool open = across == edges_.end();
            twins_.push_back(open ? kOpen : across->second);
            if (!open)
            {
                good = good && twin(across->second) == kOpen;
                twin(across->second) = edge;
            }
        }
        // The edge that ends where the gate ended comes last, so that it is crossed next.
        gates_.insert(gates_.end(), {first, first + 1, first + 2});
        return good;
    }

    Coder& coder_;
    std::uint32_t vertices_;
    std::uint32_t faces_;
    std::array<std::int32_t, 3> extent_;
    ComponentStart start_;
    const SmallBaseSource* source_;
    std::array<IntegerModel, 3> coordinate_;
    std::array<AdaptiveBit, 4> new_vertex_{{{32768, 4}, {32768, 4}, {32768, 4}, {32768, 4}}};
    std::array<AdaptiveBit, 4> first_{{{32768, 4}, {58000, 4}, {40000, 4}, {40000, 4}}};
    AdaptiveBit last_{16384, 4};
    AdaptiveBit boundary_{2048, 4};
    GridMesh mesh_;
    std::vector<HalfEdge> twins_;
    std::vector<HalfEdge> gates_;
    std::vector<std::uint32_t> candidates_;
    std::unordered_map<std::uint64_t, HalfEdge> edges_;
    std::size_t seed_ = 0;
    std::vector<std::uint32_t> number_;  ///< Encoder only: by vertex of the source its number.
    std::vector<std::uint32_t> order_;
};

}  // namespace vsplit::codec
