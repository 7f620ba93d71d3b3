#pragma once

#include "mesh/surface.h"
#include "picture/picture.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::picture {

/// Pixels at which a level is torn.
struct CrackCount
{
    std::size_t background = 0;   ///< The background is seen.
    std::size_t see_through = 0;  ///< What lies behind the surface is seen, e.g. its far side.
    std::size_t judged = 0;       ///< Pixels that were looked at: where a crack could be told.

    /// All cracked pixels.
    [[nodiscard]] std::size_t cracked() const { return background + see_through; }
};

/// Finds pixels at which a level shows a crack that the original has not. A pixel is judged where the
/// original, as far around as the level may be displaced, is one sheet: covered without a gap, and without
/// a visible edge at which it ends or folds back. A displaced copy of such a sheet still covers
/// the pixel, and no deeper than the deepest point around it was; where the level shows something
/// deeper or the background, it is torn. So silhouettes may differ, and holes and slits of the original may
/// move, open and close, without a false alarm. Thread safe once made.
class CrackDetector
{
public:
    /// Draws the original. `original`: vertices at one place count as one; `size`: pixels a side.
    /// Cost: linear but for sorting the edges.
    CrackDetector(const Surface& original, std::span<const View> views, std::uint32_t size);

    /// Counts the cracked pixels of a level in all views.
    /// `max_error`: largest distance of the level to the original, model units.
    [[nodiscard]] CrackCount count(const Surface& level, double max_error) const;

    /// The views.
    [[nodiscard]] std::span<const View> views() const { return views_; }

    /// Marks the pixels of one view at which a level is torn. `picture`: the level in this view, of the
    /// detector's size. Precondition: view < views().size().
    /// Result: by pixel 0, or 1 for background, 2 for what lies behind; 3 where cracks cannot be told.
    [[nodiscard]] std::vector<std::uint8_t> mark(
        std::size_t view, const Picture& picture, double max_error
    ) const;

private:
    /// The original in one view.
    struct Reference
    {
        std::vector<float> depths;
        std::vector<std::uint8_t> ends;  ///< By pixel 1 where the sheet may end.
        double nearest_depth = 1.0;
    };

    std::vector<View> views_;
    std::uint32_t size_ = 0;
    std::vector<Reference> references_;
};

}  // namespace vsplit::picture
