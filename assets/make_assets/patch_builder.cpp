// Based on: Meisters, "Polygons Have Ears", 1975; Lawson, "Software for C1 Surface Interpolation", 1977.
#include "make_assets/patch_builder.h"

#include "make_assets/editable_mesh.h"

#include <algorithm>
#include <cmath>

namespace vsplit::assets {

namespace {

Vector3 mix(const Vector3& a, const Vector3& b, double t)
{
    return a * (1.0 - t) + b * t;
}

// Twice the area over the square of the longest side, negative if the triangle is clockwise.
double quality(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& normal)
{
    const double longest = std::max({length(b - a), length(c - b), length(a - c)});
    return dot(cross(b - a, c - a), normal) / (longest * longest);
}

// True when the point lies in the triangle; its corners do not count, for a bridge visits them twice.
bool contains(const std::array<Vector3, 3>& triangle, const Vector3& point, const Vector3& normal)
{
    for (std::size_t i = 0; i < 3; ++i)
    {
        if (length(point - triangle[i]) < 1e-9)
        {
            return false;
        }
    }
    for (std::size_t i = 0; i < 3; ++i)
    {
        const Vector3 side = triangle[(i + 1) % 3] - triangle[i];
        if (dot(cross(side, point - triangle[i]), normal) < -1e-9)
        {
            return false;
        }
    }
    return true;
}

// One loop round a polygon with a hole: there and back over the shortest bridge between them.
Polyline bridged(const Polyline& loop, const Polyline& hole)
{
    std::size_t from = 0, to = 0;
    for (std::size_t i = 0; i < loop.size(); ++i)
    {
        for (std::size_t j = 0; j < hole.size(); ++j)
        {
            if (length(loop[i] - hole[j]) < length(loop[from] - hole[to]))
            {
                from = i;
                to = j;
            }
        }
    }
    Polyline result;
    for (std::size_t i = 0; i <= loop.size(); ++i)
    {
        result.push_back(loop[(from + i) % loop.size()]);
    }
    for (std::size_t j = 0; j <= hole.size(); ++j)
    {
        result.push_back(hole[(to + hole.size() - j) % hole.size()]);
    }
    return result;
}

}  // namespace

void line_to(Polyline& line, const Vector3& end, int steps)
{
    const Vector3 start = line.back();
    for (int i = 1; i <= steps; ++i)
    {
        line.push_back(mix(start, end, static_cast<double>(i) / steps));
    }
}

void arc_to(Polyline& line, const Vector3& centre, const Vector3& end, int halvings)
{
    if (halvings == 0)
    {
        line.push_back(end);
        return;
    }
    // Halving angles needs square roots only.
    const Vector3 start = line.back();
    const double radius = length(end - centre);
    const Vector3 middle = centre + unit((start - centre) + (end - centre)) * radius;
    arc_to(line, centre, middle, halvings - 1);
    arc_to(line, centre, end, halvings - 1);
}

Polyline circle(
    const Vector3& centre, const Vector3& u, const Vector3& v, double radius, int halvings
)
{
    Polyline loop{centre + u * radius};
    arc_to(loop, centre, centre + v * radius, halvings);
    arc_to(loop, centre, centre - u * radius, halvings);
    arc_to(loop, centre, centre - v * radius, halvings);
    arc_to(loop, centre, centre + u * radius, halvings);
    loop.pop_back();
    return loop;
}

std::uint32_t PatchBuilder::vertex(const Vector3& point)
{
    constexpr double kPerUnit = 1e5;
    const std::array<std::int64_t, 3> key{
        std::llround(point.x * kPerUnit),
        std::llround(point.y * kPerUnit),
        std::llround(point.z * kPerUnit)};
    const auto [place, is_new] =
        vertices_.try_emplace(key, static_cast<std::uint32_t>(mesh_.positions.size()));
    if (is_new)
    {
        mesh_.positions.push_back(to_array(point));
    }
    return place->second;
}

void PatchBuilder::add_triangle(const Vector3& a, const Vector3& b, const Vector3& c)
{
    const std::uint32_t first = vertex(a), second = vertex(b);
    mesh_.triangles.push_back({first, second, vertex(c)});
}

void PatchBuilder::fill_band(const Polyline& outer, const Polyline& inner, int rows)
{
    Polyline right = outer, left = inner;
    right.push_back(outer.front());
    left.push_back(inner.front());
    fill_strip(right, left, rows);
}

void PatchBuilder::fill_strip(const Polyline& right, const Polyline& left, int rows)
{
    for (int row = 0; row < rows; ++row)
    {
        const double near = static_cast<double>(row) / rows;
        const double far = static_cast<double>(row + 1) / rows;
        for (std::size_t i = 0; i + 1 < right.size(); ++i)
        {
            const Vector3 a = mix(right[i], left[i], near);
            const Vector3 b = mix(right[i + 1], left[i + 1], near);
            const Vector3 c = mix(right[i + 1], left[i + 1], far);
            const Vector3 d = mix(right[i], left[i], far);
            add_triangle(a, b, c);
            add_triangle(a, c, d);
        }
    }
}

void PatchBuilder::fill_polygon(const Polyline& loop, const Vector3& normal, const Polyline& hole)
{
    Polyline rest = hole.empty() ? loop : bridged(loop, hole);
    while (rest.size() > 2)
    {
        const std::size_t count = rest.size();
        std::size_t best = 0;
        double best_quality = -1.0;
        for (std::size_t i = 0; i < count; ++i)
        {
            const std::array<Vector3, 3> ear{
                rest[(i + count - 1) % count], rest[i], rest[(i + 1) % count]};
            const double ear_quality = quality(ear[0], ear[1], ear[2], normal);
            bool is_empty = ear_quality > best_quality;
            for (std::size_t k = i + 2; is_empty && k + 1 < i + count; ++k)
            {
                is_empty = !contains(ear, rest[k % count], normal);
            }
            if (is_empty)
            {
                best = i;
                best_quality = ear_quality;
            }
        }
        add_triangle(rest[(best + count - 1) % count], rest[best], rest[(best + 1) % count]);
        rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(best));
    }
}

void PatchBuilder::add_mirror_image()
{
    const auto mirrored = [this](std::uint32_t index) {
        const Vector3 point = to_vector(mesh_.positions[index]);
        return Vector3{point.x, point.y, -point.z};
    };
    const std::size_t count = mesh_.triangles.size();
    for (std::size_t i = 0; i < count; ++i)
    {
        const auto [a, b, c] = mesh_.triangles[i];
        add_triangle(mirrored(a), mirrored(c), mirrored(b));
    }
}

IndexedMesh flip_flat_edges(const IndexedMesh& mesh)
{
    EditableMesh editable(mesh);
    const auto shape = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, const Vector3& up) {
        return quality(editable.position(a), editable.position(b), editable.position(c), up);
    };
    constexpr int kMostSweeps = 30;
    bool is_changed = true;
    for (int sweep = 0; sweep < kMostSweeps && is_changed; ++sweep)
    {
        is_changed = false;
        for (const EditableMesh::Edge& edge : editable.edges())
        {
            EditableMesh::Edge sides;
            if (!editable.opposite(edge, sides))
            {
                continue;
            }
            const auto [a, b] = edge;
            const auto [c, d] = sides;
            const Vector3 corner = editable.position(a);
            const Vector3 side = editable.position(b) - corner;
            const Vector3 left = unit(cross(side, editable.position(c) - corner));
            const Vector3 right = unit(cross(editable.position(d) - corner, side));
            const double now = std::min(shape(a, b, c, left), shape(b, a, d, left));
            const double then = std::min(shape(a, d, c, left), shape(b, c, d, left));
            if (dot(left, right) > 1.0 - 1e-9 && then > now + 1e-6)
            {
                is_changed = editable.flip(edge) || is_changed;
            }
        }
    }
    return editable.compact();
}

}  // namespace vsplit::assets
