// Based on: Gouraud, "Continuous Shading of Curved Surfaces", 1971; weights as in gpu_buffers.cpp.
#include "surface_arrays.h"

#include "draw_ranges.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace vsplit::client {
namespace {

constexpr float kFullNormal = 32767.0F;
// A wedge whose triangles lean less than 30 degrees from all around its vertex lies on a smooth
// surface: the seam beside it is one of the texture.
constexpr float kSmoothCosine = 0.866F;

using Vector = std::array<float, 3>;

// Sum of weighted normals, and of the weights.
using NormalSum = std::array<float, 4>;

Vector minus(const Vector& a, const Vector& b)
{
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

float length(const NormalSum& sum)
{
    return std::sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
}

NormalSum weighted_normal(const Vector& a, const Vector& b, const Vector& c)
{
    const Vector u = minus(b, a);
    const Vector v = minus(c, a);
    NormalSum sum{
        u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0], 0.0F};
    const float twice_area = length(sum);
    if (!(twice_area > 0.0F) || !std::isfinite(twice_area))
    {
        return {};
    }
    sum[3] = std::sqrt(twice_area);
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        sum[axis] *= sum[3] / twice_area;
    }
    return sum;
}

void add(NormalSum& to, const NormalSum& what)
{
    for (std::size_t i = 0; i < to.size(); ++i)
    {
        to[i] += what[i];
    }
}

std::int16_t to_short(float value)
{
    return std::isfinite(value)
               ? static_cast<std::int16_t>(std::lround(std::clamp(value, -1.0F, 1.0F) * kFullNormal)
                 )
               : std::int16_t{0};
}

std::array<std::int16_t, 4> stored(const Vector& normal)
{
    return {to_short(normal[0]), to_short(normal[1]), to_short(normal[2]), to_short(1.0F)};
}

// Divided by the sum of weights the length is the flatness.
std::array<std::int16_t, 4> stored(const NormalSum& sum)
{
    const float scale = sum[3] > 0.0F ? 1.0F / sum[3] : 0.0F;
    return stored(Vector{sum[0] * scale, sum[1] * scale, sum[2] * scale});
}

bool leans_little(const NormalSum& a, const NormalSum& b)
{
    const float dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    return dot >= kSmoothCosine * length(a) * length(b);
}

// `vertices`: by wedge its vertex.
void derive_normals(
    SurfaceArrays& arrays,
    std::span<const std::uint32_t> vertices,
    std::size_t vertex_count,
    bool by_wedge
)
{
    std::vector<NormalSum> around(vertex_count);
    std::vector<NormalSum> own(by_wedge ? vertices.size() : 0);
    for (const Triangle& t : arrays.triangles)
    {
        const NormalSum share =
            weighted_normal(arrays.positions[t[0]], arrays.positions[t[1]], arrays.positions[t[2]]);
        for (const std::uint32_t wedge : t)
        {
            add(around[vertices[wedge]], share);
            if (by_wedge)
            {
                add(own[wedge], share);
            }
        }
    }
    arrays.normals.resize(vertices.size());
    for (std::size_t wedge = 0; wedge < vertices.size(); ++wedge)
    {
        const NormalSum& all = around[vertices[wedge]];
        const bool alone = by_wedge && !leans_little(own[wedge], all);
        arrays.normals[wedge] = stored(alone ? own[wedge] : all);
    }
}

void put_normals(SurfaceArrays& arrays, std::span<const float> values)
{
    arrays.normals.resize(values.size() / 3);
    for (std::size_t i = 0; i < arrays.normals.size(); ++i)
    {
        arrays.normals[i] = stored(Vector{values[3 * i], values[3 * i + 1], values[3 * i + 2]});
    }
    arrays.authored_normals = true;
}

void put_colors(SurfaceArrays& arrays, std::span<const float> values, std::size_t components)
{
    arrays.colors.assign(values.size() / components, {255, 255, 255, 255});
    for (std::size_t i = 0; i < values.size(); ++i)
    {
        const float level = std::isfinite(values[i]) ? std::clamp(values[i], 0.0F, 1.0F) : 0.0F;
        arrays.colors[i / components][i % components] =
            static_cast<std::uint8_t>(std::lround(level * 255.0F));
    }
}

void put_tex_coords(
    SurfaceArrays& arrays, std::size_t set, std::span<const float> values, std::size_t components
)
{
    auto& target = arrays.tex_coords[set];
    target.resize(values.size() / components);
    for (std::size_t i = 0; i < target.size(); ++i)
    {
        target[i] = {values[i * components], components > 1 ? values[i * components + 1] : 0.0F};
    }
}

// Takes what the renderer has a use for. `values`: one value a wedge.
void put_values(
    SurfaceArrays& arrays,
    AttributeKind kind,
    std::size_t set,
    std::size_t components,
    std::span<const float> values
)
{
    if (kind == AttributeKind::Normal && set == 0 && components == 3)
    {
        put_normals(arrays, values);
    }
    else if (kind == AttributeKind::Color && set == 0 && components >= 3)
    {
        put_colors(arrays, values, components);
    }
    else if (kind == AttributeKind::TexCoord && set < arrays.tex_coords.size())
    {
        put_tex_coords(arrays, set, values, components);
    }
}

bool is_used(const codec::AttributeInfo& info)
{
    switch (info.kind)
    {
        case AttributeKind::Normal:
        case AttributeKind::Color:
            return info.set == 0;
        case AttributeKind::TexCoord:
            return info.set < 2;
        default:
            return false;
    }
}

bool has_normals(std::span<const codec::AttributeInfo> infos)
{
    return std::ranges::any_of(infos, [](const codec::AttributeInfo& info) {
        return info.kind == AttributeKind::Normal;
    });
}

void put_attributes(SurfaceArrays& arrays, const SurfaceInput& input)
{
    const codec::LevelAttributes& level = *input.attributes;
    const std::size_t count = std::min(input.infos.size(), level.values.size());
    for (std::size_t i = 0; i < count; ++i)
    {
        const codec::AttributeInfo& info = input.infos[i];
        if (level.values[i].empty() || !is_used(info))
        {
            continue;
        }
        std::vector<float> values(level.wedge_vertices.size() * info.components);
        codec::write_values(info, level.values[i], values);
        put_values(arrays, info.kind, info.set, info.components, values);
    }
}

// Every vertex is its one wedge.
codec::LevelAttributes without_wedges(const SurfaceInput& input)
{
    codec::LevelAttributes level;
    level.wedge_vertices.resize(input.positions.size());
    std::iota(level.wedge_vertices.begin(), level.wedge_vertices.end(), 0U);
    level.wedges.assign(input.triangles.begin(), input.triangles.end());
    return level;
}

// The rows of a table: which vertex and which values each corner has.
class Corners
{
public:
    explicit Corners(const Surface& surface)
        : width_(1 + surface.attributes.size()), cells_(3 * surface.mesh.triangles.size() * width_)
    {
        for (std::size_t corner = 0; corner < size(); ++corner)
        {
            cells_[corner * width_] = surface.mesh.triangles[corner / 3][corner % 3];
            for (std::size_t i = 1; i < width_; ++i)
            {
                cells_[corner * width_ + i] =
                    surface.attributes[i - 1].corners[corner / 3][corner % 3];
            }
        }
    }

    std::size_t size() const { return cells_.size() / width_; }

    std::span<const std::uint32_t> row(std::size_t corner) const
    {
        return std::span(cells_).subspan(corner * width_, width_);
    }

private:
    std::size_t width_;
    std::vector<std::uint32_t> cells_;
};

// Wedges of a surface in memory.
struct SurfaceWedges
{
    std::vector<std::uint32_t> corners;  // By wedge one of its corners.
    std::vector<Triangle> wedges;
};

SurfaceWedges find_wedges(const Corners& corners)
{
    std::vector<std::uint32_t> order(corners.size());
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::stable_sort(order, [&](std::uint32_t a, std::uint32_t b) {
        return std::ranges::lexicographical_compare(corners.row(a), corners.row(b));
    });
    SurfaceWedges result;
    result.wedges.resize(corners.size() / 3);
    for (const std::uint32_t corner : order)
    {
        if (result.corners.empty() ||
            !std::ranges::equal(corners.row(result.corners.back()), corners.row(corner)))
        {
            result.corners.push_back(corner);
        }
        result.wedges[corner / 3][corner % 3] =
            static_cast<std::uint32_t>(result.corners.size() - 1);
    }
    return result;
}

}  // namespace

std::uint64_t SurfaceArrays::bytes() const
{
    const auto size = [](const auto& array) { return array.size() * sizeof(array.front()); };
    return size(positions) + size(normals) + size(colors) + size(tex_coords[0]) +
           size(tex_coords[1]) + size(triangles);
}

SurfaceArrays make_surface_arrays(const SurfaceInput& input)
{
    if (input.attributes == nullptr)
    {
        const codec::LevelAttributes plain = without_wedges(input);
        SurfaceInput with = input;
        with.attributes = &plain;
        return make_surface_arrays(with);
    }
    const codec::LevelAttributes& level = *input.attributes;
    SurfaceArrays arrays;
    arrays.positions.reserve(level.wedge_vertices.size());
    for (const std::uint32_t vertex : level.wedge_vertices)
    {
        arrays.positions.push_back(input.positions[vertex]);
    }
    arrays.triangles = level.wedges;
    put_attributes(arrays, input);
    if (!arrays.authored_normals)
    {
        derive_normals(
            arrays, level.wedge_vertices, input.positions.size(), has_normals(input.infos)
        );
    }
    sort_by_material(arrays, level.groups, input.appearance);
    return arrays;
}

SurfaceArrays make_surface_arrays(const Surface& surface, const Appearance* appearance)
{
    const Corners corners(surface);
    SurfaceWedges found = find_wedges(corners);
    SurfaceArrays arrays;
    std::vector<std::uint32_t> vertices;
    for (const std::uint32_t corner : found.corners)
    {
        vertices.push_back(corners.row(corner)[0]);
        const auto& position = surface.mesh.positions[vertices.back()];
        arrays.positions.push_back(
            {static_cast<float>(position[0]),
             static_cast<float>(position[1]),
             static_cast<float>(position[2])}
        );
    }
    arrays.triangles = std::move(found.wedges);
    for (std::size_t i = 0; i < surface.attributes.size(); ++i)
    {
        const SurfaceAttribute& attribute = surface.attributes[i];
        std::vector<float> values;
        for (const std::uint32_t corner : found.corners)
        {
            const auto* value =
                &attribute.values[std::size_t{corners.row(corner)[i + 1]} * attribute.components];
            values.insert(values.end(), value, value + attribute.components);
        }
        put_values(arrays, attribute.kind, attribute.set, attribute.components, values);
    }
    if (!arrays.authored_normals)
    {
        derive_normals(arrays, vertices, surface.mesh.positions.size(), false);
    }
    sort_by_material(arrays, surface.groups, appearance);
    return arrays;
}

std::uint64_t surface_memory_bytes(
    std::uint64_t vertices,
    std::uint64_t faces,
    std::span<const codec::AttributeInfo> infos,
    bool wireframe
)
{
    const std::uint64_t wedges = vertices + vertices / 2;
    std::uint64_t wedge_bytes = sizeof(std::array<float, 3>) + sizeof(std::array<std::int16_t, 4>);
    std::uint64_t widest = 0;
    for (const codec::AttributeInfo& info : infos)
    {
        if (!is_used(info))
        {
            continue;
        }
        wedge_bytes += info.kind == AttributeKind::TexCoord ? sizeof(std::array<float, 2>) : 0;
        wedge_bytes += info.kind == AttributeKind::Color ? 4 : 0;
        widest = std::max<std::uint64_t>(widest, info.components * sizeof(float));
    }
    // While a level is made: positions and triangles as the decoder gives them, sums of normals.
    const std::uint64_t making = vertices * (sizeof(Vector) + sizeof(NormalSum)) +
                                 wedges * std::max(widest, std::uint64_t{sizeof(NormalSum)}) +
                                 2 * faces * sizeof(Triangle);
    const std::uint64_t arrays = 2 * (wedges * wedge_bytes + faces * sizeof(Triangle));
    return arrays + making + (wireframe ? 2 * faces * sizeof(Triangle) : 0);
}

}  // namespace vsplit::client
