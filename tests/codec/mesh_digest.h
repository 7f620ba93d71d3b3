#pragma once

#include "codec/level_attributes.h"
#include "mesh/indexed_mesh.h"

#include <cstdint>
#include <span>
#include <string>

namespace vsplit::test {

/// First line of a description: what the columns of the levels are.
inline constexpr const char* kDigestHead = "level vertices faces shift positions triangles\n";

/// A line with a level's counts, its shift and the checksums of its positions (units of 2^shift cells) and
/// triangles.
[[nodiscard]] std::string describe_level(std::uint32_t level, int shift, const GridMesh& mesh);

/// A line with the number of wedges and the checksums of their vertices, of those at the triangles' corners, of
/// groups, and of the coded numbers of every attribute; "-" stands for what there is none of.
[[nodiscard]] std::string describe_attributes(const codec::LevelAttributes& attributes);

/// A line with the checksum of the stitches; empty when there are none.
[[nodiscard]] std::string describe_stitches(std::span<const std::uint32_t> stitches);

}  // namespace vsplit::test
