// Based on: Pajarola, Rossignac, "Compressed Progressive Meshes", 2000 (independent collapses in
// batches); Wang, Yang, "3D Models Simplification Algorithm for Mobile Devices" (half-edge collapses
// into a neighbour, coarse vertices a subset of the original).
#include "precompute/level_builder.h"

#include "core/portable_log.h"
#include "precompute/parallel_ranges.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace vsplit::precompute {
namespace {

/// No face may turn by more than this (cosine).
constexpr double kLeastCosine = 0.25;

/// Quality below which a new triangle counts as degenerate; 1 is equilateral. Long thin triangles must
/// pass: flat parts of CAD models consist of them, and refusing them leaves large base meshes.
constexpr double kLeastQuality = 1e-4;

/// Least quality, 0 .. 1, over the triangles that a collapse changes; negative when one flips or
/// degenerates.
double worst_quality(const OneRing& ring, const StarGeometry& star, std::size_t kept)
{
    double worst = 1.0;
    for (std::size_t i = 0; i < ring.face_count; ++i)
    {
        const std::size_t j = (i + 1) % ring.size;
        if (i == kept || j == kept)
        {
            continue;
        }
        const Vector3 a = star.offset[i] - star.offset[kept];
        const Vector3 b = star.offset[j] - star.offset[kept];
        const Vector3 normal = cross(a, b);
        const double double_area = std::sqrt(dot(normal, normal));
        const double turned = dot(star.area_normal[i], normal);
        if (!(double_area > 0.0) || turned < kLeastCosine * star.double_area[i] * double_area)
        {
            return -1.0;
        }
        const Vector3 edge = star.offset[j] - star.offset[i];
        // 2 sqrt(3) * double area / sum of squared edges: 1 for equilateral triangles.
        const double quality =
            3.4641016151377544 * double_area / (dot(a, a) + dot(b, b) + dot(edge, edge));
        worst = std::min(worst, quality);
    }
    return worst;
}

/// The value below which a share of the values lies; reorders them.
float quantile(std::vector<float>& values, double share)
{
    const auto index = std::min(
        values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size()))
    );
    std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(index));
    return values[index];
}

}  // namespace

LevelBuilder::LevelBuilder(
    CollapseMesh& mesh,
    CollapseCost& cost,
    std::span<const Vector3> positions,
    std::span<const std::uint8_t> locked,
    unsigned threads
)
    : mesh_(mesh),
      cost_(cost),
      positions_(positions),
      locked_(locked),
      threads_(threads),
      alive_(mesh.vertices()),
      first_(positions.size(), 0),
      best_key_(positions.size(), kSettled)
{
}

bool LevelBuilder::may_go(std::uint32_t vertex) const
{
    const std::uint32_t valence = mesh_.valence(vertex);
    return valence >= 3 && valence <= kMostNeighbours &&
           (locked_.empty() || locked_[vertex] == 0) && copies_.first_of(vertex) == vertex;
}

std::span<LevelBuilder::Candidate> LevelBuilder::candidates_of(std::uint32_t vertex)
{
    // Whoever is asked for has the neighbours that it had when the level began: see best_key_.
    return std::span(candidates_)
        .subspan(first_[vertex], may_go(vertex) ? mesh_.valence(vertex) : 0);
}

void LevelBuilder::rate(
    std::uint32_t vertex,
    const OneRing& ring,
    const LevelStyle& style,
    std::span<Candidate> candidates
) const
{
    const StarGeometry star = cost_.star(vertex, ring);
    const double off_centre = std::sqrt(dot(star.mean, star.mean) / (star.area + 1.0));
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < ring.size; ++i)
    {
        const Vector3 off = star.offset[i] - star.mean;
        nearest = std::min(nearest, dot(off, off));
    }
    for (std::size_t kept = 0; kept < ring.size; ++kept)
    {
        candidates[kept] = {};
        // A boundary vertex moves only along the boundary, a seam's only along the seam.
        if ((ring.boundary && kept != 0 && kept + 1 != ring.size) ||
            !mesh_.keeps_seams(vertex, ring, kept))
        {
            continue;
        }
        const double quality = worst_quality(ring, star, kept);
        if (quality < kLeastQuality)
        {
            continue;
        }
        const Vector3 off = star.offset[kept] - star.mean;
        const double key = style.shape * (1.0 - quality) + style.centring * off_centre +
                           style.apex * portable_log((dot(off, off) + 1.0) / (nearest + 1.0));
        candidates[kept] = {
            static_cast<float>(cost_.price(vertex, ring, star, kept)), static_cast<float>(key)};
    }
}

void LevelBuilder::collect_vertex(std::uint32_t vertex, const LevelStyle& style)
{
    const std::span<Candidate> candidates = candidates_of(vertex);
    OneRing ring;
    if (candidates.empty() || !mesh_.ring(vertex, ring))
    {
        return;
    }
    if (copies_.of(vertex).empty())
    {
        rate(vertex, ring, style, candidates);
    }
    else
    {
        collect_copies(vertex, style);
    }
}

void LevelBuilder::collect(const LevelStyle& style)
{
    std::size_t count = 0;
    for (const std::uint32_t vertex : alive_)
    {
        first_[vertex] = static_cast<std::uint32_t>(count);
        count += may_go(vertex) ? mesh_.valence(vertex) : 0;
        best_key_[vertex] = kSettled;
    }
    candidates_.resize(std::max(candidates_.size(), count));
    const auto alive = static_cast<std::uint32_t>(alive_.size());
    parallel_ranges(alive, threads_, [&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t i = begin; i < end; ++i)
        {
            collect_vertex(alive_[i], style);
        }
    });
}

LevelBuilder::Prices LevelBuilder::typical_prices(const LevelStyle& style)
{
    std::vector<float> best_prices;
    std::vector<float> unmarked_prices;
    for (const std::uint32_t vertex : alive_)
    {
        float best = kSettled;
        for (const Candidate& candidate : candidates_of(vertex))
        {
            best = std::min(best, candidate.price);
        }
        if (best == kSettled)
        {
            continue;
        }
        best_prices.push_back(best);
        if (cost_.has_marks() && !cost_.is_marked(vertex))
        {
            unmarked_prices.push_back(best);
        }
    }
    if (best_prices.empty())
    {
        return {};
    }
    // What may go at all is decided among the unmarked ones, or a large region would lift its own cap.
    std::vector<float>& prices =
        unmarked_prices.size() > best_prices.size() / 4 ? unmarked_prices : best_prices;
    return {
        .median = std::max(1e-30, static_cast<double>(quantile(prices, 0.5))),
        .most = style.cheapest_share < 1.0 ? quantile(prices, style.cheapest_share) : kSettled,
    };
}

void LevelBuilder::rank(const LevelStyle& style)
{
    const Prices typical = typical_prices(style);
    const auto alive = static_cast<std::uint32_t>(alive_.size());
    parallel_ranges(alive, threads_, [&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t i = begin; i < end; ++i)
        {
            float best = kSettled;
            for (auto& [price, key] : candidates_of(alive_[i]))
            {
                const double ratio = static_cast<double>(price) / typical.median;
                key = price > typical.most || price == kSettled
                          ? kSettled
                          : key + static_cast<float>(style.cost_weight * portable_log(1.0 + ratio));
                best = std::min(best, key);
            }
            best_key_[alive_[i]] = best;
        }
    });
    heap_.clear();
    for (const std::uint32_t vertex : alive_)
    {
        if (best_key_[vertex] < kSettled)
        {
            heap_.emplace_back(best_key_[vertex], vertex);
        }
    }
    std::ranges::make_heap(heap_, std::greater<>());
    copies_.for_each([this](std::span<const std::uint32_t> copies) {
        for (const std::uint32_t copy : copies)
        {
            best_key_[copy] = best_key_[copies.front()];
        }
    });
}

void LevelBuilder::reward_neighbours(const OneRing& ring, const LevelStyle& style)
{
    if (!(style.packing > 0.0))
    {
        return;
    }
    for (std::size_t i = 0; i < ring.face_count; ++i)
    {
        if (mesh_.face_across(ring.corner[i]) < 0)
        {
            continue;
        }
        const std::uint32_t vertex = copies_.first_of(mesh_.vertex_across(ring.corner[i]));
        if (best_key_[vertex] < kSettled)
        {
            best_key_[vertex] -= static_cast<float>(style.packing);
            heap_.emplace_back(best_key_[vertex], vertex);
            std::ranges::push_heap(heap_, std::greater<>());
        }
    }
}

bool LevelBuilder::try_vertex(
    std::uint32_t vertex, const LevelStyle& style, std::vector<codec::Collapse>& done
)
{
    OneRing ring;
    if (!mesh_.ring(vertex, ring))
    {
        return false;
    }
    std::array<std::pair<float, std::size_t>, OneRing::kMost> choices{};
    std::size_t count = 0;
    const std::span<const Candidate> candidates = candidates_of(vertex);
    for (std::size_t kept = 0; kept < candidates.size(); ++kept)
    {
        if (candidates[kept].key < kSettled)
        {
            choices[count++] = {candidates[kept].key, kept};
        }
    }
    // Ties go to the first neighbour, so that the result never depends on the sorting.
    std::sort(choices.begin(), choices.begin() + static_cast<std::ptrdiff_t>(count));
    for (std::size_t i = 0; i < count; ++i)
    {
        const std::size_t kept = choices[i].second;
        if (!mesh_.can_collapse(vertex, ring, kept, kValenceLimit))
        {
            continue;
        }
        carry_out(vertex, ring, kept, style, done);
        return true;
    }
    return false;
}

void LevelBuilder::carry_out(
    std::uint32_t vertex,
    const OneRing& ring,
    std::size_t kept,
    const LevelStyle& style,
    std::vector<codec::Collapse>& done
)
{
    // Stars share a face exactly when their centres are neighbours.
    for (std::size_t neighbour = 0; neighbour < ring.size; ++neighbour)
    {
        best_key_[ring.vertex[neighbour]] = kSettled;
    }
    reward_neighbours(ring, style);
    done.push_back(describe_collapse(vertex, ring, kept));
    if (mesh_.has_wedges())
    {
        seams_.push_back(mesh_.seam_record(ring, kept));
    }
    mesh_.collapse(vertex, ring, kept);
    cost_.merge(vertex, ring.vertex[kept]);
}

codec::Collapse describe_collapse(std::uint32_t removed, const OneRing& ring, std::size_t kept)
{
    codec::Collapse collapse{.removed = removed, .kept = ring.vertex[kept]};
    collapse.wedge = static_cast<std::uint8_t>(ring.size - 2);
    collapse.right = ring.vertex[(kept + 1) % ring.size];
    if (ring.boundary && kept == 0)
    {
        collapse.kind = codec::SplitKind::BoundaryLeft;
    }
    else if (ring.boundary)
    {
        collapse.kind = codec::SplitKind::BoundaryRight;
        collapse.right = ring.vertex[0];
    }
    return collapse;
}

void LevelBuilder::put_in_order(std::vector<codec::Collapse>& done)
{
    // Whoever carries them out again walks through memory in order.
    const std::size_t count = done.size() - std::min(kCostliest, done.size());
    const auto first = done.begin();
    const auto costliest = first + static_cast<std::ptrdiff_t>(count);
    if (!seams_.empty())
    {
        std::vector<std::pair<std::uint32_t, std::size_t>> order(count);
        for (std::size_t i = 0; i < count; ++i)
        {
            order[i] = {done[i].removed, i};
        }
        std::ranges::sort(order);
        const std::vector<codec::SeamRecord> unordered = seams_;
        std::ranges::transform(order, seams_.begin(), [&](const auto& entry) {
            return unordered[entry.second];
        });
    }
    std::ranges::sort(first, costliest, {}, &codec::Collapse::removed);
}

void LevelBuilder::forget_removed()
{
    std::erase_if(alive_, [this](std::uint32_t v) { return mesh_.is_removed(v); });
}

std::vector<codec::Collapse> LevelBuilder::next_level(const LevelStyle& style, std::size_t most)
{
    copies_.forget_removed(mesh_);
    collect(style);
    rank(style);
    seams_.clear();
    std::vector<codec::Collapse> done;
    const auto share =
        static_cast<std::size_t>(style.largest_share * static_cast<double>(alive_.size()));
    limit_ = std::min(most, std::max<std::size_t>(share, 1));
    while (!heap_.empty() && done.size() < limit_)
    {
        std::ranges::pop_heap(heap_, std::greater<>());
        const auto [key, vertex] = heap_.back();
        heap_.pop_back();
        if (key == best_key_[vertex])
        {
            best_key_[vertex] = kSettled;
            copies_.of(vertex).empty() ? try_vertex(vertex, style, done)
                                       : try_copies(vertex, style, done);
        }
    }
    forget_removed();
    put_in_order(done);
    return done;
}

}  // namespace vsplit::precompute
