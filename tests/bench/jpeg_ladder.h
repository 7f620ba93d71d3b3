#pragma once

#include "core/result.h"
#include "image/raster.h"
#include "picture/texture.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

namespace vsplit::bench {

/// An image as a JPEG file.
struct JpegFile
{
    std::size_t bytes = 0;
    std::uint32_t side = 0;  ///< Longest, pixels.
    int quality = 0;
    bool subsampled = false;
    double error = 0.0;  ///< Mean squared difference to the original where both are sampled.
    Raster shown;
};

/// Looks for the best progressive JPEG file of an image in so many bytes, at several sizes. Not thread safe.
class JpegLadder
{
public:
    /// Scales the image. `original`: with pixels; must outlive it.
    explicit JpegLadder(const Raster& original);

    /// The file of at most so many bytes that is closest to the original; without pixels where none
    /// fits. Errors: those of the JPEG library.
    [[nodiscard]] Result<JpegFile> best(std::size_t bytes);

    /// By size of the image the file of at most so many bytes that is closest to the original; sizes of
    /// which none fits are left out. Errors: those of the JPEG library.
    [[nodiscard]] Result<std::vector<JpegFile>> best_by_size(std::size_t bytes);

private:
    using Key = std::array<int, 3>;  // scale, subsampled, quality

    Result<std::size_t> bytes_of(Key key);
    Result<int> best_quality(int scale, int subsampled, std::size_t bytes);
    Result<const JpegFile*> file_of(Key key);

    std::vector<Raster> scaled_;
    picture::Texture original_;
    std::map<Key, std::size_t> bytes_;
    std::map<Key, JpegFile> files_;
};

}  // namespace vsplit::bench
