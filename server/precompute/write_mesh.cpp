#include "core/byte_writer.h"
#include "core/file_io.h"
#include "precompute/mesh_io.h"
#include "precompute/text_scan.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <new>
#include <string>
#include <string_view>
#include <utility>

namespace vsplit::precompute {
namespace {

void append(ByteWriter& out, std::string_view text)
{
    out.write_bytes(std::as_bytes(std::span(text.data(), text.size())));
}

void write_float(ByteWriter& out, double value)
{
    out.write(std::bit_cast<std::uint32_t>(static_cast<float>(value)));
}

void write_point(ByteWriter& out, const std::array<double, 3>& point)
{
    for (const double coordinate : point)
    {
        write_float(out, coordinate);
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
    append(out, std::string_view(line.data(), static_cast<std::size_t>(length)));
}

std::string three_numbers(const Triangle& triangle, std::uint32_t first)
{
    return std::to_string(triangle[0] + first) + ' ' + std::to_string(triangle[1] + first) + ' ' +
           std::to_string(triangle[2] + first) + '\n';
}

void write_ply(ByteWriter& out, const IndexedMesh& mesh)
{
    append(
        out,
        "ply\nformat binary_little_endian 1.0\ncomment written by vsplit\nelement vertex " +
            std::to_string(mesh.positions.size()) +
            "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
            std::to_string(mesh.triangles.size()) +
            "\nproperty list uchar int vertex_indices\nend_header\n"
    );
    for (const auto& point : mesh.positions)
    {
        write_point(out, point);
    }
    for (const Triangle& triangle : mesh.triangles)
    {
        out.write(std::uint8_t{3});
        for (const std::uint32_t vertex : triangle)
        {
            out.write(vertex);
        }
    }
}

void write_obj(ByteWriter& out, const IndexedMesh& mesh)
{
    append(out, "# written by vsplit\n");
    for (const auto& point : mesh.positions)
    {
        append(out, "v ");
        append_point(out, point);
    }
    for (const Triangle& triangle : mesh.triangles)
    {
        append(out, "f " + three_numbers(triangle, 1));
    }
}

void write_off(ByteWriter& out, const IndexedMesh& mesh)
{
    append(
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
        append(out, "3 " + three_numbers(triangle, 0));
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
    append(out, std::string_view(header.data(), header.size()));
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

using Writer = void (*)(ByteWriter&, const IndexedMesh&);

Writer find_writer(const std::string& extension)
{
    constexpr std::array<std::pair<std::string_view, Writer>, 4> kWriters{{
        {".ply", write_ply},
        {".obj", write_obj},
        {".off", write_off},
        {".stl", write_stl},
    }};
    const auto* const found = std::find_if(kWriters.begin(), kWriters.end(), [&](const auto& row) {
        return row.first == extension;
    });
    return found == kWriters.end() ? nullptr : found->second;
}

}  // namespace

Result<void> write_mesh(const std::filesystem::path& path, const IndexedMesh& mesh)
{
    const Writer writer = find_writer(lower_case(path.extension().string()));
    if (writer == nullptr)
    {
        return fail(
            ErrorCode::UnsupportedInput,
            "cannot write " + path.string() + ": the extension is none of .ply, .obj, .off and .stl"
        );
    }
    try
    {
        ByteWriter out;
        writer(out, mesh);
        return write_file_atomically(path, out.view());
    }
    catch (const std::bad_alloc&)
    {
        return fail(
            ErrorCode::IoError, "cannot write " + path.string() + ": there is not enough memory"
        );
    }
}

}  // namespace vsplit::precompute
