#include "precompute/mesh_builder.h"

#include "format.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace vsplit::precompute {

bool is_position(const std::array<double, 3>& point)
{
    constexpr double kLargest = std::numeric_limits<float>::max();
    return std::all_of(point.begin(), point.end(), [](double coordinate) {
        return std::abs(coordinate) <= kLargest;  // false for NaN
    });
}

tl::unexpected<Error> bad_position(std::size_t vertex)
{
    return fail(
        ErrorCode::BadCoordinate,
        "vertex " + std::to_string(vertex) +
            " has a coordinate that is not finite or beyond single precision"
    );
}

void MeshBuilder::reserve(std::size_t vertices, std::size_t triangles)
{
    mesh_.positions.reserve(std::min<std::size_t>(vertices, proto::kMaxVertices));
    mesh_.triangles.reserve(std::min<std::size_t>(triangles, proto::kMaxFaces));
}

Result<void> MeshBuilder::add_vertex(const std::array<double, 3>& point)
{
    if (!is_position(point))
    {
        return bad_position(vertex_count());
    }
    if (mesh_.positions.size() >= proto::kMaxVertices)
    {
        return fail(
            ErrorCode::InputTooLarge,
            "more than " + std::to_string(proto::kMaxVertices) + " vertices"
        );
    }
    mesh_.positions.push_back(point);
    return {};
}

Result<void> MeshBuilder::add_polygon(std::span<const std::int64_t> corners)
{
    return for_each_fan_triangle(corners.size(), [&](std::size_t i, std::size_t j, std::size_t k) {
        return add_triangle(corners[i], corners[j], corners[k]);
    });
}

Result<void> MeshBuilder::add_strip(std::span<const std::int64_t> corners)
{
    std::size_t start = 0;
    for (std::size_t i = 0; i < corners.size(); ++i)
    {
        if (corners[i] == -1)
        {
            start = i + 1;
            continue;
        }
        if (i < start + 2)
        {
            continue;
        }
        const bool odd = (i - start) % 2 != 0;
        const std::int64_t a = corners[i - (odd ? 1 : 2)];
        const std::int64_t b = corners[i - (odd ? 2 : 1)];
        const std::int64_t c = corners[i];
        if (a != b && b != c && c != a)
        {
            VSPLIT_TRY(add_triangle(a, b, c));
        }
    }
    return {};
}

Result<void> MeshBuilder::add_triangle(std::int64_t a, std::int64_t b, std::int64_t c)
{
    const std::int64_t low = std::min({a, b, c});
    const std::int64_t high = std::max({a, b, c});
    if (low < 0 || high >= proto::kMaxVertices)
    {
        return fail(
            ErrorCode::BadIndex,
            "face " + std::to_string(mesh_.triangles.size()) + " refers to vertex " +
                std::to_string(low < 0 ? low : high)
        );
    }
    if (mesh_.triangles.size() >= proto::kMaxFaces)
    {
        return fail(
            ErrorCode::InputTooLarge, "more than " + std::to_string(proto::kMaxFaces) + " triangles"
        );
    }
    mesh_.triangles.push_back(
        {static_cast<std::uint32_t>(a),
         static_cast<std::uint32_t>(b),
         static_cast<std::uint32_t>(c)}
    );
    return {};
}

Result<IndexedMesh> MeshBuilder::finish()
{
    const std::size_t count = vertex_count();
    if (count == 0)
    {
        return fail(ErrorCode::NotAMesh, "it holds no vertex");
    }
    for (const Triangle& triangle : mesh_.triangles)
    {
        const std::uint32_t high = std::max({triangle[0], triangle[1], triangle[2]});
        if (high >= count)
        {
            return fail(
                ErrorCode::BadIndex,
                "a face refers to vertex " + std::to_string(high) + " (from 0) but there are " +
                    std::to_string(count)
            );
        }
    }
    if (mesh_.triangles.empty())
    {
        return fail(ErrorCode::EmptyMesh, "it holds vertices but no face");
    }
    return std::exchange(mesh_, {});
}

}  // namespace vsplit::precompute
