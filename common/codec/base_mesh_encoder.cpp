#include "codec/base_mesh_encoder.h"

#include "codec/base_mesh_decoder.h"
#include "codec/entropy_coder.h"
#include "codec/refinement_mesh.h"
#include "codec/small_base_coder.h"
#include "core/byte_writer.h"

#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>

#include <algorithm>
#include <array>
#include <utility>

namespace vsplit::codec {
namespace {

constexpr std::uint32_t kUnknown = 0xFFFFFFFF;

/// Corners of a base that is tried from every one of them.
constexpr std::size_t kMostSeeds = 150;

Result<std::vector<std::byte>> encode_with_draco(const GridMesh& base, bool edgebreaker)
{
    draco::Mesh mesh;
    const auto vertex_count = static_cast<std::uint32_t>(base.positions.size());
    mesh.SetNumFaces(base.triangles.size());
    mesh.set_num_points(vertex_count);
    for (std::uint32_t f = 0; f < base.triangles.size(); ++f)
    {
        const Triangle& triangle = base.triangles[f];
        draco::Mesh::Face face;
        for (std::size_t k = 0; k < 3; ++k)
        {
            face[k] = draco::PointIndex(triangle[k]);
        }
        mesh.SetFace(draco::FaceIndex(f), face);
    }
    draco::GeometryAttribute attribute;
    attribute.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_INT32, false, 12, 0);
    const int id = mesh.AddAttribute(attribute, true, vertex_count);
    for (std::uint32_t v = 0; v < vertex_count; ++v)
    {
        mesh.attribute(id)->SetAttributeValue(
            draco::AttributeValueIndex(v), base.positions[v].data()
        );
    }
    draco::Encoder encoder;
    encoder.SetSpeedOptions(0, 0);
    encoder.SetEncodingMethod(
        edgebreaker ? draco::MESH_EDGEBREAKER_ENCODING : draco::MESH_SEQUENTIAL_ENCODING
    );
    draco::EncoderBuffer buffer;
    const draco::Status status = encoder.EncodeMeshToBuffer(mesh, &buffer);
    if (!status.ok())
    {
        return fail(
            ErrorCode::Internal, "Draco cannot code the base mesh: " + status.error_msg_string()
        );
    }
    const auto bytes = std::as_bytes(std::span(buffer.data(), buffer.size()));
    return std::vector<std::byte>(bytes.begin(), bytes.end());
}

/// Finds the isomorphism between two copies of one mesh whose vertices and faces are renumbered.
/// Positions alone do not tell vertices apart on a coarse grid, so a seed face is guessed by its
/// positions and the guess is followed over the neighbours.
class MeshMatcher
{
public:
    MeshMatcher(const RefinementMesh& from, const RefinementMesh& to)
        : from_(from),
          to_(to),
          vertex_map_(from.vertex_count(), kUnknown),
          matched_from_(from.face_count(), false),
          matched_to_(to.face_count(), false)
    {
    }

    /// Result: by vertex of `from` its vertex in `to`; empty when the meshes differ.
    std::vector<std::uint32_t> run()
    {
        std::vector<Key> keys;
        for (std::uint32_t f = 0; f < to_.face_count(); ++f)
        {
            for (Corner k = 0; k < 3; ++k)
            {
                const Corner corner = static_cast<Corner>(f) * 4 + k;
                keys.push_back({key_of(to_, corner), corner});
            }
        }
        std::ranges::sort(keys, {}, &Key::positions);
        for (std::uint32_t f = 0; f < from_.face_count(); ++f)
        {
            if (!matched_from_[f] && !match_component(static_cast<Corner>(f) * 4, keys))
            {
                return {};
            }
        }
        return std::move(vertex_map_);
    }

private:
    struct Key
    {
        std::array<float, 9> positions{};
        Corner corner = -1;
    };

    static std::array<float, 9> key_of(const RefinementMesh& mesh, Corner corner)
    {
        std::array<float, 9> key{};
        for (std::size_t k = 0; k < 3; ++k, corner = next_corner(corner))
        {
            const Point& point = mesh.points()[mesh.vertex(corner)];
            key[3 * k] = point.x;
            key[3 * k + 1] = point.y;
            key[3 * k + 2] = point.z;
        }
        return key;
    }

    bool match_component(Corner seed, const std::vector<Key>& keys)
    {
        const auto wanted = key_of(from_, seed);
        auto candidate = std::ranges::lower_bound(keys, wanted, {}, &Key::positions);
        for (; candidate != keys.end() && candidate->positions == wanted; ++candidate)
        {
            if (!matched_to_[static_cast<std::size_t>(face_of(candidate->corner))] &&
                follow(seed, candidate->corner))
            {
                return true;
            }
        }
        return false;
    }

    bool same_position(Corner a, Corner b) const
    {
        const Point& p = from_.points()[from_.vertex(a)];
        const Point& q = to_.points()[to_.vertex(b)];
        return p.x == q.x && p.y == q.y && p.z == q.z;
    }

    /// Extends a guess over its component; undoes it when it fails.
    bool follow(Corner seed_from, Corner seed_to)
    {
        std::vector<std::pair<Corner, Corner>> done{{seed_from, seed_to}};
        std::vector<std::uint32_t> assigned;
        mark(seed_from, seed_to, true);
        bool good = true;
        for (std::size_t i = 0; i < done.size() && good; ++i)
        {
            auto [a, b] = done[i];
            for (int k = 0; k < 3 && good; ++k, a = next_corner(a), b = next_corner(b))
            {
                good = assign(a, b, assigned) && cross_edge(a, b, done);
            }
        }
        if (!good)
        {
            for (const auto& [a, b] : done)
            {
                mark(a, b, false);
            }
            for (const std::uint32_t v : assigned)
            {
                vertex_map_[v] = kUnknown;
            }
        }
        return good;
    }

    void mark(Corner a, Corner b, bool value)
    {
        matched_from_[static_cast<std::size_t>(face_of(a))] = value;
        matched_to_[static_cast<std::size_t>(face_of(b))] = value;
    }

    bool assign(Corner a, Corner b, std::vector<std::uint32_t>& assigned)
    {
        std::uint32_t& target = vertex_map_[from_.vertex(a)];
        if (target == kUnknown)
        {
            target = to_.vertex(b);
            assigned.push_back(from_.vertex(a));
            return same_position(a, b);
        }
        return target == to_.vertex(b);
    }

    bool cross_edge(Corner a, Corner b, std::vector<std::pair<Corner, Corner>>& done)
    {
        const Corner over_a = from_.opposite(a);
        const Corner over_b = to_.opposite(b);
        if (over_a < 0 || over_b < 0)
        {
            return over_a < 0 && over_b < 0;
        }
        const bool seen_a = matched_from_[static_cast<std::size_t>(face_of(over_a))];
        const bool seen_b = matched_to_[static_cast<std::size_t>(face_of(over_b))];
        if (seen_a || seen_b)
        {
            return seen_a && seen_b;
        }
        mark(over_a, over_b, true);
        done.emplace_back(over_a, over_b);
        return true;
    }

    const RefinementMesh& from_;
    const RefinementMesh& to_;
    std::vector<std::uint32_t> vertex_map_;
    std::vector<bool> matched_from_;
    std::vector<bool> matched_to_;
};

Result<RefinementMesh> linked(const GridMesh& mesh)
{
    constexpr std::int32_t kAnyIndex = 1 << 24;
    RefinementMesh result;
    const auto vertices = static_cast<std::uint32_t>(mesh.positions.size());
    result.reserve(vertices, static_cast<std::uint32_t>(mesh.triangles.size()));
    VSPLIT_TRY(result.set_base(mesh, kAnyIndex));
    return result;
}

Result<EncodedBase> encode_and_match(const GridMesh& base, bool edgebreaker)
{
    auto bytes = encode_with_draco(base, edgebreaker);
    VSPLIT_TRY(bytes);
    EncodedBase result;
    result.bytes = std::move(*bytes);
    std::int32_t max_index = 0;
    for (const auto& position : base.positions)
    {
        max_index = std::max(max_index, std::ranges::max(position));
    }
    auto decoded = decode_draco_base(
        result.bytes,
        static_cast<std::uint32_t>(base.positions.size()),
        static_cast<std::uint32_t>(base.triangles.size()),
        static_cast<std::uint32_t>(max_index)
    );
    VSPLIT_TRY(decoded);
    result.decoded = std::move(*decoded);
    const auto from = linked(result.decoded);
    VSPLIT_TRY(from);
    const auto to = linked(base);
    VSPLIT_TRY(to);
    result.vertices = MeshMatcher(*from, *to).run();
    if (result.vertices.empty())
    {
        return fail(ErrorCode::Internal, "Draco changed the base mesh");
    }
    return result;
}

}  // namespace

Result<EncodedBase> encode_draco_base(const GridMesh& base)
{
    auto result = encode_and_match(base, true);
    return result ? std::move(result) : encode_and_match(base, false);
}

EncodedBase encode_small_base(
    const GridMesh& base, const std::array<std::int32_t, 3>& extent, ComponentStart start
)
{
    const SmallBaseSource source(base);
    const std::size_t corners = base.triangles.size() * 3;
    const std::size_t seeds = corners <= kMostSeeds ? corners : 1;
    EncodedBase best;
    best.codec = proto::kSmallBaseCodec;
    for (std::size_t seed = 0; seed < seeds; ++seed)
    {
        BitEncoder bits;
        SmallBaseCoder<BitEncoder> coder(
            bits,
            static_cast<std::uint32_t>(base.positions.size()),
            static_cast<std::uint32_t>(base.triangles.size()),
            extent,
            start,
            &source
        );
        if (!coder.run(seed))
        {
            continue;
        }
        ByteWriter out;
        bits.finish(out);
        if (best.bytes.empty() || out.size() < best.bytes.size())
        {
            best.bytes = out.take();
            best.decoded = std::move(coder.mesh());
            best.vertices = coder.order();
        }
    }
    return best;
}

Result<EncodedBase> encode_base_mesh(
    const GridMesh& base, const std::array<std::int32_t, 3>& extent
)
{
    if (base.positions.size() > kMaxSmallBaseVertices ||
        base.triangles.size() > kMaxSmallBaseFaces * base.positions.size())
    {
        return encode_draco_base(base);
    }
    EncodedBase small = encode_small_base(base, extent, ComponentStart::Centre);
    // A Draco mesh takes more than this before it says anything.
    constexpr std::size_t kDracoBytes = 60;
    if (!small.bytes.empty() && small.bytes.size() <= kDracoBytes)
    {
        return small;
    }
    auto draco = encode_draco_base(base);
    return draco && (small.bytes.empty() || draco->bytes.size() < small.bytes.size())
               ? std::move(draco)
               : Result<EncodedBase>(std::move(small));
}

}  // namespace vsplit::codec
