#include "codec/ring_frames.h"

#include "core/assert.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace vsplit::codec {
namespace {

using lanes::Float4;
using Int4 = std::int32_t __attribute__((vector_size(16)));
using Vectors4 = BasicVector<Float4>;

template <typename Lanes, typename Array>
Lanes load_lanes(const Array& values, std::size_t group)
{
    Lanes result;
    std::memcpy(&result, values.data() + group * 4, sizeof(result));
    return result;
}

template <typename Array>
Vectors4 load_vectors(const Array& values, std::size_t group)
{
    return {
        load_lanes<Float4>(values[0], group),
        load_lanes<Float4>(values[1], group),
        load_lanes<Float4>(values[2], group),
    };
}

Vectors4 choose(Int4 mask, const Vectors4& yes, const Vectors4& no)
{
    return {mask ? yes.x : no.x, mask ? yes.y : no.y, mask ? yes.z : no.z};
}

/// The value where the mask is set, else +0, which leaves any sum that began with +0 as it is.
Float4 where(Int4 mask, Float4 value)
{
    return (Float4)((Int4)value & mask);
}

Vectors4 where(Int4 mask, const Vectors4& value)
{
    return {where(mask, value.x), where(mask, value.y), where(mask, value.z)};
}

Float4 square_root(Float4 value)
{
    return Float4{
        std::sqrt(value[0]), std::sqrt(value[1]), std::sqrt(value[2]), std::sqrt(value[3])};
}

bool any(Int4 mask)
{
    return (mask[0] | mask[1] | mask[2] | mask[3]) != 0;
}

/// Sums over the edges of four rings.
struct RingSums
{
    Vectors4 area{};        ///< Twice the vector area (Newell).
    Vectors4 weighted{};    ///< Sum of edge length * (both ends).
    Vectors4 outer_area{};  ///< Sum of the outer faces' vector areas.
    Float4 length{};        ///< Sum of edge lengths.
    Float4 square{};        ///< Sum of squared distances from the mean.
    Float4 outer_plane{};   ///< Sum of outer vector area . ring vertex.
};

/// One edge of a ring, relative to the ring's mean. `inside`: where the ring has so many edges;
/// `outside`: where there is an outer vertex.
void add_edge(
    RingSums& sums,
    const Vectors4& a,
    const Vectors4& b,
    const Vectors4& outer,
    Int4 inside,
    Int4 outside
)
{
    const Vectors4 edge = b - a;
    const Float4 length = square_root(dot(edge, edge));
    sums.area = sums.area + where(inside, cross(a, b));
    sums.length += where(inside, length);
    sums.weighted = sums.weighted + where(inside, (a + b) * length);
    sums.square += where(inside, dot(a, a));
    const Vectors4 area = cross(outer - a, edge);
    sums.outer_area = sums.outer_area + where(outside, area);
    sums.outer_plane += where(outside, dot(area, a));
}

/// Offset along the normal at which the tangent planes of the outer faces meet it, within +-radius;
/// 0 where those faces look away.
Float4 tangent_plane_offset(const RingSums& sums, const BasicFrame<Float4>& frame)
{
    const Float4 along = dot(sums.outer_area, frame.normal);
    // cos^2 of about 76 degrees: beyond, the planes say nothing.
    const Int4 good =
        (along > 0.0F) & (along * along > 0.06F * dot(sums.outer_area, sums.outer_area));
    return where(good, clamp_to<Float4>(sums.outer_plane / along, frame.radius));
}

/// Derives all but the centre. `kept`: the kept vertex, relative to the centre.
void finish_frame(
    BasicFrame<Float4>& frame, const RingSums& sums, Float4 share, const Vectors4& kept
)
{
    const Float4 zero{};
    const Float4 area = dot(sums.area, sums.area);
    frame.normal = choose(
        area > 0.0F,
        sums.area * (1.0F / square_root(area)),
        Vectors4{zero, zero, lanes::splat(1.0F)}
    );
    frame.radius = lanes::max(square_root(sums.square * share), lanes::splat(0.5F));
    const Vectors4 weighted =
        choose(sums.length > 0.0F, sums.weighted * (0.5F / sums.length), sums.weighted);
    frame.heights = {
        tangent_plane_offset(sums, frame),
        dot(kept, frame.normal),
        dot(weighted, frame.normal),
    };
    frame.to_kept = kept - frame.normal * frame.heights[1];
    frame.to_mean = weighted - frame.normal * frame.heights[2];
}

}  // namespace

void RingFrames::set_outer(
    const RefinementMesh& mesh, Corner across, std::size_t edge, std::size_t i
)
{
    has_outer_[edge][i] = across >= 0 ? -1 : 0;
    const Point& point = mesh.points()[across >= 0 ? mesh.vertex(across) : 0];
    outer_[edge][0][i] = point.x;
    outer_[edge][1][i] = point.y;
    outer_[edge][2][i] = point.z;
}

void RingFrames::collect_ring(const RefinementMesh& mesh, const Split& split, std::size_t i)
{
    std::size_t size = 0;
    const auto add = [&](Corner corner) {
        const Point& point = mesh.points()[mesh.vertex(corner)];
        position_[size][0][i] = point.x;
        position_[size][1][i] = point.y;
        position_[size][2][i] = point.z;
        ++size;
    };
    Corner corner = split.first;
    add(corner);
    add(next_corner(corner));
    set_outer(mesh, mesh.opposite(previous_corner(corner)), 0, i);
    for (int face = 1;; ++face)
    {
        add(previous_corner(corner));
        set_outer(mesh, mesh.opposite(corner), size - 2, i);
        const Corner across = mesh.opposite(next_corner(corner));
        if (face == split.wedge)
        {
            set_outer(mesh, across, size - 1, i);
            break;
        }
        corner = next_corner(across);
    }
    size_[i] = static_cast<std::int32_t>(size);
    share_[i] = 1.0F / static_cast<float>(size);
    kind_[i] = static_cast<std::int32_t>(split.kind);
}

void RingFrames::make_frames(std::size_t group)
{
    const auto size = load_lanes<Int4>(size_, group);
    const auto share = load_lanes<Float4>(share_, group);
    const auto kind = load_lanes<Int4>(kind_, group);
    const auto most =
        static_cast<std::size_t>(std::max(std::max(size[0], size[1]), std::max(size[2], size[3])));
    const auto inside = [&](std::size_t i) { return static_cast<std::int32_t>(i) < size; };
    std::array<Vectors4, kMostRing> ring;
    Vectors4 mean{};
    for (std::size_t i = 0; i < most; ++i)
    {
        ring[i] = load_vectors(position_[i], group);
        mean = mean + where(inside(i), ring[i]);
    }
    mean = mean * share;
    for (std::size_t i = 0; i < most; ++i)
    {
        ring[i] = ring[i] - mean;
    }
    RingSums sums;
    Vectors4 last{};
    for (std::size_t i = 0; i < most; ++i)
    {
        const Vectors4 outer = load_vectors(outer_[i], group) - mean;
        const Int4 outside = load_lanes<Int4>(has_outer_[i], group) & inside(i);
        const Vectors4 next = i + 1 < most ? choose(inside(i + 1), ring[i + 1], ring[0]) : ring[0];
        add_edge(sums, ring[i], next, outer, inside(i), outside);
        last = choose(inside(i), ring[i], last);
    }
    BasicFrame<Float4> frame;
    frame.centre = mean;
    const Int4 boundary = kind != static_cast<std::int32_t>(SplitKind::Interior);
    if (any(boundary))
    {
        const Int4 left = kind == static_cast<std::int32_t>(SplitKind::BoundaryLeft);
        const Vectors4 middle = (ring[0] + choose(left, last, ring[1])) * 0.5F;
        frame.centre = choose(boundary, mean + middle, mean);
        ring[0] = choose(boundary, ring[0] - middle, ring[0]);
        sums.weighted =
            choose(boundary, sums.weighted - middle * (2.0F * sums.length), sums.weighted);
        sums.outer_plane =
            boundary ? sums.outer_plane - dot(sums.outer_area, middle) : sums.outer_plane;
    }
    finish_frame(frame, sums, share, ring[0]);
    frames_[group] = frame;
}

void RingFrames::compute(const RefinementMesh& mesh, std::span<const Split> splits)
{
    VSPLIT_ASSERT(splits.size() <= kMost);
    for (std::size_t i = 0; i < splits.size(); ++i)
    {
        collect_ring(mesh, splits[i], i);
    }
    for (std::size_t group = 0; group * kLanes < splits.size(); ++group)
    {
        make_frames(group);
    }
}

void RingFrames::predict(const PredictionWeights& weights)
{
    for (std::size_t group = 0; group < frames_.size(); ++group)
    {
        expected_[group] = codec::predict(frames_[group], weights);
    }
}

RingFrame RingFrames::frame(std::size_t i) const
{
    const auto& four = frames_[i / kLanes];
    const std::size_t lane = i % kLanes;
    const auto pick = [&](const Vectors4& v) { return Vector3{v.x[lane], v.y[lane], v.z[lane]}; };
    return {
        pick(four.centre),
        pick(four.normal),
        pick(four.to_kept),
        pick(four.to_mean),
        {four.heights[0][lane], four.heights[1][lane], four.heights[2][lane]},
        four.radius[lane],
    };
}

std::vector<RingFrame> ring_frames(const RefinementMesh& mesh, std::span<const Split> splits)
{
    std::vector<RingFrame> result;
    result.reserve(splits.size());
    RingFrames frames;
    for (std::size_t first = 0; first < splits.size(); first += RingFrames::kMost)
    {
        const auto part = splits.subspan(first, std::min(RingFrames::kMost, splits.size() - first));
        frames.compute(mesh, part);
        for (std::size_t i = 0; i < part.size(); ++i)
        {
            result.push_back(frames.frame(i));
        }
    }
    return result;
}

}  // namespace vsplit::codec
