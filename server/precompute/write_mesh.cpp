#include "core/byte_writer.h"
#include "core/file_io.h"
#include "precompute/mesh_io.h"
#include "precompute/model_writers.h"
#include "precompute/surface_io.h"
#include "precompute/text_scan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <new>
#include <string>
#include <string_view>
#include <utility>

namespace vsplit::precompute {
namespace {

void write_point(ByteWriter& out, const std::array<double, 3>& point)
{
    for (const double coordinate : point)
    {
        append_float(out, coordinate);
    }
}

/// Appends "x y z" with the nine digits that bring every float back exactly.
void append_point(ByteWriter& out, const std::array<double, 3>& point)
{
    std::array<char, 64> line{};
    const int length = std::snprintf(
        line.data(),
        line.size(),
        "%.9g %.9g %.9g\n",
        static_cast<double>(static_cast<float>(point[0])),
        static_cast<double>(static_cast<float>(point[1])),
        static_cast<double>(static_cast<float>(point[2]))
    );
    append_text(out, std::string_view(line.data(), static_cast<std::size_t>(length)));
}

std::string three_numbers(const Triangle& triangle, std::uint32_t first)
{
    return std::to_string(triangle[0] + first) + ' ' + std::to_string(triangle[1] + first) + ' ' +
           std::to_string(triangle[2] + first) + '\n';
}

void write_off(ByteWriter& out, const IndexedMesh& mesh)
{
    append_text(
        out,
        "OFF\n" + std::to_string(mesh.positions.size()) + ' ' +
            std::to_string(mesh.triangles.size()) + " 0\n"
    );
    for (const auto& point : mesh.positions)
    {
        append_point(out, point);
    }
    for (const Triangle& triangle : mesh.triangles)
    {
        append_text(out, "3 " + three_numbers(triangle, 0));
    }
}

std::array<double, 3> unit_normal(const IndexedMesh& mesh, const Triangle& triangle)
{
    const auto& a = mesh.positions[triangle[0]];
    const auto& b = mesh.positions[triangle[1]];
    const auto& c = mesh.positions[triangle[2]];
    const std::array<double, 3> u{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    const std::array<double, 3> v{c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    std::array<double, 3> normal{
        u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    const double length = std::hypot(normal[0], normal[1], normal[2]);
    for (double& component : normal)
    {
        component = length > 0.0 ? component / length : 0.0;
    }
    return normal;
}

void write_stl(ByteWriter& out, const IndexedMesh& mesh)
{
    std::array<char, 80> header{};
    constexpr std::string_view kTitle = "binary STL written by vsplit";
    std::copy(kTitle.begin(), kTitle.end(), header.begin());
    append_text(out, std::string_view(header.data(), header.size()));
    out.write(static_cast<std::uint32_t>(mesh.triangles.size()));
    for (const Triangle& triangle : mesh.triangles)
    {
        write_point(out, unit_normal(mesh, triangle));
        for (const std::uint32_t vertex : triangle)
        {
            write_point(out, mesh.positions[vertex]);
        }
        out.write(std::uint16_t{0});
    }
}

template <void (*writer)(ByteWriter&, const IndexedMesh&)>
Result<WrittenFiles> format_bare(const ModelView& model, const std::string& /*stem*/)
{
    ByteWriter out;
    writer(out, model.mesh);
    WrittenFiles files;
    files.push_back({"", out.take()});
    return files;
}

using Format = Result<WrittenFiles> (*)(const ModelView&, const std::string&);

Format find_format(const std::string& extension)
{
    constexpr std::array<std::pair<std::string_view, Format>, 5> kFormats{{
        {".ply",
         [](const ModelView& model, const std::string& stem) -> Result<WrittenFiles> {
             return format_ply(model, stem);
         }},
        {".obj",
         [](const ModelView& model, const std::string& stem) -> Result<WrittenFiles> {
             return format_obj(model, stem);
         }},
        {".glb", [](const ModelView& model, const std::string&) { return format_glb(model); }},
        {".off", format_bare<write_off>},
        {".stl", format_bare<write_stl>},
    }};
    const auto* const found = std::find_if(kFormats.begin(), kFormats.end(), [&](const auto& row) {
        return row.first == extension;
    });
    return found == kFormats.end() ? nullptr : found->second;
}

/// Writes the files beside the model first: when it appears, it is complete.
Result<void> write_files(const std::filesystem::path& path, const WrittenFiles& files)
{
    for (auto file = files.rbegin(); file != files.rend(); ++file)
    {
        const auto target = file->name.empty() ? path : path.parent_path() / file->name;
        VSPLIT_TRY(write_file_atomically(target, file->bytes));
    }
    return {};
}

}  // namespace

Result<void> write_surface(const std::filesystem::path& path, const ModelView& model)
{
    const Format format = find_format(lower_case(path.extension().string()));
    const std::string start = "cannot write " + path.string() + ": ";
    if (format == nullptr)
    {
        return fail(
            ErrorCode::UnsupportedInput,
            start + "the extension is none of .glb, .ply, .obj, .off and .stl"
        );
    }
    try
    {
        const auto files = format(model, path.stem().string());
        if (!files)
        {
            const auto& [code, message, offset] = files.error();
            return fail(code, start + message, offset);
        }
        return write_files(path, *files);
    }
    catch (const std::bad_alloc&)
    {
        return fail(ErrorCode::IoError, start + "there is not enough memory");
    }
}

Result<void> write_mesh(const std::filesystem::path& path, const IndexedMesh& mesh)
{
    return write_surface(path, {mesh});
}

}  // namespace vsplit::precompute
