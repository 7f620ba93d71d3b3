#include "surface_reader.h"

#include "core/file_io.h"
#include "precompute/repair.h"

#include <array>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>

namespace vsplit::bench {
namespace {

SurfaceAttribute make_attribute(AttributeKind kind)
{
    SurfaceAttribute attribute;
    attribute.kind = kind;
    attribute.components = kind == AttributeKind::TexCoord ? 2 : 3;
    return attribute;
}

/// Reads "12/3/4", "12//4" or "12"; absent numbers are 0.
std::array<std::uint32_t, 3> read_corner(const std::string& word)
{
    std::array<std::uint32_t, 3> numbers{};
    std::size_t field = 0;
    for (const char letter : word)
    {
        if (letter == '/')
        {
            ++field;
            continue;
        }
        numbers[field] = 10 * numbers[field] + static_cast<std::uint32_t>(letter - '0');
    }
    return numbers;
}

void read_values(std::istream& line, std::size_t count, std::vector<float>& values)
{
    for (std::size_t k = 0; k < count; ++k)
    {
        float value = 0.0F;
        line >> value;
        values.push_back(value);
    }
}

void read_face(std::istream& line, std::array<std::vector<Triangle>, 3>& corners)
{
    std::array<Triangle, 3> face{};
    std::string word;
    for (std::size_t corner = 0; corner < 3 && line >> word; ++corner)
    {
        const auto numbers = read_corner(word);
        for (std::size_t k = 0; k < 3; ++k)
        {
            face[k][corner] = numbers[k] - 1;
        }
    }
    for (std::size_t k = 0; k < 3; ++k)
    {
        corners[k].push_back(face[k]);
    }
}

Result<Surface> read_obj(const std::filesystem::path& path)
{
    std::ifstream file(path);
    SurfaceAttribute coordinates = make_attribute(AttributeKind::TexCoord);
    SurfaceAttribute normals = make_attribute(AttributeKind::Normal);
    std::array<std::vector<Triangle>, 3> corners;
    Surface surface;
    for (std::string text; std::getline(file, text);)
    {
        std::istringstream line(text);
        std::string word;
        line >> word;
        if (word == "v")
        {
            auto& position = surface.mesh.positions.emplace_back();
            line >> position[0] >> position[1] >> position[2];
        }
        else if (word == "vt")
        {
            read_values(line, 2, coordinates.values);
            coordinates.values.back() = 1.0F - coordinates.values.back();
        }
        else if (word == "vn")
        {
            read_values(line, 3, normals.values);
        }
        else if (word == "f")
        {
            read_face(line, corners);
        }
    }
    surface.mesh.triangles = std::move(corners[0]);
    coordinates.corners = std::move(corners[1]);
    normals.corners = std::move(corners[2]);
    for (SurfaceAttribute* attribute : {&coordinates, &normals})
    {
        if (!attribute->values.empty())
        {
            surface.attributes.push_back(std::move(*attribute));
        }
    }
    return surface;
}

struct PlyPlan
{
    std::size_t vertices = 0;
    std::size_t faces = 0;
    bool normals = false;
    bool colors = false;
};

PlyPlan read_ply_header(std::istream& file)
{
    PlyPlan plan;
    for (std::string line; std::getline(file, line) && line != "end_header";)
    {
        std::istringstream words(line);
        std::string first, second, third;
        words >> first >> second >> third;
        if (first == "element")
        {
            (second == "vertex" ? plan.vertices : plan.faces) = std::stoul(third);
        }
        plan.normals = plan.normals || third == "nx";
        plan.colors = plan.colors || third == "red";
    }
    return plan;
}

template <typename Value>
Value take(std::istream& file)
{
    std::array<char, sizeof(Value)> bytes{};
    file.read(bytes.data(), bytes.size());
    Value value{};
    std::memcpy(&value, bytes.data(), sizeof value);
    return value;
}

Result<Surface> read_ply(const std::filesystem::path& path)
{
    std::ifstream file(path, std::ios::binary);
    const PlyPlan plan = read_ply_header(file);
    SurfaceAttribute normals = make_attribute(AttributeKind::Normal);
    SurfaceAttribute colors = make_attribute(AttributeKind::Color);
    Surface surface;
    for (std::size_t v = 0; v < plan.vertices; ++v)
    {
        auto& position = surface.mesh.positions.emplace_back();
        for (double& coordinate : position)
        {
            coordinate = take<float>(file);
        }
        for (int k = 0; plan.normals && k < 3; ++k)
        {
            normals.values.push_back(take<float>(file));
        }
        for (int k = 0; plan.colors && k < 3; ++k)
        {
            colors.values.push_back(static_cast<float>(take<std::uint8_t>(file)) / 255.0F);
        }
    }
    for (std::size_t f = 0; f < plan.faces && file; ++f)
    {
        if (take<std::uint8_t>(file) != 3)
        {
            return fail(ErrorCode::NotAMesh, "a face is no triangle");
        }
        Triangle& triangle = surface.mesh.triangles.emplace_back();
        for (std::uint32_t& vertex : triangle)
        {
            vertex = take<std::uint32_t>(file);
        }
    }
    for (SurfaceAttribute* attribute : {&normals, &colors})
    {
        if (!attribute->values.empty())
        {
            attribute->corners = surface.mesh.triangles;
            surface.attributes.push_back(std::move(*attribute));
        }
    }
    return surface;
}

/// For each corner of `repaired` the corner of `source` at the same place; none when one is missing.
std::optional<std::array<std::size_t, 3>> match_corners(
    const IndexedMesh& source_mesh,
    const Triangle& source,
    const IndexedMesh& repaired_mesh,
    const Triangle& repaired
)
{
    std::array<std::size_t, 3> matches{};
    for (std::size_t k = 0; k < 3; ++k)
    {
        const auto& place = repaired_mesh.positions[repaired[k]];
        while (matches[k] < 3 && source_mesh.positions[source[matches[k]]] != place)
        {
            ++matches[k];
        }
        if (matches[k] == 3)
        {
            return std::nullopt;
        }
    }
    return matches;
}

}  // namespace

Result<Surface> read_bench_surface(const std::filesystem::path& path)
{
    return path.extension() == ".obj" ? read_obj(path) : read_ply(path);
}

Result<Surface> repair_surface(const Surface& source)
{
    auto repaired = precompute::repair_mesh(source.mesh);
    VSPLIT_TRY(repaired);
    Surface result;
    result.mesh = std::move(repaired->mesh);
    result.attributes = source.attributes;
    for (SurfaceAttribute& attribute : result.attributes)
    {
        attribute.corners.clear();
    }
    std::size_t f = 0;  // triangles keep their order
    for (const Triangle& triangle : result.mesh.triangles)
    {
        auto matches = match_corners(source.mesh, source.mesh.triangles[f], result.mesh, triangle);
        while (!matches && ++f < source.mesh.triangles.size())
        {
            matches = match_corners(source.mesh, source.mesh.triangles[f], result.mesh, triangle);
        }
        if (!matches)
        {
            return fail(ErrorCode::Internal, "a repaired triangle is not of the source");
        }
        for (std::size_t a = 0; a < source.attributes.size(); ++a)
        {
            const Triangle& corners = source.attributes[a].corners[f];
            result.attributes[a].corners.push_back(
                {corners[(*matches)[0]], corners[(*matches)[1]], corners[(*matches)[2]]}
            );
        }
        ++f;
    }
    return result;
}

}  // namespace vsplit::bench
