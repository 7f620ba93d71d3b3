#include "lod_search.h"

#include "draco_mesh.h"
#include "mesh/surface_distance.h"
#include "mesh_metrics.h"

#include <algorithm>
#include <map>
#include <utility>

namespace vsplit::bench {
namespace {

/// Fewer triangles than this are no picture of anything, and Draco needs some to start from.
constexpr std::size_t kFewestTriangles = 4;

/// Files within this factor of the best one at a rate get their smaller neighbours tried, too:
/// neither rms nor Hausdorff distance falls steadily with the size.
constexpr double kWorthALook = 1.12;
constexpr std::size_t kNeighbours = 4;

using Key = std::pair<std::size_t, int>;  // level, bits

}  // namespace

class LodSearch::Impl
{
public:
    Impl(const IndexedMesh& mesh, LodLadder& ladder, const LodSearchOptions& options)
        : ladder_(ladder),
          options_(options),
          reference_(to_floats(mesh), mesh.triangles, options.samples)
    {
    }

    Result<std::vector<LodFile>> best_files(std::size_t bytes)
    {
        std::vector<Key> tried;
        for (int bits = options_.fewest_bits; bits <= options_.most_bits; ++bits)
        {
            const auto level = largest_that_fits(bits, bytes);
            VSPLIT_TRY(level);
            if (*level < ladder_.size())
            {
                tried.emplace_back(*level, bits);
                VSPLIT_TRY(measure(tried.back()));
            }
        }
        VSPLIT_TRY(try_neighbours(bytes, tried));
        return pick(std::move(tried));
    }

private:
    /// The index of the largest level whose file fits; the ladder's size when none does.
    Result<std::size_t> largest_that_fits(int bits, std::size_t bytes)
    {
        std::size_t low = 0, high = ladder_.size();
        while (low < high)
        {
            const std::size_t middle = (low + high) / 2;
            const auto size = file_bytes({middle, bits});
            VSPLIT_TRY(size);
            *size <= bytes ? high = middle : low = middle + 1;
        }
        return low;
    }

    /// Bytes of a file; 0, which always fits, when the level has too few triangles to be one.
    Result<std::size_t> file_bytes(Key key)
    {
        const auto known = bytes_.find(key);
        if (known != bytes_.end())
        {
            return known->second;
        }
        std::size_t bytes = 0;
        const IndexedMesh& mesh = ladder_.level(key.first);
        if (mesh.triangles.size() >= kFewestTriangles)
        {
            const auto file = encode_with_draco(mesh, key.second);
            VSPLIT_TRY(file);
            bytes = file->size();
        }
        bytes_[key] = bytes;
        return bytes;
    }

    Result<void> measure(Key key)
    {
        if (files_.contains(key) || ladder_.level(key.first).triangles.size() < kFewestTriangles)
        {
            return {};
        }
        const auto coded = encode_with_draco(ladder_.level(key.first), key.second);
        VSPLIT_TRY(coded);
        const auto decoded = decode_with_draco(*coded);
        VSPLIT_TRY(decoded);
        LodFile file;
        file.level = key.first;
        file.bits = key.second;
        file.bytes = coded->size();
        file.shown = copy_out(**decoded);
        const SurfaceDistance distance =
            reference_.measure(to_floats(file.shown), file.shown.triangles);
        file.rms = distance.rms;
        file.max = distance.max;
        files_.emplace(key, std::move(file));
        return {};
    }

    /// Adds the next smaller levels of everything that is about as good as the best.
    Result<void> try_neighbours(std::size_t bytes, std::vector<Key>& tried)
    {
        std::erase_if(tried, [&](Key key) { return !files_.contains(key); });
        if (tried.empty())
        {
            return {};
        }
        const double least_rms = files_.at(best(tried, &LodFile::rms)).rms;
        const double least_max = files_.at(best(tried, &LodFile::max)).max;
        for (const Key& key : std::vector<Key>(tried))
        {
            const LodFile& file = files_.at(key);
            const bool good =
                file.rms < kWorthALook * least_rms || file.max < kWorthALook * least_max;
            const std::size_t end = std::min(key.first + kNeighbours + 1, ladder_.size());
            for (std::size_t level = key.first + 1; good && level < end; ++level)
            {
                const Key next{level, key.second};
                VSPLIT_TRY(measure(next));
                if (files_.contains(next) && files_.at(next).bytes <= bytes)
                {
                    tried.push_back(next);
                }
            }
        }
        return {};
    }

    Key best(const std::vector<Key>& keys, double LodFile::*figure) const
    {
        return *std::ranges::min_element(keys, {}, [&](Key key) { return files_.at(key).*figure; });
    }

    std::vector<LodFile> pick(std::vector<Key> tried) const
    {
        std::vector<LodFile> picked;
        const auto take_best = [&](std::size_t count, double LodFile::*figure) {
            for (std::size_t i = 0; i < count && !tried.empty(); ++i)
            {
                const Key key = best(tried, figure);
                picked.push_back(files_.at(key));
                std::erase(tried, key);
            }
        };
        take_best(options_.keep_by_rms, &LodFile::rms);
        take_best(options_.keep_by_max, &LodFile::max);
        return picked;
    }

    LodLadder& ladder_;
    LodSearchOptions options_;
    DistanceReference reference_;
    std::map<Key, std::size_t> bytes_;
    std::map<Key, LodFile> files_;
};

LodSearch::LodSearch(const IndexedMesh& mesh, LodLadder& ladder, const LodSearchOptions& options)
    : impl_(std::make_unique<Impl>(mesh, ladder, options))
{
}

LodSearch::~LodSearch() = default;

Result<std::vector<LodFile>> LodSearch::best_files(std::size_t bytes)
{
    return impl_->best_files(bytes);
}

}  // namespace vsplit::bench
