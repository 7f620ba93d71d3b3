#pragma once

// Based on: Wang, Yang, "3D Models Simplification Algorithm for Mobile Devices" (subset placement: the
// removed vertex returns to its own position); Taubin, Rossignac, "Geometric Compression through
// Topological Surgery", 1998 (linear prediction from neighbours). The removed vertex's ring is known
// completely, so it is predicted from the ring's mean, its tangent planes and the faces around it.

#include "codec/refinement_mesh.h"
#include "codec/vector3.h"
#include "mesh/lanes.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::codec {

/// Weights of the linear prediction, 1/64: normal displacement from the outer faces, from the kept
/// vertex, from the weighted mean; tangential displacement towards the kept vertex, towards the
/// weighted mean.
using PredictionWeights = std::array<std::int8_t, 5>;

inline constexpr PredictionWeights kInitialWeights{26, 6, 3, 11, 16};

/// What the ring of a removed vertex tells about its position. `Scalar`: float, or lanes::Float4 for
/// four vertices at once.
template <typename Scalar>
struct BasicFrame
{
    /// One vector for each lane of Scalar.
    using Vector = BasicVector<Scalar>;
    Vector centre;   ///< Mean of the ring; on a boundary the mid-point of its two neighbours there.
    Vector normal;   ///< Unit normal of the ring's polygon.
    Vector to_kept;  ///< Tangential part of kept - centre.
    Vector to_mean;  ///< Tangential part of (mean weighted by edge length) - centre.
    std::array<Scalar, 3> heights{};  ///< Tangent-plane offset; kept, weighted mean along normal.
    Scalar radius{};                  ///< Root mean square distance of the ring from its mean.
};

/// The frame of one removed vertex.
using RingFrame = BasicFrame<float>;

/// Keeps a value within -limit .. limit.
template <typename Scalar>
[[nodiscard]] inline Scalar clamp_to(Scalar value, Scalar limit)
{
    const Scalar raised = value < -limit ? -limit : value;
    return raised > limit ? limit : raised;
}

/// Predicts the removed vertex's position from its ring.
template <typename Scalar>
[[nodiscard]] inline BasicVector<Scalar> predict(
    const BasicFrame<Scalar>& frame, const PredictionWeights& weights
)
{
    constexpr float kUnit = 1.0F / 64.0F;
    const auto weight = [&](std::size_t i) { return static_cast<float>(weights[i]) * kUnit; };
    const Scalar height = clamp_to<Scalar>(
        frame.heights[0] * weight(0) + frame.heights[1] * weight(1) + frame.heights[2] * weight(2),
        frame.radius
    );
    return frame.centre + frame.to_kept * weight(3) + frame.to_mean * weight(4) +
           frame.normal * height;
}

/// What the coding of one position needs to know of its frame.
struct Prediction
{
    std::array<float, 3> expected{};  ///< The position, grid units of the level.
    std::array<float, 3> normal{};    ///< BasicFrame::normal.
    float height = 0.0F;              ///< Tangent-plane offset.
    float radius = 0.0F;              ///< BasicFrame::radius.
};

/// The frames of a few splits, computed four at a time. Holds no memory on the heap. Not thread safe.
class RingFrames
{
public:
    /// Most splits.
    static constexpr std::size_t kMost = 16;

    /// Computes the frames of splits that are not applied yet. `splits`: at most kMost.
    /// Source: proto/STREAM_FORMAT.md, "Prediction".
    void compute(const RefinementMesh& mesh, std::span<const Split> splits);

    /// Predicts the positions of all splits. Precondition: compute() was called.
    void predict(const PredictionWeights& weights);

    /// The frame of the `i`-th split of compute().
    [[nodiscard]] RingFrame frame(std::size_t i) const;

    /// The prediction of the `i`-th split of compute(). Precondition: predict() was called.
    [[nodiscard]] Prediction prediction(std::size_t i) const
    {
        const std::size_t group = i / kLanes;
        const std::size_t lane = i % kLanes;
        const auto& frame = frames_[group];
        const auto& expected = expected_[group];
        return {
            {expected.x[lane], expected.y[lane], expected.z[lane]},
            {frame.normal.x[lane], frame.normal.y[lane], frame.normal.z[lane]},
            frame.heights[0][lane],
            frame.radius[lane],
        };
    }

private:
    static constexpr std::size_t kLanes = 4;
    static constexpr std::size_t kMostRing = kMaxWedge + 2;
    using Floats = std::array<float, kMost>;
    using Numbers = std::array<std::int32_t, kMost>;
    using Vectors = std::array<Floats, 3>;  ///< x, y and z of every split.

    void collect_ring(const RefinementMesh& mesh, const Split& split, std::size_t i);
    void set_outer(const RefinementMesh& mesh, Corner across, std::size_t edge, std::size_t i);
    void make_frames(std::size_t group);

    // Rings before the splits, counter-clockwise, the kept vertex first, and for each edge the vertex
    // across from it outside, if there is one.
    std::array<Vectors, kMostRing> position_{};
    std::array<Vectors, kMostRing> outer_{};
    std::array<Numbers, kMostRing> has_outer_{};  ///< Masks.
    Numbers size_{};
    Floats share_{};  ///< 1 / size.
    Numbers kind_{};

    std::array<BasicFrame<lanes::Float4>, kMost / kLanes> frames_{};
    std::array<BasicVector<lanes::Float4>, kMost / kLanes> expected_{};
};

/// The frames of all of a chunk's splits, for the encoder's choice of weights.
[[nodiscard]] std::vector<RingFrame> ring_frames(
    const RefinementMesh& mesh, std::span<const Split> splits
);

}  // namespace vsplit::codec
