#include "picture_judge.h"

#include "picture/compare.h"

namespace vsplit::bench {
namespace {

picture::Scene scene_of(const ShownModel& model)
{
    return {&model.surface, &model.appearance, model.textures};
}

}  // namespace

PictureJudge::PictureJudge(const ShownModel& original, std::size_t views, std::uint32_t side)
    : side_(side), views_(picture::corner_views(original.surface.mesh.positions, views))
{
    for (const picture::View& view : views_)
    {
        originals_.push_back(picture::draw(scene_of(original), view, {.size = side}));
    }
}

PictureFigures PictureJudge::judge(const ShownModel& shown) const
{
    PictureFigures mean;
    const auto count = static_cast<double>(views_.size());
    for (std::size_t v = 0; v < views_.size(); ++v)
    {
        const auto drawn = picture::draw(scene_of(shown), views_[v], {.size = side_});
        const auto difference =
            picture::compare(drawn, originals_[v], picture::Region::Silhouettes);
        mean.psnr += difference.psnr / count;
        mean.ssim += difference.ssim / count;
    }
    return mean;
}

Raster PictureJudge::first_view(const ShownModel& shown) const
{
    return {
        side_, side_, 3, picture::draw(scene_of(shown), views_.front(), {.size = side_}).colors};
}

}  // namespace vsplit::bench
