#include "mesh/quantization_grid.h"

#include "core/assert.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vsplit {

namespace {

/// The least binary32 that is not below a positive number, if there is one.
double round_up_to_single(double number)
{
    const auto single = static_cast<float>(number);
    const float up = static_cast<double>(single) < number
                         ? std::nextafter(single, std::numeric_limits<float>::infinity())
                         : single;
    return std::isfinite(up) && up > 0.0F ? static_cast<double>(up) : number;
}

}  // namespace

QuantizationGrid make_grid(std::span<const std::array<double, 3>> positions, int bits)
{
    VSPLIT_ASSERT(!positions.empty() && bits >= 1 && bits <= 24);
    std::array<double, 3> low = positions.front();
    std::array<double, 3> high = low;
    for (const auto& point : positions)
    {
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            low[axis] = std::min(low[axis], point[axis]);
            high[axis] = std::max(high[axis], point[axis]);
        }
    }
    QuantizationGrid grid{.origin = low, .cell = 1.0, .bits = bits};
    const double extent = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
    const double cell = extent / grid.max_index();
    if (cell > 0.0 && std::isfinite(cell))
    {
        grid.cell = round_up_to_single(cell);
    }
    return grid;
}

std::array<std::int32_t, 3> quantize(
    const QuantizationGrid& grid, const std::array<double, 3>& point
)
{
    std::array<std::int32_t, 3> index{};
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const double scaled = std::floor((point[axis] - grid.origin[axis]) / grid.cell + 0.5);
        index[axis] =
            static_cast<std::int32_t>(std::clamp(scaled, 0.0, static_cast<double>(grid.max_index()))
            );
    }
    return index;
}

std::array<double, 3> dequantize(
    const QuantizationGrid& grid, const std::array<std::int32_t, 3>& index, int shift
)
{
    const double scale = static_cast<double>(std::int32_t{1} << shift);
    const double centre = (scale - 1.0) * 0.5;
    std::array<double, 3> point{};
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        point[axis] = grid.origin[axis] + (index[axis] * scale + centre) * grid.cell;
    }
    return point;
}

GridMesh quantize(const QuantizationGrid& grid, const IndexedMesh& mesh)
{
    GridMesh result;
    result.positions.reserve(mesh.positions.size());
    for (const auto& point : mesh.positions)
    {
        result.positions.push_back(quantize(grid, point));
    }
    result.triangles = mesh.triangles;
    return result;
}

IndexedMesh dequantize(const QuantizationGrid& grid, const GridMesh& mesh)
{
    IndexedMesh result;
    result.positions.reserve(mesh.positions.size());
    for (const auto& index : mesh.positions)
    {
        result.positions.push_back(dequantize(grid, index));
    }
    result.triangles = mesh.triangles;
    return result;
}

}  // namespace vsplit
