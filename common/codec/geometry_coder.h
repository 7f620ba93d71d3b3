#pragma once

// Based on: Wang, Yang, "3D Models Simplification Algorithm for Mobile Devices" (subset placement: the
// removed vertex returns to its own position); Taubin, Rossignac, "Geometric Compression through
// Topological Surgery", 1998 (linear prediction from neighbours). The removed vertex's ring is known
// completely, so it is predicted from the ring's mean, its tangent planes and the faces around it; the
// axis along which the surface is steepest is coded last, given the other two.

#include "codec/context_model.h"
#include "codec/float_log.h"
#include "codec/refinement_mesh.h"
#include "codec/vector3.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

namespace vsplit::codec {

/// Learned statistics of position residuals. Kept over the whole stream.
struct GeometryModel
{
    /// By boundary and ring radius in half octaves; for the first two axes.
    std::array<std::array<IntegerModel, 32>, 2> tangential{};
    /// By the expected normal displacement in half octaves; for the last axis.
    std::array<IntegerModel, 48> normal{};
};

/// Weights of the linear prediction, 1/64: normal displacement from the outer faces, from the kept
/// vertex, from the weighted mean; tangential displacement towards the kept vertex, towards the
/// weighted mean.
using PredictionWeights = std::array<std::int8_t, 5>;

inline constexpr PredictionWeights kInitialWeights{26, 6, 3, 11, 16};

/// What the ring of a removed vertex tells about its position.
struct RingFrame
{
    Vector3 centre;  ///< Mean of the ring; on a boundary the mid-point of its two neighbours there.
    Vector3 normal;  ///< Unit normal of the ring's polygon.
    Vector3 to_kept;  ///< Tangential part of kept - centre.
    Vector3 to_mean;  ///< Tangential part of (mean weighted by edge length) - centre.
    std::array<float, 3> heights{};  ///< Tangent-plane offset; kept and weighted mean along normal.
    float radius = 0.5F;             ///< Root mean square distance of the ring from its mean.
};

/// The ring of a removed vertex before its split is applied: positions counter-clockwise, the kept
/// vertex first, and for each edge the vertex across from it outside, if there is one.
struct Ring
{
    static constexpr std::size_t kMost = kMaxWedge + 2;
    std::array<Vector3, kMost> position{};
    std::array<Vector3, kMost> outer{};
    std::array<bool, kMost> has_outer{};
    std::size_t size = 0;
};

/// Collects the ring of a split. Precondition: the split is not applied yet.
[[nodiscard]] inline Ring collect_ring(const RefinementMesh& mesh, const Split& split)
{
    Ring ring;
    const Point* const points = mesh.points();
    const auto set_outer = [&](std::size_t edge, Corner across) {
        ring.has_outer[edge] = across >= 0;
        ring.outer[edge] = to_vector(points[across >= 0 ? mesh.vertex(across) : 0]);
    };
    Corner corner = split.first;
    ring.position[0] = to_vector(points[mesh.vertex(corner)]);
    ring.position[1] = to_vector(points[mesh.vertex(next_corner(corner))]);
    set_outer(0, mesh.opposite(previous_corner(corner)));
    ring.size = 2;
    for (int i = 0; i < split.wedge; ++i)
    {
        ring.position[ring.size++] = to_vector(points[mesh.vertex(previous_corner(corner))]);
        set_outer(static_cast<std::size_t>(i) + 1, mesh.opposite(corner));
        if (i + 1 < split.wedge)
        {
            corner = next_corner(mesh.opposite(next_corner(corner)));
        }
    }
    set_outer(static_cast<std::size_t>(split.wedge) + 1, mesh.opposite(next_corner(corner)));
    return ring;
}

/// Sums over the edges of a ring.
struct RingSums
{
    Vector3 area{};            ///< Twice the vector area (Newell).
    Vector3 weighted{};        ///< Sum of edge length * (both ends).
    Vector3 outer_area{};      ///< Sum of the outer faces' vector areas.
    float length = 0.0F;       ///< Sum of edge lengths.
    float square = 0.0F;       ///< Sum of squared distances from the mean.
    float outer_plane = 0.0F;  ///< Sum of outer vector area . ring vertex.
};

/// Sums over the edges of a ring whose positions are relative to `mean`.
[[nodiscard]] inline RingSums sum_ring(const Ring& ring, const Vector3& mean)
{
    RingSums sums;
    for (std::size_t i = 0; i < ring.size; ++i)
    {
        const Vector3& a = ring.position[i];
        const Vector3& b = ring.position[i + 1 < ring.size ? i + 1 : 0];
        const Vector3 edge = b - a;
        const float length = std::sqrt(dot(edge, edge));
        sums.area = sums.area + cross(a, b);
        sums.length += length;
        sums.weighted = sums.weighted + (a + b) * length;
        sums.square += dot(a, a);
        if (ring.has_outer[i])
        {
            const Vector3 area = cross(ring.outer[i] - mean - a, edge);
            sums.outer_area = sums.outer_area + area;
            sums.outer_plane += dot(area, a);
        }
    }
    return sums;
}

/// Offset along the normal at which the tangent planes of the outer faces meet it, within +-radius;
/// 0 where those faces look away.
[[nodiscard]] inline float tangent_plane_offset(const RingSums& sums, const RingFrame& frame)
{
    const float along = dot(sums.outer_area, frame.normal);
    // cos^2 of about 76 degrees: beyond, the planes say nothing.
    if (!(along > 0.0F) || !(along * along > 0.06F * dot(sums.outer_area, sums.outer_area)))
    {
        return 0.0F;
    }
    const float offset = sums.outer_plane / along;
    return offset < -frame.radius ? -frame.radius : offset > frame.radius ? frame.radius : offset;
}

/// Derives the frame in which a removed vertex is predicted.
/// Source: proto/STREAM_FORMAT.md, "Prediction".
[[nodiscard]] inline RingFrame make_frame(Ring ring, SplitKind kind)
{
    const float share = 1.0F / static_cast<float>(ring.size);
    Vector3 mean{};
    for (std::size_t i = 0; i < ring.size; ++i)
    {
        mean = mean + ring.position[i];
    }
    mean = mean * share;
    for (std::size_t i = 0; i < ring.size; ++i)
    {
        ring.position[i] = ring.position[i] - mean;
    }
    RingSums sums = sum_ring(ring, mean);
    RingFrame frame;
    frame.centre = mean;
    if (kind != SplitKind::Interior)
    {
        const Vector3& other = ring.position[kind == SplitKind::BoundaryLeft ? ring.size - 1 : 1];
        const Vector3 middle = (ring.position[0] + other) * 0.5F;
        frame.centre = mean + middle;
        ring.position[0] = ring.position[0] - middle;
        sums.weighted = sums.weighted - middle * (2.0F * sums.length);
        sums.outer_plane -= dot(sums.outer_area, middle);
    }
    const float area = dot(sums.area, sums.area);
    frame.normal = area > 0.0F ? sums.area * (1.0F / std::sqrt(area)) : Vector3{0.0F, 0.0F, 1.0F};
    const float radius = std::sqrt(sums.square * share);
    frame.radius = radius < 0.5F ? 0.5F : radius;
    const Vector3 weighted =
        sums.length > 0.0F ? sums.weighted * (0.5F / sums.length) : sums.weighted;
    frame.heights = {
        tangent_plane_offset(sums, frame),
        dot(ring.position[0], frame.normal),
        dot(weighted, frame.normal),
    };
    frame.to_kept = ring.position[0] - frame.normal * frame.heights[1];
    frame.to_mean = weighted - frame.normal * frame.heights[2];
    return frame;
}

/// Predicts the removed vertex's position from its ring.
[[nodiscard]] inline Vector3 predict(const RingFrame& frame, const PredictionWeights& weights)
{
    constexpr float kUnit = 1.0F / 64.0F;
    const auto weight = [&](std::size_t i) { return static_cast<float>(weights[i]) * kUnit; };
    float height =
        frame.heights[0] * weight(0) + frame.heights[1] * weight(1) + frame.heights[2] * weight(2);
    height = height < -frame.radius ? -frame.radius : height > frame.radius ? frame.radius : height;
    return frame.centre + frame.to_kept * weight(3) + frame.to_mean * weight(4) +
           frame.normal * height;
}

/// Rounds half up. Precondition: |value| < 2^30.
[[nodiscard]] inline std::int32_t round_half_up(float value)
{
    const float shifted = value + 0.5F;
    const auto whole = static_cast<std::int32_t>(shifted);
    return whole - (static_cast<float>(whole) > shifted ? 1 : 0);
}

/// Codes one coordinate against its expected value; returns the coordinate.
template <typename Coder>
inline std::int32_t code_coordinate(
    Coder& coder, IntegerModel& model, float expected, std::int32_t actual
)
{
    const std::int32_t rounded = round_half_up(expected);
    const float rest = expected - static_cast<float>(rounded);
    const std::size_t sign_context = std::size_t{1} + (rest > 0.17F) - (rest < -0.17F);
    return rounded + code_integer(coder, model, actual - rounded, sign_context);
}

/// Codes the position of one removed vertex. `Coder` is BitEncoder or BitDecoder.
/// `actual`: the position, used by the encoder only. Result: the position in grid units; the caller
/// checks that it lies within the grid.
template <typename Coder>
[[nodiscard]] inline std::array<std::int32_t, 3> code_position(
    Coder& coder,
    GeometryModel& model,
    const RingFrame& frame,
    const PredictionWeights& weights,
    bool boundary,
    const std::array<std::int32_t, 3>& actual
)
{
    const Vector3 mean = predict(frame, weights);
    const std::array<float, 3> expected{mean.x, mean.y, mean.z};
    const std::array<float, 3> normal{frame.normal.x, frame.normal.y, frame.normal.z};
    const std::array<float, 3> slope{
        std::fabs(normal[0]), std::fabs(normal[1]), std::fabs(normal[2])};
    const std::size_t last = slope[0] >= slope[1] && slope[0] >= slope[2] ? 0U
                             : slope[1] >= slope[2]                       ? 1U
                                                                          : 2U;
    const std::size_t first = last == 2 ? 0 : last + 1;
    const std::size_t second = last == 0 ? 2 : last - 1;
    auto& tangential = model.tangential[boundary ? 1 : 0][static_cast<std::size_t>(
        clamp_int(steps_log2<1>(frame.radius + 1.0F), 0, 31)
    )];
    auto& along = model.normal[static_cast<std::size_t>(clamp_int(
        steps_log2<1>(std::fabs(frame.heights[0]) * 0.5F + 0.02F * frame.radius + 0.3F) + 5, 0, 47
    ))];
    std::array<std::int32_t, 3> position{};
    position[first] = code_coordinate(coder, tangential, expected[first], actual[first]);
    position[second] = code_coordinate(coder, tangential, expected[second], actual[second]);
    // The point stays near the plane through the prediction: solve for the steepest axis.
    const float off_first = static_cast<float>(position[first]) - expected[first];
    const float off_second = static_cast<float>(position[second]) - expected[second];
    const float on_plane =
        expected[last] - (normal[first] * off_first + normal[second] * off_second) / normal[last];
    position[last] = code_coordinate(coder, along, on_plane, actual[last]);
    return position;
}

}  // namespace vsplit::codec
