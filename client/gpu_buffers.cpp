// Based on: Gouraud, "Continuous Shading of Curved Surfaces", 1971 (normals as a sum over the
// triangles around a vertex). We depart in two ways: a triangle weighs the square root of its
// area, so that slivers do not rule and a few large triangles do not drown the rest, and the sum
// is kept in integers, so that it can be updated for ever without drift.
#include "gpu_buffers.h"

#include "core/assert.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vsplit::client {
namespace {

constexpr std::uint32_t kVertexPage = 64;     // 1.75 KiB
constexpr std::uint32_t kTrianglePage = 128;  // 1.5 KiB
constexpr std::uint32_t kCopyBlock = 256;

// A triangle's weight is at most sqrt(diagonal^2) = 1, so 2^22 leaves room for 500 such triangles
// around one vertex in 32 bits; the tiniest triangle of a million still has three good digits.
constexpr double kNormalScale = 1 << 22;
constexpr double kMostWeight = 2.0 * kNormalScale;

// The sum may wrap when a hostile mesh piles thousands of huge triangles on one vertex. Unsigned
// arithmetic makes that harmless, and taking them away again still restores the old value.
std::int32_t add_wrapping(std::int32_t a, std::int32_t b)
{
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
}

// Rounds half away from zero, so that what is taken away is exactly what was added.
std::int32_t to_integer(double value)
{
    return static_cast<std::int32_t>(std::lround(value));
}

using Vector = std::array<double, 3>;

Vector difference(const std::array<float, 3>& a, const std::array<float, 3>& b)
{
    return {double{a[0]} - b[0], double{a[1]} - b[1], double{a[2]} - b[2]};
}

}  // namespace

GpuBuffers::GpuBuffers(double diagonal)
    : to_unit_(diagonal > 0.0 ? 1.0 / diagonal : 1.0),
      dirty_vertices_(kVertexPage),
      dirty_triangles_(kTrianglePage)
{
}

void GpuBuffers::reserve(std::uint32_t vertices, std::uint32_t faces)
{
    vertices_.reserve(vertices);
    triangles_.reserve(faces);
    dirty_vertices_.reserve(vertices);
    dirty_triangles_.reserve(faces);
}

void GpuBuffers::apply(
    const codec::Step& step, const PositionSource& positions, const TriangleSource& triangles
)
{
    VSPLIT_ASSERT(step.vertices >= vertices_.size() && step.faces >= triangles_.size());
    const auto known = static_cast<std::uint32_t>(vertices_.size());
    const std::uint32_t first_moved = std::min(known, step.first_moved_vertex);
    vertices_.resize(step.vertices);
    triangles_.resize(step.faces);
    if (step.triangles_replaced)
    {
        write_positions(first_moved, step.vertices, positions);
        triangles(triangles_);
        dirty_triangles_.mark_range(0, step.faces);
        rebuild_normals();
        return;
    }
    if (first_moved < known)
    {
        write_positions(first_moved, step.vertices, positions);
        for (const codec::TriangleUpdate& update : step.triangles)
        {
            triangles_[update.slot] = update.vertices;
            dirty_triangles_.mark(update.slot);
        }
        rebuild_normals();
        return;
    }
    write_positions(known, step.vertices, positions);
    for (const codec::TriangleUpdate& update : step.triangles)
    {
        replace_triangle(update);
    }
}

void GpuBuffers::write_positions(
    std::uint32_t first, std::uint32_t end, const PositionSource& positions
)
{
    std::array<float, 3 * kCopyBlock> block{};
    for (std::uint32_t begin = first; begin < end; begin += kCopyBlock)
    {
        const std::uint32_t count = std::min(kCopyBlock, end - begin);
        positions(begin, count, block);
        for (std::uint32_t i = 0; i < count; ++i)
        {
            vertices_[begin + i].position = {block[3 * i], block[3 * i + 1], block[3 * i + 2]};
        }
    }
    dirty_vertices_.mark_range(first, end);
}

void GpuBuffers::add_normal(const Triangle& triangle, bool add)
{
    const auto& origin = vertices_[triangle[0]].position;
    const Vector a = difference(vertices_[triangle[1]].position, origin);
    const Vector b = difference(vertices_[triangle[2]].position, origin);
    const Vector cross{
        a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    const double twice_area =
        std::sqrt(cross[0] * cross[0] + cross[1] * cross[1] + cross[2] * cross[2]);
    const double weight = std::sqrt(twice_area) * to_unit_ * kNormalScale;
    if (!(twice_area > 0.0) || !(weight <= kMostWeight))
    {
        return;
    }
    const double sign = add ? 1.0 : -1.0;
    std::array<std::int32_t, 4> share{};
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        share[axis] = to_integer(sign * weight * (cross[axis] / twice_area));
    }
    share[3] = to_integer(sign * weight);
    for (const std::uint32_t vertex : triangle)
    {
        GpuVertex& sum = vertices_[vertex];
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            sum.normal[axis] = add_wrapping(sum.normal[axis], share[axis]);
        }
        sum.weight = add_wrapping(sum.weight, share[3]);
        dirty_vertices_.mark(vertex);
    }
}

void GpuBuffers::replace_triangle(const codec::TriangleUpdate& update)
{
    Triangle& triangle = triangles_[update.slot];
    add_normal(triangle, false);  // A slot that is new holds {0, 0, 0}, which weighs nothing.
    triangle = update.vertices;
    add_normal(triangle, true);
    dirty_triangles_.mark(update.slot);
}

void GpuBuffers::rebuild_normals()
{
    for (GpuVertex& vertex : vertices_)
    {
        vertex.normal = {};
        vertex.weight = 0;
    }
    for (const Triangle& triangle : triangles_)
    {
        add_normal(triangle, true);
    }
    dirty_vertices_.mark_range(0, static_cast<std::uint32_t>(vertices_.size()));
}

std::vector<ElementRange> GpuBuffers::take_dirty_vertices()
{
    return dirty_vertices_.take(static_cast<std::uint32_t>(vertices_.size()));
}

std::vector<ElementRange> GpuBuffers::take_dirty_triangles()
{
    return dirty_triangles_.take(static_cast<std::uint32_t>(triangles_.size()));
}

std::uint64_t GpuBuffers::memory_bytes(std::uint64_t vertices, std::uint64_t faces, bool wireframe)
{
    // Two copies (here and on the GPU), page lists (at most 5 bytes a page), three lines a triangle.
    const std::uint64_t arrays = 2 * (vertices * sizeof(GpuVertex) + faces * sizeof(Triangle));
    const std::uint64_t pages = 5 * (vertices / kVertexPage + faces / kTrianglePage + 2);
    return arrays + pages + (wireframe ? 2 * faces * sizeof(Triangle) : 0);
}

}  // namespace vsplit::client
