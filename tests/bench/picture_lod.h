#pragma once

#include "core/result.h"
#include "picture_judge.h"

#include <cstddef>
#include <memory>
#include <string>

namespace vsplit::bench {

/// A level of detail of a textured model: a Draco file and a JPEG file.
struct PictureLod
{
    std::size_t geometry_bytes = 0;
    std::size_t image_bytes = 0;
    std::size_t faces = 0;
    int position_bits = 0;
    int tex_coord_bits = 0;
    int normal_bits = 0;     ///< 0: left out.
    std::uint32_t side = 0;  ///< Of the image, pixels.
    int quality = 0;         ///< Of the image.
    PictureFigures figures{};
    ShownModel shown;
};

/// Most bits that a level of detail may have.
struct PictureLodBits
{
    int position = 14;
    int tex_coord = 13;
    int normal = 10;
};

/// Looks for the best level of detail of a model with at most one image in so many bytes: simplified by
/// meshopt_simplify (which keeps seams), coded by Draco, with the image as JPEG; the choice of size, bits
/// and image is by what is seen.
class PictureLodSearch
{
public:
    /// Prepares. Both must outlive it. `original`: repaired; `image`: without pixels for none; `most`: bits, at
    /// least 7 for normals.
    PictureLodSearch(const ShownModel& original, const Raster& image, const PictureLodBits& most);
    ~PictureLodSearch();

    /// The file with the best PSNR of the final judge. Errors: those of Draco and of the JPEG library;
    /// Internal when nothing fits.
    [[nodiscard]] Result<PictureLod> best(std::size_t bytes, const PictureJudge& judge);

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vsplit::bench
