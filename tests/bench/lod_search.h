#pragma once

#include "core/result.h"
#include "lod_ladder.h"
#include "mesh/indexed_mesh.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vsplit::bench {

/// A level of detail, coded by Draco, and what it shows.
struct LodFile
{
    std::size_t level = 0;  ///< Of the ladder.
    int bits = 0;           ///< Quantisation bits of the positions.
    std::size_t bytes = 0;
    double rms = 0.0;   ///< Surface distance of the decoded mesh to the original, model units.
    double max = 0.0;   ///< Hausdorff distance, sampled, model units.
    IndexedMesh shown;  ///< The decoded mesh.
};

/// Bounds of a search.
struct LodSearchOptions
{
    int fewest_bits = 5;
    int most_bits = 12;
    std::size_t samples = 60000;  ///< Points a side for the distances that choose.
    std::size_t keep_by_rms = 2;  ///< Files to keep for their rms.
    std::size_t keep_by_max = 2;  ///< Files to keep for their Hausdorff distance.
};

/// Looks for the best single files of at most so many bytes.
class LodSearch
{
public:
    /// Prepares a search for `mesh` among the levels of `ladder`, which must outlive it.
    LodSearch(const IndexedMesh& mesh, LodLadder& ladder, const LodSearchOptions& options);
    ~LodSearch();

    /// For every number of bits takes the largest levels whose file fits, measures them, and keeps those
    /// with the least rms, then those with the least Hausdorff distance, without repetition.
    /// Result: empty when nothing fits. Errors: those of Draco.
    [[nodiscard]] Result<std::vector<LodFile>> best_files(std::size_t bytes);

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vsplit::bench
