// Bytes of Draco's file of a mesh alone, with each of its attributes, and with all of them; the meshes with
// one attribute each as files, for vsplit to encode.
#include "draco_surface.h"
#include "precompute/repair_surface.h"
#include "precompute/surface_io.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace vsplit::bench {
namespace {

struct Arguments
{
    std::string mesh;
    std::string folder;
};

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

void write_attributed_obj(std::ostream& file, const Surface& surface)
{
    for (const auto& [x, y, z] : surface.mesh.positions)
    {
        file << "v " << x << ' ' << y << ' ' << z << '\n';
    }
    const char* separator = "";
    if (!surface.attributes.empty())
    {
        const SurfaceAttribute& attribute = surface.attributes[0];
        const bool normal = attribute.kind == AttributeKind::Normal;
        separator = normal ? "//" : "/";
        for (std::size_t i = 0; i < attribute.values.size(); i += attribute.components)
        {
            file << (normal ? "vn" : "vt");
            for (std::size_t k = 0; k < attribute.components; ++k)
            {
                // OBJ counts from the lower left corner.
                const float value = attribute.values[i + k];
                file << ' ' << (!normal && k == 1 ? 1.0 - value : double{value});
            }
            file << '\n';
        }
    }
    for (std::size_t f = 0; f < surface.mesh.triangles.size(); ++f)
    {
        file << 'f';
        for (std::size_t k = 0; k < 3; ++k)
        {
            file << ' ' << surface.mesh.triangles[f][k] + 1 << separator;
            if (!surface.attributes.empty())
            {
                file << surface.attributes[0].corners[f][k] + 1;
            }
        }
        file << '\n';
    }
}

/// For colours that a vertex has one of.
void write_colored_ply(std::ostream& file, const Surface& surface)
{
    const SurfaceAttribute& colors = surface.attributes[0];
    std::vector<std::uint32_t> of_vertex(surface.mesh.positions.size(), 0);
    for (std::size_t f = 0; f < surface.mesh.triangles.size(); ++f)
    {
        for (std::size_t k = 0; k < 3; ++k)
        {
            of_vertex[surface.mesh.triangles[f][k]] = colors.corners[f][k];
        }
    }
    file << "ply\nformat ascii 1.0\nelement vertex " << of_vertex.size()
         << "\nproperty double x\nproperty double y\nproperty double z\nproperty uchar red\n"
            "property uchar green\nproperty uchar blue\nelement face "
         << surface.mesh.triangles.size()
         << "\nproperty list uchar int vertex_indices\nend_header\n";
    for (std::size_t v = 0; v < of_vertex.size(); ++v)
    {
        const auto& [x, y, z] = surface.mesh.positions[v];
        file << x << ' ' << y << ' ' << z;
        for (std::size_t k = 0; k < 3; ++k)
        {
            file << ' '
                 << std::lround(255.0F * colors.values[of_vertex[v] * colors.components + k]);
        }
        file << '\n';
    }
    for (const auto& [a, b, c] : surface.mesh.triangles)
    {
        file << "3 " << a << ' ' << b << ' ' << c << '\n';
    }
}

/// Writes a mesh with what lies on it: colours as PLY, everything else as OBJ.
Result<void> write_alone(const std::string& folder, const std::string& name, const Surface& surface)
{
    const bool colored =
        !surface.attributes.empty() && surface.attributes[0].kind == AttributeKind::Color;
    std::ofstream file(folder + "/" + name + (colored ? ".ply" : ".obj"));
    file.precision(17);
    colored ? write_colored_ply(file, surface) : write_attributed_obj(file, surface);
    file.close();
    return file ? Result<void>() : fail(ErrorCode::IoError, "cannot write to " + folder);
}

Result<void> run(const Arguments& arguments)
{
    const auto source = precompute::read_surface(arguments.mesh);
    VSPLIT_TRY(source);
    auto repaired = precompute::repair_surface(source->surface);
    VSPLIT_TRY(repaired);
    Surface alone;
    alone.mesh = std::move(repaired->repaired.mesh);
    Surface complete = alone;
    complete.attributes = repaired->attributes;
    const auto positions = file_bytes(alone);
    VSPLIT_TRY(positions);
    VSPLIT_TRY(write_alone(arguments.folder, "positions", alone));
    auto rows = nlohmann::json::object();
    for (const SurfaceAttribute& attribute : repaired->attributes)
    {
        Surface one = alone;
        one.attributes.push_back(attribute);
        const auto bytes = file_bytes(one);
        VSPLIT_TRY(bytes);
        rows[name_of(attribute.kind)] = *bytes - *positions;
        VSPLIT_TRY(write_alone(arguments.folder, name_of(attribute.kind), one));
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
    vsplit::bench::Arguments arguments;
    CLI::App app("Measures what attributes add to a Draco file, and writes the mesh with each alone"
    );
    app.add_option("MESH", arguments.mesh, "The original")->required();
    app.add_option("FOLDER", arguments.folder, "Where to put the meshes")->required();
    CLI11_PARSE(app, argc, argv);
    const auto done = vsplit::bench::run(arguments);
    if (!done)
    {
        std::fprintf(stderr, "bench_attributes: %s\n", vsplit::describe(done.error()).c_str());
        return vsplit::exit_status(done.error().code);
    }
    return 0;
}
