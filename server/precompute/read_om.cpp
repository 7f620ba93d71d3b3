// Based on: OpenMesh 9.0, OMReader.cc (in which order its callbacks come and what they mean).
#include "precompute/half_edge_mesh.h"
#include "precompute/mesh_builder.h"
#include "precompute/mesh_readers.h"
#include "precompute/om_chunks.h"

#include <OpenMesh/Core/IO/importer/ImporterT.hh>
#include <OpenMesh/Core/IO/reader/OMReader.hh>

#include <algorithm>
#include <limits>
#include <mutex>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace vsplit::precompute {
namespace {

tl::unexpected<Error> no_loop(int face)
{
    return fail(
        ErrorCode::NotAMesh, "the half-edges of face " + std::to_string(face) + " are no loop"
    );
}

/// Takes what OpenMesh's reader finds. The base class passes it on to a mesh without checking a
/// handle, hence that mesh stays empty.
class OmCollector : public OpenMesh::IO::ImporterT<HalfEdgeMesh>
{
    using Base = OpenMesh::IO::ImporterT<HalfEdgeMesh>;

public:
    explicit OmCollector(HalfEdgeMesh& unused) : Base(unused) {}

    using Base::add_vertex;

    OpenMesh::VertexHandle add_vertex(const OpenMesh::Vec3f& point) override
    {
        return add_vertex(OpenMesh::Vec3d(point));
    }

    OpenMesh::VertexHandle add_vertex(const OpenMesh::Vec3d& point) override
    {
        note(builder_.add_vertex({point[0], point[1], point[2]}));
        return OpenMesh::VertexHandle();
    }

    /// Files up to version 1: a face by its vertices.
    OpenMesh::FaceHandle add_face(const VHandles& vertices) override
    {
        corners_.clear();
        for (const OpenMesh::VertexHandle vertex : vertices)
        {
            corners_.push_back(vertex.idx());
        }
        note(builder_.add_polygon(corners_));
        return OpenMesh::FaceHandle();
    }

    /// Files from version 2 on: a face by one of its half-edges.
    OpenMesh::FaceHandle add_face(OpenMesh::HalfedgeHandle half) override
    {
        faces_.push_back(half.idx());
        return OpenMesh::FaceHandle();
    }

    OpenMesh::HalfedgeHandle add_edge(OpenMesh::VertexHandle start, OpenMesh::VertexHandle end)
        override
    {
        halves_.push_back({.end = end.idx()});
        halves_.push_back({.end = start.idx()});
        return OpenMesh::HalfedgeHandle(static_cast<int>(halves_.size() - 2));
    }

    void set_face(OpenMesh::HalfedgeHandle half, OpenMesh::FaceHandle face) override
    {
        halves_[static_cast<std::size_t>(half.idx())].face = face.idx();
    }

    void set_next(OpenMesh::HalfedgeHandle half, OpenMesh::HalfedgeHandle next) override
    {
        halves_[static_cast<std::size_t>(half.idx())].next = next.idx();
    }

    Result<IndexedMesh> take_mesh()
    {
        VSPLIT_TRY(status_);
        for (std::size_t face = 0; face < faces_.size(); ++face)
        {
            VSPLIT_TRY(collect(static_cast<int>(face)));
        }
        const auto left = std::find_if(halves_.begin(), halves_.end(), [](const Half& half) {
            return half.face >= 0;
        });
        if (left != halves_.end())
        {
            return no_loop(left->face);
        }
        return builder_.finish();
    }

private:
    struct Half
    {
        int end = -1;
        int face = -1;
        int next = -1;
    };

    void note(const Result<void>& result) { status_ = status_ ? result : status_; }

    [[nodiscard]] Half* find(int half)
    {
        const auto index = static_cast<std::size_t>(half);  // a negative one is too large then
        return index < halves_.size() ? &halves_[index] : nullptr;
    }

    /// Turns one loop of half-edges into a polygon.
    Result<void> collect(int face)
    {
        constexpr int kTaken = std::numeric_limits<int>::min();
        const int first = faces_[static_cast<std::size_t>(face)];
        Half* half = find(first);
        if (half != nullptr && half->face == -1)
        {
            return {};  // was deleted, but not yet collected as garbage
        }
        corners_.clear();
        for (int next = first; corners_.empty() || next != first; half = find(next))
        {
            if (half == nullptr || half->face != face)
            {
                return no_loop(face);
            }
            half->face = kTaken;  // so that this ends
            corners_.push_back(half->end);
            next = half->next;
        }
        return builder_.add_polygon(corners_);
    }

    MeshBuilder builder_;
    Result<void> status_;
    std::vector<Half> halves_;
    std::vector<int> faces_;
    std::vector<std::int64_t> corners_;
};

bool read_with_open_mesh(std::string geometry, OmCollector& collector)
{
    std::istringstream stream(std::move(geometry), std::ios::binary);
    stream.unsetf(std::ios::skipws);
    OpenMesh::IO::Options options;
    static std::mutex mutex;  // the reader is one object that keeps its state in itself
    const std::lock_guard lock(mutex);
    return OpenMesh::IO::OMReader().read(stream, collector, options);
}

}  // namespace

Result<IndexedMesh> read_om(std::span<const std::byte> bytes)
{
    auto geometry = om_geometry(bytes);
    VSPLIT_TRY(geometry);
    HalfEdgeMesh unused;
    OmCollector collector(unused);
    if (!read_with_open_mesh(std::move(*geometry), collector))
    {
        return fail(ErrorCode::NotAMesh, "OpenMesh does not understand it");
    }
    return collector.take_mesh();
}

}  // namespace vsplit::precompute
