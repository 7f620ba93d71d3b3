#pragma once

#include "image/raster.h"
#include "mesh/surface.h"
#include "picture/picture.h"
#include "scene/appearance.h"

#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::bench {

/// What is seen of a model: a level of detail, or the prefix of a stream.
struct ShownModel
{
    Surface surface;
    Appearance appearance;
    std::vector<picture::Texture> textures;  ///< By image.
};

/// How well something shows an original.
struct PictureFigures
{
    double psnr = 0.0;  ///< Mean over the views, dB, of the pixels that either covers.
    double ssim = 0.0;  ///< The same.
};

/// Compares what is shown with an original from several sides.
class PictureJudge
{
public:
    /// Draws the original. `views`: 1 .. 8; `side`: pixels.
    PictureJudge(const ShownModel& original, std::size_t views, std::uint32_t side);

    /// Measures. Deterministic.
    [[nodiscard]] PictureFigures judge(const ShownModel& shown) const;

    /// Draws the first view.
    [[nodiscard]] Raster first_view(const ShownModel& shown) const;

private:
    std::uint32_t side_;
    std::vector<picture::View> views_;
    std::vector<picture::Picture> originals_;
};

}  // namespace vsplit::bench
