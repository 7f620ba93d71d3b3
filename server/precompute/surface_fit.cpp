// Based on: Hoppe, DeRose, Duchamp, McDonald, Stuetzle, "Mesh Optimization", 1993, section 4.1 (fitting
// vertices to points with fixed shares); Chen, Medioni, "Object Modelling by Registration of Multiple
// Range Images", 1992 (distances along normals let surfaces slide). Departure: both directions are
// tied, since vertices that follow the source alone leave it where nothing of it is near.
#include "precompute/surface_fit.h"

#include "precompute/fan_distance.h"
#include "precompute/parallel_ranges.h"

#include <algorithm>
#include <cmath>

namespace vsplit::precompute {
namespace {

using Point = std::array<float, 3>;

/// Samples of the source for every coarse vertex.
constexpr std::size_t kSamplesPerVertex = 3;

/// Samples of the source at least.
constexpr std::size_t kFewestSamples = 1000;

/// Points of a coarse face.
constexpr std::array<Point, 3> kFacePoints{{
    {2.0F / 3.0F, 1.0F / 6.0F, 1.0F / 6.0F},
    {1.0F / 6.0F, 2.0F / 3.0F, 1.0F / 6.0F},
    {1.0F / 6.0F, 1.0F / 6.0F, 2.0F / 3.0F},
}};

/// Searches that hand their triangle on as a hint; then a new start makes them independent, so that
/// ties between triangles do not depend on how the work is shared out.
constexpr std::uint32_t kChain = 64;

/// Below this distance, in grid units, the direction between two points is noise.
constexpr float kNoDirection = 1e-2F;

Point subtract(const Point& a, const Point& b)
{
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

float dot(const Point& a, const Point& b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Point cross(const Point& a, const Point& b)
{
    return {
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    };
}

Point scaled(const Point& a, float factor)
{
    return {a[0] * factor, a[1] * factor, a[2] * factor};
}

Point mix(const std::array<Point, 3>& corners, const Point& shares)
{
    Point result{};
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        result[axis] = corners[0][axis] * shares[0] + corners[1][axis] * shares[1] +
                       corners[2][axis] * shares[2];
    }
    return result;
}

/// The direction along which two points are to meet: the line between them, or the face's normal where
/// they are at the same place. Zero for a degenerate face there.
Point meeting_direction(const Point& off, const std::array<Point, 3>& corners)
{
    const float length = std::sqrt(dot(off, off));
    if (length > kNoDirection)
    {
        return scaled(off, 1.0F / length);
    }
    const Point normal = cross(subtract(corners[1], corners[0]), subtract(corners[2], corners[0]));
    const float size = std::sqrt(dot(normal, normal));
    return size > 0.0F ? scaled(normal, 1.0F / size) : Point{};
}

float area(const std::array<Point, 3>& corners)
{
    const Point normal = cross(subtract(corners[1], corners[0]), subtract(corners[2], corners[0]));
    return 0.5F * std::sqrt(dot(normal, normal));
}

/// Calls `search(i, hint)` for all i below `count`, each hint being what the call before left in it.
template <typename Search>
void chain_searches(std::size_t count, unsigned threads, const Search& search)
{
    const auto total = static_cast<std::uint32_t>(count);
    // Whole chains: each belongs to the range that its first search is in.
    const auto chain_start = [&](std::uint32_t i) {
        return std::min(total, (i + kChain - 1) / kChain * kChain);
    };
    parallel_ranges(total, threads, [&](std::uint32_t begin, std::uint32_t end) {
        std::uint32_t hint = 0;
        for (std::uint32_t i = chain_start(begin); i < chain_start(end); ++i)
        {
            hint = i % kChain == 0 ? 0 : hint;
            search(i, hint);
        }
    });
}

}  // namespace

void QuadraticForm::average(const QuadraticForm& other)
{
    for (std::size_t i = 0; i < matrix.size(); ++i)
    {
        matrix[i] = 0.5 * (matrix[i] + other.matrix[i]);
    }
    linear = (linear + other.linear) * 0.5;
    weight = 0.5 * (weight + other.weight);
}

void QuadraticForm::attract(const Vector3& to, double amount)
{
    matrix[0] += amount;
    matrix[3] += amount;
    matrix[5] += amount;
    linear = linear + to * amount;
}

double QuadraticForm::evaluate(const Vector3& step) const
{
    const auto& [x, y, z] = step;
    const auto& m = matrix;
    return m[0] * x * x + m[3] * y * y + m[5] * z * z +
           2.0 * (m[1] * x * y + m[2] * x * z + m[4] * y * z) -
           2.0 * (linear[0] * x + linear[1] * y + linear[2] * z);
}

Vector3 QuadraticForm::minimum() const
{
    const auto& m = matrix;
    const Vector3 first{
        m[3] * m[5] - m[4] * m[4], m[2] * m[4] - m[1] * m[5], m[1] * m[4] - m[2] * m[3]};
    const Vector3 second{first[1], m[0] * m[5] - m[2] * m[2], m[1] * m[2] - m[0] * m[4]};
    const Vector3 third{first[2], second[2], m[0] * m[3] - m[1] * m[1]};
    const double determinant = m[0] * first[0] + m[1] * first[1] + m[2] * first[2];
    if (!(determinant > 0.0))
    {
        return {};
    }
    const Vector3 adjugate_times_linear{
        first[0] * linear[0] + first[1] * linear[1] + first[2] * linear[2],
        second[0] * linear[0] + second[1] * linear[1] + second[2] * linear[2],
        third[0] * linear[0] + third[1] * linear[1] + third[2] * linear[2],
    };
    return adjugate_times_linear * (1.0 / determinant);
}

SurfaceFit::SurfaceFit(
    const FitSource& source,
    std::vector<Vector3> places,
    std::span<const Triangle> triangles,
    unsigned threads
)
    : places_(std::move(places)), triangles_(triangles.begin(), triangles.end())
{
    tie_source(source, threads);
    tie_coarse(source, threads);
    list_uses();
}

std::array<float, 3> SurfaceFit::corner(const Triangle& triangle, std::size_t k) const
{
    const Vector3& place = places_[triangle[k]];
    return {
        static_cast<float>(place[0]), static_cast<float>(place[1]), static_cast<float>(place[2])};
}

std::size_t SurfaceFit::sample_count(std::size_t vertices)
{
    return std::max(kFewestSamples, kSamplesPerVertex * vertices);
}

void SurfaceFit::tie_source(const FitSource& source, unsigned threads)
{
    std::vector<Point> positions(places_.size());
    for (std::uint32_t v = 0; v < positions.size(); ++v)
    {
        positions[v] = corner({v, v, v}, 0);
    }
    const ClosestPointTree tree(positions, triangles_);
    const std::size_t step =
        std::max<std::size_t>(source.samples.size() / sample_count(places_.size()), 1);
    ties_.resize((source.samples.size() + step - 1) / step);
    chain_searches(ties_.size(), threads, [&](std::uint32_t i, std::uint32_t& hint) {
        const Point& point = source.samples[i * step].point;
        static_cast<void>(tree.squared_distance(point, hint));
        const Triangle& face = triangles_[hint];
        const std::array<Point, 3> corners{corner(face, 0), corner(face, 1), corner(face, 2)};
        const Point shares = closest_shares(point, corners[0], corners[1], corners[2]);
        const Point off = subtract(point, mix(corners, shares));
        const Point direction = meeting_direction(off, corners);
        ties_[i] = {hint, shares, direction, 1.0F, dot(off, direction)};
    });
}

void SurfaceFit::tie_coarse(const FitSource& source, unsigned threads)
{
    const std::size_t first = ties_.size();
    float total = 0.0F;
    for (const Triangle& face : triangles_)
    {
        total += area({corner(face, 0), corner(face, 1), corner(face, 2)});
    }
    // Together the points of either surface weigh the same.
    const float per_area = total > 0.0F
                               ? static_cast<float>(first > 0 ? first : triangles_.size() * 2) /
                                     total / kFacePoints.size()
                               : 0.0F;
    ties_.resize(first + triangles_.size() * kFacePoints.size());
    chain_searches(ties_.size() - first, threads, [&](std::uint32_t i, std::uint32_t& hint) {
        const Triangle& face = triangles_[i / kFacePoints.size()];
        const Point& shares = kFacePoints[i % kFacePoints.size()];
        const std::array<Point, 3> corners{corner(face, 0), corner(face, 1), corner(face, 2)};
        const Point point = mix(corners, shares);
        static_cast<void>(source.tree->squared_distance(point, hint));
        std::array<Point, 3> there{};
        std::ranges::transform(source.triangles[hint], there.begin(), [&](std::uint32_t v) {
            return source.positions[v];
        });
        const Point off =
            subtract(mix(there, closest_shares(point, there[0], there[1], there[2])), point);
        const Point direction = meeting_direction(off, there);
        const auto index = static_cast<std::uint32_t>(i / kFacePoints.size());
        ties_[first + i] = {
            index, shares, direction, area(corners) * per_area, dot(off, direction)};
    });
}

void SurfaceFit::list_uses()
{
    first_use_.assign(places_.size() + 1, 0);
    const auto for_each_use = [this](const auto& visit) {
        for (std::uint32_t tie = 0; tie < ties_.size(); ++tie)
        {
            for (std::uint32_t k = 0; k < 3; ++k)
            {
                if (ties_[tie].share[k] > 0.0F)
                {
                    visit(triangles_[ties_[tie].face][k], 4 * tie + k);
                }
            }
        }
    };
    for_each_use([this](std::uint32_t vertex, Use) { ++first_use_[vertex + 1]; });
    for (std::size_t v = 1; v < first_use_.size(); ++v)
    {
        first_use_[v] += first_use_[v - 1];
    }
    uses_.resize(first_use_.back());
    std::vector<std::uint32_t> next(first_use_.begin(), first_use_.end() - 1);
    for_each_use([&](std::uint32_t vertex, Use use) { uses_[next[vertex]++] = use; });
}

QuadraticForm SurfaceFit::form(std::uint32_t vertex) const
{
    QuadraticForm form;
    for (std::uint32_t i = first_use_[vertex]; i < first_use_[vertex + 1]; ++i)
    {
        const Tie& tie = ties_[uses_[i] / 4];
        const double share = tie.share[uses_[i] % 4];
        const double importance = tie.importance * share;
        const double amount = importance * share;
        const Vector3 d{tie.direction[0], tie.direction[1], tie.direction[2]};
        form.matrix[0] += amount * d[0] * d[0];
        form.matrix[1] += amount * d[0] * d[1];
        form.matrix[2] += amount * d[0] * d[2];
        form.matrix[3] += amount * d[1] * d[1];
        form.matrix[4] += amount * d[1] * d[2];
        form.matrix[5] += amount * d[2] * d[2];
        form.linear = form.linear + d * (importance * tie.distance);
        form.weight += amount;
    }
    return form;
}

void SurfaceFit::move(std::uint32_t vertex, const Vector3& step)
{
    places_[vertex] = places_[vertex] + step;
    for (std::uint32_t i = first_use_[vertex]; i < first_use_[vertex + 1]; ++i)
    {
        Tie& tie = ties_[uses_[i] / 4];
        const Vector3 d{tie.direction[0], tie.direction[1], tie.direction[2]};
        const double moved = tie.share[uses_[i] % 4] * precompute::dot(d, step);
        tie.distance -= static_cast<float>(moved);
    }
}

}  // namespace vsplit::precompute
