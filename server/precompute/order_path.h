#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace vsplit::precompute {

/// The errors of pictures that show one state of each of two sequences.
struct ErrorTable
{
    /// By sequence and state the bytes up to it, ascending; no sequence is empty.
    std::array<std::vector<double>, 2> bytes;
    std::vector<double>
        errors;  ///< Of state i of the first and j of the second: [i * size of second + j].
};

/// Finds the way from the first states of both sequences to the last ones on which pictures are good
/// soonest: the mean of the decibels, over the logarithm of the bytes, is the highest. Unlike the steepest
/// next step it sees what only pays when it has come in both sequences.
/// Precondition: bytes of the first states together above 0, as many errors as pairs, none negative.
/// Result: for every step the sequence that goes on. Cost: linear in the pairs. Deterministic. Thread safe.
/// Source: Bellman, "Dynamic Programming", 1957.
[[nodiscard]] std::vector<std::size_t> best_path(const ErrorTable& table);

}  // namespace vsplit::precompute
