// Reads hostile mesh files and repairs what comes out. The first byte chooses the format.

#include "precompute/mesh_builder.h"
#include "precompute/mesh_readers.h"
#include "precompute/repair.h"
#include "precompute/validate.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string_view>
#include <utility>

namespace {

using namespace vsplit;
using namespace vsplit::precompute;

Result<IndexedMesh> mesh_of(Result<SourceModel> model)
{
    return std::move(model).map([](SourceModel&& read) { return std::move(read.surface.mesh); });
}

Result<IndexedMesh> read(std::uint8_t format, std::span<const std::byte> bytes)
{
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    switch (format % 5)
    {
        case 0:
            return mesh_of(read_ply_model(bytes, nullptr));
        case 1:
            return read_off(text);
        case 2:
            return mesh_of(read_obj_model(text, nullptr));
        case 3:
            return read_stl(bytes);
        default:
            return read_om(bytes);
    }
}

void require(bool holds)
{
    if (!holds)
    {
        std::abort();
    }
}

void check_repair(const IndexedMesh& mesh)
{
    const auto repaired = repair_mesh(mesh);
    if (!repaired)
    {
        require(repaired.error().code == ErrorCode::EmptyMesh);
        return;
    }
    require(check_manifold(repaired->mesh).has_value());
    const RepairReport& report = repaired->report;
    require(
        repaired->mesh.positions.size() + report.welded_vertices + report.isolated_vertices ==
        mesh.positions.size() + report.added_vertices
    );
    require(
        repaired->mesh.triangles.size() + report.degenerate_faces + report.duplicate_faces ==
        mesh.triangles.size()
    );
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    if (size == 0)
    {
        return 0;
    }
    const auto mesh = read(data[0], std::as_bytes(std::span(data, size)).subspan(1));
    if (!mesh)
    {
        require(exit_status(mesh.error().code) == 3);  // bad input mesh, nothing else
        return 0;
    }
    require(!mesh->triangles.empty());
    require(std::all_of(mesh->positions.begin(), mesh->positions.end(), is_position));
    check_repair(*mesh);
    return 0;
}
