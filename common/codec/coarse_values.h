#pragma once

#include "codec/stream_encoder.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vsplit::codec {

/// Length at which a chunk of attributes is closed: one more step keeps it within proto::kTargetChunkBytes.
inline constexpr std::size_t kFullChunk = 48U * 1024U;

/// Chooses for each level how many low bits its texture coordinates do without: as many as make their steps
/// about as long on the surface as a cell of its positions or two.
class CoarseValues
{
public:
    /// Measures how texture coordinates stretch over the mesh. `plan`: must outlive this.
    explicit CoarseValues(const StreamPlan& plan);

    /// By attribute the bits that the next level does without; none more than the level before.
    /// `shift`: of the level; `known`: wedges that have values and would gain bits.
    [[nodiscard]] std::vector<std::uint8_t> lacking(int shift, std::size_t known);

private:
    const StreamPlan& plan_;
    std::vector<double> stretch_;      ///< By attribute numbers a cell of the full grid.
    std::vector<std::uint8_t> lacks_;  ///< Of the level before; empty before the first one.
};

}  // namespace vsplit::codec
