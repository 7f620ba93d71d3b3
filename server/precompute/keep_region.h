#pragma once

#include "core/result.h"
#include "mesh/indexed_mesh.h"

#include <array>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

namespace vsplit::precompute {

/// A ball whose vertices a publisher wants to keep for long.
struct KeepSphere
{
    std::array<double, 3> centre{};  ///< Model units.
    double radius = 0.0;             ///< Model units, > 0.
};

/// Reads "x,y,z,r". `text`: four decimal numbers separated by commas, the last one positive.
/// Error: BadRequest. Thread safe. Safe on untrusted input.
[[nodiscard]] Result<KeepSphere> parse_keep_sphere(std::string_view text);

/// Gives every vertex in a ball the importance 1 and leaves the others alone.
/// `importance`: one number for each vertex of `mesh`. Result: how many vertices lie in the ball.
/// Precondition: the lengths agree. Cost: linear. Thread safe.
std::size_t mark_sphere(
    const IndexedMesh& mesh, const KeepSphere& sphere, std::span<float> importance
);

/// Reads a mask: a text of one number for each vertex of the mesh as its file has them, separated by
/// blanks or line ends; 0 for an ordinary vertex, 1 for one to keep, anything between for a weight.
/// Errors: NotFound, IoError, InputTooLarge (the file); UnsupportedInput (a word that is not such a
/// number, with its line; more or fewer numbers than `vertex_count`).
/// Cost: linear in the file. Thread safe. Safe on untrusted input.
[[nodiscard]] Result<std::vector<float>> read_keep_mask(
    const std::filesystem::path& path, std::size_t vertex_count
);

}  // namespace vsplit::precompute
