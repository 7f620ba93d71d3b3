#include "codec/coarse_values.h"

#include "codec/value_fit.h"
#include "codec/value_precision.h"

#include <algorithm>
#include <cmath>

namespace vsplit::codec {
namespace {

/// Cells of positions that a step of texture coordinates is long at most; at least half as many. Measured: 4 and
/// 8 take more off the first bytes of fragmented atlases (damaged-helmet), but blur others (spot).
constexpr double kCellsPerStep = 2.0;

/// Bits that are left even on the coarsest level.
constexpr int kFewestBits = 5;

/// Root of the ratio of areas: of the triangles in an attribute's numbers and of those in space.
double stretch_of(const StreamPlan& plan, std::size_t attribute)
{
    const std::vector<std::int32_t>& values = plan.values[attribute];
    double in_numbers = 0.0;
    double in_space = 0.0;
    for (std::size_t f = 0; f < plan.wedges.size(); ++f)
    {
        const auto& [a, b, c] = plan.mesh->triangles[f];
        const auto& points = plan.mesh->positions;
        const Double3 normal =
            cross(difference(points[b], points[a]), difference(points[c], points[a]));
        in_space += std::sqrt(dot(normal, normal));
        const auto side = [&](std::size_t corner, std::size_t k) {
            return static_cast<double>(
                values[std::size_t{2} * plan.wedges[f][corner] + k] -
                values[std::size_t{2} * plan.wedges[f][0] + k]
            );
        };
        in_numbers += std::abs(side(1, 0) * side(2, 1) - side(1, 1) * side(2, 0));
    }
    return in_space > 0.0 ? std::sqrt(in_numbers / in_space) : 0.0;
}

}  // namespace

CoarseValues::CoarseValues(const StreamPlan& plan) : plan_(plan), stretch_(plan.attributes.size())
{
    for (std::size_t a = 0; a < stretch_.size(); ++a)
    {
        if (plan.late_bits > 0 && may_lack_bits(plan.attributes[a]))
        {
            stretch_[a] = stretch_of(plan, a);
        }
    }
}

std::vector<std::uint8_t> CoarseValues::lacking(int shift, std::size_t known)
{
    std::vector<std::uint8_t> lacks(stretch_.size());
    if (plan_.late_bits == 0)
    {
        return lacks;
    }
    for (std::size_t a = 0; a < lacks.size(); ++a)
    {
        if (!may_lack_bits(plan_.attributes[a]))
        {
            continue;
        }
        const int most = std::max(plan_.attributes[a].bits - kFewestBits, 0);
        double numbers = kCellsPerStep * stretch_[a] * static_cast<double>(1 << shift);
        int bits = 0;
        for (; numbers >= 2.0 && bits < most; ++bits)
        {
            numbers *= 0.5;
        }
        bits = std::max(bits, std::min(plan_.late_bits, most));
        if (!lacks_.empty())
        {
            // What would burst the chunk comes with the late bits.
            const auto gained = static_cast<std::size_t>(2 * std::max(lacks_[a] - bits, 0)) * known;
            bits = gained / 8 > kFullChunk ? lacks_[a] : std::min<int>(bits, lacks_[a]);
        }
        lacks[a] = static_cast<std::uint8_t>(bits);
    }
    lacks_ = lacks;
    return lacks;
}

}  // namespace vsplit::codec
