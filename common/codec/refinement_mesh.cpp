// Based on: Rossignac, Safonova, Szymczak, "3D Compression Made Simple: Edgebreaker on a Corner Table",
// 2001 (corner table); Hoppe, "Progressive Meshes", 1996 (vertex split).
#include "codec/refinement_mesh.h"

#include "codec/float_log.h"
#include "codec/vector3.h"
#include "core/assert.h"

#include <algorithm>
#include <utility>

namespace vsplit::codec {
namespace {

/// A directed edge of the base mesh and the corner across from it.
struct EdgeKey
{
    std::uint64_t vertices = 0;
    Corner corner = -1;
};

std::uint8_t edge_log(const Vector3& edge)
{
    return static_cast<std::uint8_t>(std::min(255, steps_log2<3>(dot(edge, edge) + 1.0F)));
}

}  // namespace

void RefinementMesh::reserve(std::uint32_t vertices, std::uint32_t faces)
{
    storage_.assign(std::size_t{faces} + 1, Face{});
    storage_.front().state = FaceState::Boundary;
    points_.assign(vertices, Point{});
    valences_.assign(vertices, 0);
}

Result<void> RefinementMesh::set_base(const GridMesh& base, std::int32_t max_index)
{
    vertex_count_ = 0;
    face_count_ = 0;
    batch_start_ = 0;
    return add_parts(base, max_index);
}

Result<void> RefinementMesh::add_parts(const GridMesh& parts, std::int32_t max_index)
{
    finish_batch();
    const std::uint32_t vertices = vertex_count_;
    const std::uint32_t faces = face_count_;
    auto done = take(parts, max_index);
    if (!done)
    {
        vertex_count_ = vertices;
        face_count_ = faces;
    }
    batch_start_ = face_count_;
    return done;
}

/// Appends a mesh and links its faces to each other.
Result<void> RefinementMesh::take(const GridMesh& mesh, std::int32_t max_index)
{
    const std::uint32_t first_vertex = vertex_count_;
    const std::uint32_t first_face = face_count_;
    const auto vertices = static_cast<std::uint32_t>(mesh.positions.size());
    const auto triangles = static_cast<std::uint32_t>(mesh.triangles.size());
    VSPLIT_ASSERT(vertices <= points_.size() - first_vertex);
    VSPLIT_ASSERT(triangles <= face_capacity() - first_face);
    vertex_count_ += vertices;
    face_count_ += triangles;
    for (std::uint32_t v = 0; v < vertices; ++v)
    {
        for (const std::int32_t coordinate : mesh.positions[v])
        {
            if (coordinate < 0 || coordinate > max_index)
            {
                return fail(ErrorCode::BadChunk, "a base vertex lies outside the grid");
            }
        }
        const auto& [x, y, z] = mesh.positions[v];
        points_[first_vertex + v] =
            Point{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
    }
    for (std::uint32_t f = 0; f < triangles; ++f)
    {
        const auto& [a, b, c] = mesh.triangles[f];
        if (std::max({a, b, c}) >= vertices || a == b || b == c || c == a)
        {
            return fail(ErrorCode::BadChunk, "a base triangle is malformed");
        }
        faces()[first_face + f] = Face{
            .vertex = {first_vertex + a, first_vertex + b, first_vertex + c},
            .slot = first_face + f,
        };
    }
    VSPLIT_TRY(link_from(first_face));
    return check_fans(first_vertex, first_face);
}

/// Links the faces from `first_face` on, which share vertices with no other.
Result<void> RefinementMesh::link_from(std::uint32_t first_face)
{
    std::vector<EdgeKey> edges;
    edges.reserve(std::size_t{face_count_ - first_face} * 3);
    for (std::uint32_t f = first_face; f < face_count_; ++f)
    {
        for (Corner k = 0; k < 3; ++k)
        {
            const Corner corner = static_cast<Corner>(f) * 4 + k;
            const std::uint64_t from = vertex(next_corner(corner));
            edges.push_back({from << 32 | vertex(previous_corner(corner)), corner});
        }
    }
    const auto by_vertices = [](const EdgeKey& a, const EdgeKey& b) {
        return a.vertices < b.vertices;
    };
    std::ranges::sort(edges, by_vertices);
    for (std::size_t i = 0; i < edges.size(); ++i)
    {
        if (i > 0 && edges[i].vertices == edges[i - 1].vertices)
        {
            return fail(ErrorCode::BadChunk, "the base mesh is not a 2-manifold");
        }
        const EdgeKey twin{edges[i].vertices << 32 | edges[i].vertices >> 32, -1};
        const auto found = std::ranges::lower_bound(edges, twin, by_vertices);
        if (found != edges.end() && found->vertices == twin.vertices)
        {
            faces()[face_of(edges[i].corner)]
                .opposite[static_cast<std::size_t>(edges[i].corner & 3)] = found->corner;
        }
    }
    return {};
}

Result<void> RefinementMesh::check_fans(std::uint32_t first_vertex, std::uint32_t first_face)
{
    std::vector<std::uint32_t> corners(vertex_count_ - first_vertex, 0);
    std::vector<Corner> some(vertex_count_ - first_vertex, -1);
    for (std::uint32_t f = first_face; f < face_count_; ++f)
    {
        for (Corner k = 0; k < 3; ++k)
        {
            const Corner corner = static_cast<Corner>(f) * 4 + k;
            ++corners[vertex(corner) - first_vertex];
            some[vertex(corner) - first_vertex] = corner;
        }
    }
    for (std::uint32_t v = 0; v < some.size(); ++v)
    {
        if (some[v] < 0)
        {
            return fail(ErrorCode::BadChunk, "a base vertex belongs to no triangle");
        }
        std::uint32_t visited = 0;
        bool closed = false;
        Corner corner = some[v];
        while (corner >= 0 && !closed)
        {
            ++visited;
            const Corner across = opposite(next_corner(corner));
            corner = across < 0 ? -1 : next_corner(across);
            closed = corner == some[v];
        }
        corner = some[v];
        while (!closed && corner >= 0)
        {
            const Corner across = opposite(previous_corner(corner));
            corner = across < 0 ? -1 : previous_corner(across);
            visited += corner >= 0 ? 1 : 0;
        }
        if (visited != corners[v])
        {
            return fail(ErrorCode::BadChunk, "the base mesh has a non-manifold vertex");
        }
        valences_[first_vertex + v] = static_cast<std::uint16_t>(
            std::min<std::uint32_t>(kManyNeighbours, corners[v] + (closed ? 0U : 1U))
        );
    }
    return {};
}

void RefinementMesh::start_batch()
{
    finish_batch();
    for (std::uint32_t f = 0; f < face_count_; ++f)
    {
        Face& face = faces()[f];
        const Vector3 a = to_vector(points_[face.vertex[0]]);
        const Vector3 b = to_vector(points_[face.vertex[1]]);
        const Vector3 c = to_vector(points_[face.vertex[2]]);
        face.edge_log = {edge_log(c - b), edge_log(a - c), edge_log(b - a)};
        face.state = FaceState::Free;
    }
}

void RefinementMesh::link(Corner a, Corner b)
{
    if (a >= 0)
    {
        faces()[face_of(a)].opposite[static_cast<std::size_t>(a & 3)] = b;
    }
    if (b >= 0)
    {
        faces()[face_of(b)].opposite[static_cast<std::size_t>(b & 3)] = a;
    }
}

std::int32_t RefinementMesh::add_face(std::array<std::uint32_t, 3> vertices, const Face& like)
{
    const std::uint32_t slot = face_count_++;
    const auto index = static_cast<std::int32_t>(face_capacity() - added_count());
    // Neighbours that are still free read the edge lengths of this face; those of the face it grew
    // from serve, as long as both sides do the same.
    faces()[index] = Face{
        .vertex = vertices,
        .edge_log = like.edge_log,
        .state = FaceState::Taken,
        .slot = slot,
    };
    return index * 4;
}

void RefinementMesh::split_right(const Split& split, std::uint32_t kept, std::uint32_t removed)
{
    const Corner inner = previous_corner(split.first);
    const Corner outer = opposite(inner);
    const std::uint32_t right = vertex(next_corner(split.first));
    const Corner face = add_face({kept, right, removed}, faces()[face_of(split.first)]);
    link(face, inner);
    link(face + 2, outer);
}

void RefinementMesh::split_left(
    const Split& split, Corner last, std::uint32_t kept, std::uint32_t removed
)
{
    const Corner inner = next_corner(last);
    const Corner outer = opposite(inner);
    const std::uint32_t left = vertex(previous_corner(last));
    const Corner face = add_face({kept, removed, left}, faces()[face_of(last)]);
    link(face, inner);
    link(face + 1, outer);
    if (split.kind == SplitKind::Interior)
    {
        link(face + 2, face + 4 + 1);  // the right face was added just before
    }
}

void RefinementMesh::apply(std::span<const Split> splits)
{
    for (const Split& split : splits)
    {
        apply(split);
    }
}

void RefinementMesh::apply(const Split& split)
{
    const std::uint32_t removed = vertex_count_++;
    const std::uint32_t kept = vertex(split.first);
    Corner corner = split.first;
    Corner last = corner;
    for (int i = 0; i < split.wedge; ++i)
    {
        last = corner;
        Face& face = faces()[face_of(corner)];
        face.vertex[static_cast<std::size_t>(corner & 3)] = removed;
        if (i == split.before)
        {
            face.state =
                split.kind == SplitKind::Interior ? FaceState::SeedOfTwo : FaceState::SeedOfOne;
        }
        const Corner across = opposite(next_corner(corner));
        corner = i + 1 < split.wedge ? next_corner(across) : corner;
    }
    if (split.kind != SplitKind::BoundaryRight)
    {
        split_right(split, kept, removed);
    }
    if (split.kind != SplitKind::BoundaryLeft)
    {
        split_left(split, last, kept, removed);
    }
    valences_[removed] = static_cast<std::uint16_t>(split.wedge + 2);
}

void RefinementMesh::finish_batch()
{
    if (added_count() == 0)
    {
        return;
    }
    assign_places();
    const std::uint32_t first_added = face_capacity() - added_count();
    const auto renumber = [this](Face& face) {
        for (Corner& corner : face.opposite)
        {
            corner = corner < 0
                         ? -1
                         : static_cast<Corner>(faces()[face_of(corner)].place()) * 4 + (corner & 3);
        }
    };
    std::for_each(faces(), faces() + batch_start_, renumber);
    std::for_each(faces() + first_added, faces() + face_capacity(), renumber);
    if (face_count_ <= first_added)
    {
        sort_in_added();
    }
    else
    {
        follow_places();
    }
    batch_start_ = face_count_;
}

/// Tells every face where it goes: seeds are met in the order in which their splits added faces.
void RefinementMesh::assign_places()
{
    std::uint32_t place = 0;
    Face* added = faces() + face_capacity();
    for (Face* face = faces(); face != faces() + batch_start_; ++face)
    {
        const FaceState state = face->state;
        face->set_place(place++);
        if (state >= FaceState::SeedOfOne)
        {
            (--added)->set_place(place++);
        }
        if (state == FaceState::SeedOfTwo)
        {
            (--added)->set_place(place++);
        }
    }
}

/// Moves every face to its place when the added ones stand behind all places. Faces from before only
/// move towards the end, so moving the last one first overwrites nothing.
void RefinementMesh::sort_in_added()
{
    const Face* added = faces() + face_capacity() - added_count();
    std::uint32_t target = face_count_;
    for (std::uint32_t f = batch_start_; f < target;)
    {
        --f;
        while (target > faces()[f].place() + 1)
        {
            faces()[--target] = *added++;
        }
        faces()[--target] = faces()[f];
    }
}

/// Moves every face to its place along the cycles of the permutation: slower, but needs no room.
void RefinementMesh::follow_places()
{
    const Face* const added = faces() + face_capacity() - added_count();
    std::copy(added, added + added_count(), faces() + batch_start_);
    for (std::uint32_t f = 0; f < face_count_; ++f)
    {
        while (faces()[f].place() != f)
        {
            std::swap(faces()[f], faces()[faces()[f].place()]);
        }
    }
}

std::uint32_t RefinementMesh::added_faces(std::span<const Split> splits)
{
    std::uint32_t count = 0;
    for (const Split& split : splits)
    {
        count += split.kind == SplitKind::Interior ? 2U : 1U;
    }
    return count;
}

}  // namespace vsplit::codec
