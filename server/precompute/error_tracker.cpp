// Based on: Ciampalini, Cignoni, Montani, Scopigno, "Multiresolution Decimation based on Global Error",
// 1997 (points of the source carry along the face of the simplified mesh that they are closest to).
// Departure: the points are a fixed number of samples, not the removed vertices, so that the mean
// square is that of the surface and the cost does not grow with the mesh.
#include "precompute/error_tracker.h"

#include "precompute/level_builder.h"
#include "precompute/parallel_ranges.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace vsplit::precompute {
namespace {

constexpr std::size_t kFewestSamples = 2000;
constexpr std::size_t kMostSamples = 4000;

/// Samples in the direction from coarse to source, which is hardly ever much larger than the other one;
/// fewer would often make it so by chance.
constexpr std::size_t kCoarseSamples = 1000;

/// Corners of faces that are measured in that direction too, for the maximum: vertices that are shown
/// off the source are furthest away.
constexpr std::size_t kCoarseCorners = 600;

/// Samples on the watched region.
constexpr std::size_t kRegionSamples = 800;

/// Faces out of which they are drawn; of more, every n-th is taken.
constexpr std::size_t kSampledFaces = 16 * kCoarseSamples;

/// Below this number of faces all of them are looked at: other sheets are as near as the next face.
constexpr std::size_t kSearchedFaces = 256;

/// The same when components are missing: what is nearest then need not be near.
constexpr std::size_t kSearchedFacesOfParts = 8192;

/// Vertices that are measured when they are removed, the costliest of every batch, and how many of them
/// are followed further on: the largest distance mostly is that of a vertex.
constexpr std::size_t kMeasuredVertices = kCostliest;
constexpr std::size_t kFollowedVertices = 64;

using Position = std::array<float, 3>;

Position to_float(const Vector3& point)
{
    return {
        static_cast<float>(point[0]), static_cast<float>(point[1]), static_cast<float>(point[2])};
}

template <typename List, typename Member>
double root_mean_square(const List& samples, Member square)
{
    double sum = 0.0;
    for (const auto& sample : samples)
    {
        sum += static_cast<double>(sample.*square);
    }
    return std::sqrt(sum / static_cast<double>(samples.size()));
}

std::vector<Position> to_float(std::span<const Vector3> points)
{
    std::vector<Position> result(points.size());
    std::ranges::transform(points, result.begin(), [](const Vector3& p) { return to_float(p); });
    return result;
}

/// The triangles whose corners are all marked.
std::vector<Triangle> marked_triangles(
    std::span<const Triangle> triangles, std::span<const float> importance
)
{
    std::vector<Triangle> marked;
    const auto is_marked = [&](std::uint32_t v) { return importance[v] > 0.0F; };
    for (const Triangle& triangle : triangles.first(importance.empty() ? 0 : triangles.size()))
    {
        if (std::ranges::all_of(triangle, is_marked))
        {
            marked.push_back(triangle);
        }
    }
    return marked;
}

}  // namespace

ErrorTracker::Sums ErrorTracker::sum(std::span<const Sample> samples)
{
    Sums sums;
    for (const Sample& sample : samples)
    {
        const auto square = static_cast<double>(sample.shown_square);
        sums.mean_square += square;
        sums.max_square = std::max(sums.max_square, square);
    }
    sums.mean_square /= static_cast<double>(samples.size());
    return sums;
}

ErrorTracker::ErrorTracker(
    std::span<const Vector3> exact,
    const GridMesh& mesh,
    std::span<const float> importance,
    unsigned threads
)
    : exact_(exact),
      source_(mesh),
      importance_(importance),
      threads_(threads),
      mesh_(static_cast<std::uint32_t>(exact.size()), mesh.triangles),
      kept_of_(exact.size(), 0),
      tree_(to_float(exact), mesh.triangles)
{
    place_all_samples();
}

void ErrorTracker::restart()
{
    mesh_ = CollapseMesh(static_cast<std::uint32_t>(exact_.size()), source_.triangles);
    vertices_.clear();
    lacks_parts_ = false;
    shown_shift_ = -1;
    place_all_samples();
}

void ErrorTracker::place_all_samples()
{
    faces_.resize(source_.triangles.size());
    std::iota(faces_.begin(), faces_.end(), std::uint32_t{0});
    samples_ = place_samples(
        source_.triangles, std::clamp(exact_.size() / 4, kFewestSamples, kMostSamples)
    );
    if (const auto marked = marked_triangles(source_.triangles, importance_); !marked.empty())
    {
        region_ = place_samples(marked, kRegionSamples);
    }
}

std::vector<ErrorTracker::Sample> ErrorTracker::place_samples(
    std::span<const Triangle> triangles, std::size_t count
) const
{
    std::vector<Sample> samples;
    samples.reserve(count);
    for (const auto& [point, index] : sample_surface(to_float(exact_), triangles, count))
    {
        const Triangle& triangle = triangles[index];
        // Not a hub, of whose fan only a part is looked at.
        const std::uint32_t corner = *std::ranges::min_element(
            triangle, {}, [this](std::uint32_t v) { return mesh_.valence(v); }
        );
        samples.push_back({.point = point, .triangle = triangle, .corner = corner});
    }
    return samples;
}

void ErrorTracker::collapse(std::span<const codec::Collapse> batch)
{
    for (const codec::Collapse& collapse : batch)
    {
        OneRing ring;
        if (mesh_.ring(collapse.removed, ring))
        {
            const auto kept = std::ranges::find(ring.vertex, collapse.kept) - ring.vertex.begin();
            mesh_.collapse(collapse.removed, ring, static_cast<std::size_t>(kept));
            kept_of_[collapse.removed] = collapse.kept;
        }
    }
    for (const codec::Collapse& collapse : batch.last(std::min(batch.size(), kMeasuredVertices)))
    {
        const std::uint32_t v = collapse.removed;
        vertices_.push_back({.point = to_float(exact_[v]), .triangle = {v, v, v}, .corner = v});
    }
}

void ErrorTracker::remove_parts(std::span<const std::vector<Triangle>> parts)
{
    for (const std::vector<Triangle>& group : parts)
    {
        mesh_.remove_parts(group);
        for (const Triangle& triangle :
             std::span(group).first(std::min(group.size(), kMeasuredVertices)))
        {
            const std::uint32_t v = triangle[0];
            vertices_.push_back({.point = to_float(exact_[v]), .triangle = {v, v, v}, .corner = v});
        }
    }
    lacks_parts_ = true;
    std::erase_if(faces_, [this](std::uint32_t face) { return !mesh_.has_face(face); });
    const ClosestPointTree tree(to_float(exact_), triangles());
    tie_anew(samples_, tree);
    tie_anew(region_, tree);
    tie_anew(vertices_, tree);
}

/// Finds the faces that are closest to samples whose own ones are gone.
void ErrorTracker::tie_anew(std::span<Sample> samples, const ClosestPointTree& tree) const
{
    for (Sample& sample : samples)
    {
        if (!is_gone(sample.triangle))
        {
            continue;
        }
        std::uint32_t hint = 0;
        sample.square = tree.squared_distance(sample.point, hint);
        sample.triangle = mesh_.triangle(faces_[hint]);
        sample.corner = *std::ranges::min_element(sample.triangle, {}, [this](std::uint32_t v) {
            return mesh_.valence(v);
        });
        sample.moved = true;
    }
}

bool ErrorTracker::is_gone(const Triangle& triangle) const
{
    return mesh_.is_removed(triangle[0]) || mesh_.is_removed(triangle[1]) ||
           mesh_.is_removed(triangle[2]);
}

std::uint32_t ErrorTracker::survivor(std::uint32_t vertex) const
{
    while (mesh_.is_removed(vertex))
    {
        vertex = kept_of_[vertex];
    }
    return vertex;
}

void ErrorTracker::follow(Sample& sample) const
{
    if (!is_gone(sample.triangle))
    {
        return;
    }
    const auto position_of = [this](std::uint32_t v) { return to_float(exact_[v]); };
    const FaceFan::Closest closest =
        walk_to_closest(mesh_, sample.point, survivor(sample.corner), position_of);
    sample.square = closest.square;
    sample.triangle = mesh_.triangle(closest.face);
    sample.corner = closest.corner;
    sample.moved = true;
}

void ErrorTracker::follow(std::span<Sample> samples) const
{
    const auto count = static_cast<std::uint32_t>(samples.size());
    parallel_ranges(count, threads_, [&](std::uint32_t begin, std::uint32_t end) {
        std::ranges::for_each(samples.subspan(begin, end - begin), [this](Sample& sample) {
            follow(sample);
        });
    });
}

ErrorTracker::SourceError ErrorTracker::follow()
{
    follow(samples_);
    follow(region_);
    follow(vertices_);
    if (vertices_.size() > kFollowedVertices)
    {
        // Ties keep their order, so that the choice never depends on the sorting.
        std::ranges::stable_sort(vertices_, std::greater<>(), &Sample::square);
        vertices_.resize(kFollowedVertices);
    }
    std::erase_if(faces_, [this](std::uint32_t face) { return !mesh_.has_face(face); });
    SourceError error;
    error.whole = root_mean_square(samples_, &Sample::square);
    if (!region_.empty())
    {
        error.region = root_mean_square(region_, &Sample::square);
    }
    return error;
}

Position ErrorTracker::shown(std::uint32_t vertex, int shift) const
{
    // dequantize() in grid units.
    const std::int32_t half = (std::int32_t{1} << shift) - 1;
    Position point{};
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const std::int32_t corner = cells_[vertex][axis] * (std::int32_t{1} << shift);
        point[axis] = static_cast<float>(corner) + 0.5F * static_cast<float>(half);
    }
    return point;
}

std::vector<Triangle> ErrorTracker::triangles() const
{
    std::vector<Triangle> triangles(faces_.size());
    std::ranges::transform(faces_, triangles.begin(), [this](std::uint32_t face) {
        return mesh_.triangle(face);
    });
    return triangles;
}

SurfaceDistance ErrorTracker::measure(int shift, std::span<const std::array<std::int32_t, 3>> cells)
{
    cells_ = cells;
    update_shown(shift);
    Sums there = sum(samples_);
    there.max_square = std::max(there.max_square, sum(vertices_).max_square);
    const Sums back = measure_coarse(shift);
    return {
        .rms = std::sqrt(std::max(there.mean_square, back.mean_square)),
        .max = std::sqrt(std::max(there.max_square, back.max_square)),
    };
}

void ErrorTracker::update_shown(int shift)
{
    if (faces_.size() <= (lacks_parts_ ? kSearchedFacesOfParts : kSearchedFaces))
    {
        search_all(shift);
        return;
    }
    const bool all = shift != shown_shift_;
    const auto update = [&](Sample& sample) {
        if (all || sample.moved)
        {
            FaceFan fan;
            fan.collect(mesh_, sample.corner, [&](std::uint32_t v) { return shown(v, shift); });
            sample.shown_square = fan.closest(mesh_, sample.point).square;
            sample.moved = false;
        }
    };
    const auto count = static_cast<std::uint32_t>(samples_.size());
    parallel_ranges(count, threads_, [&](std::uint32_t begin, std::uint32_t end) {
        std::for_each(samples_.begin() + begin, samples_.begin() + end, update);
    });
    std::ranges::for_each(vertices_, update);
    shown_shift_ = shift;
}

void ErrorTracker::search_all(int shift)
{
    const Shown surface = shown_faces(shift, 1);
    const ClosestPointTree tree(surface.positions, surface.triangles);
    std::uint32_t hint = 0;
    const auto search = [&](Sample& sample) {
        sample.shown_square = tree.squared_distance(sample.point, hint);
    };
    std::ranges::for_each(samples_, search);
    std::ranges::for_each(vertices_, search);
    shown_shift_ = -1;
}

ErrorTracker::Shown ErrorTracker::shown_faces(int shift, std::size_t step) const
{
    Shown surface;
    for (std::size_t i = 0; i < faces_.size(); i += step)
    {
        const auto first = static_cast<std::uint32_t>(surface.positions.size());
        for (const std::uint32_t v : mesh_.triangle(faces_[i]))
        {
            surface.positions.push_back(shown(v, shift));
        }
        surface.triangles.push_back({first, first + 1, first + 2});
    }
    return surface;
}

ErrorTracker::Sums ErrorTracker::measure_coarse(int shift) const
{
    const std::size_t step = faces_.size() / kSampledFaces + 1;
    const Shown surface = shown_faces(shift, step);
    auto drawn = sample_surface(surface.positions, surface.triangles, kCoarseSamples);
    std::vector<Sample> samples(drawn.size());
    const auto count = static_cast<std::uint32_t>(drawn.size());
    parallel_ranges(count, threads_, [&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t i = begin; i < end; ++i)
        {
            // The face was a triangle of the source at about the same place.
            std::uint32_t hint = faces_[drawn[i].triangle * step];
            samples[i].shown_square = tree_.squared_distance(drawn[i].point, hint);
        }
    });
    Sums sums = sum(samples);
    const std::size_t corner_step = surface.positions.size() / kCoarseCorners + 1;
    for (std::size_t i = 0; i < surface.positions.size(); i += corner_step)
    {
        std::uint32_t hint = faces_[i / 3 * step];
        sums.max_square =
            std::max<double>(sums.max_square, tree_.squared_distance(surface.positions[i], hint));
    }
    return sums;
}

}  // namespace vsplit::precompute
