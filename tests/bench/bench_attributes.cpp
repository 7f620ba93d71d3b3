// Bytes of Draco's file of a mesh alone, with each of its attributes, and with all of them.
#include "draco_surface.h"
#include "precompute/repair_surface.h"
#include "precompute/surface_io.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <string>
#include <utility>

namespace vsplit::bench {
namespace {

const char* name_of(AttributeKind kind)
{
    switch (kind)
    {
        case AttributeKind::TexCoord:
            return "tex_coord";
        case AttributeKind::Normal:
            return "normal";
        case AttributeKind::Color:
            return "color";
        case AttributeKind::Scalar:
            break;
    }
    return "scalar";
}

Result<std::size_t> file_bytes(const Surface& surface)
{
    const auto file = encode_surface_with_draco(surface, {});
    VSPLIT_TRY(file);
    return file->size();
}

Result<void> run(const char* path)
{
    const auto source = precompute::read_surface(path);
    VSPLIT_TRY(source);
    auto repaired = precompute::repair_surface(source->surface);
    VSPLIT_TRY(repaired);
    Surface alone;
    alone.mesh = std::move(repaired->repaired.mesh);
    Surface complete = alone;
    complete.attributes = repaired->attributes;
    const auto positions = file_bytes(alone);
    VSPLIT_TRY(positions);
    auto rows = nlohmann::json::object();
    for (const SurfaceAttribute& attribute : repaired->attributes)
    {
        Surface one = alone;
        one.attributes.push_back(attribute);
        const auto bytes = file_bytes(one);
        VSPLIT_TRY(bytes);
        rows[name_of(attribute.kind)] = *bytes - *positions;
    }
    const auto all = file_bytes(complete);
    VSPLIT_TRY(all);
    const nlohmann::json report{
        {"vertices", alone.mesh.positions.size()},
        {"faces", alone.mesh.triangles.size()},
        {"positions", *positions},
        {"added", rows},
        {"all", *all}};
    std::printf("%s\n", report.dump().c_str());
    return {};
}

}  // namespace
}  // namespace vsplit::bench

int main(int argc, char** argv)
{
    if (argc != 2)
    {
        std::fprintf(stderr, "usage: bench_attributes MESH\n");
        return 2;
    }
    const auto done = vsplit::bench::run(argv[1]);
    if (!done)
    {
        std::fprintf(stderr, "bench_attributes: %s\n", vsplit::describe(done.error()).c_str());
        return vsplit::exit_status(done.error().code);
    }
    return 0;
}
