#pragma once

#include "picture/compare.h"
#include "picture/picture.h"
#include "precompute/chunk_order.h"

#include <map>
#include <utility>
#include <vector>

namespace vsplit::precompute {

/// How far each sequence has come: the stage of the shape, then by image the number of its chunks.
using OrderState = std::vector<std::uint32_t>;

/// Measures the image error of states of a model. Not thread safe.
class OrderPictures
{
public:
    /// Draws the original. Both must outlive it.
    OrderPictures(const OrderSource& source, const OrderOptions& options);

    /// True when an image is one that the pictures show.
    [[nodiscard]] bool is_drawn(std::size_t image) const { return drawn_[image]; }

    /// Mean squared error over all views; remembered. Images that are not drawn count with their own
    /// error. Errors: those of the callbacks.
    [[nodiscard]] Result<double> error(const OrderState& state);

    /// True when error() would have nothing to draw.
    [[nodiscard]] bool is_known(const OrderState& state) const;

    /// States drawn so far.
    [[nodiscard]] std::size_t drawn_states() const { return drawn_errors_.size(); }

private:
    [[nodiscard]] OrderState drawn_part(OrderState state) const;
    [[nodiscard]] Result<double> drawn_error(const OrderState& state);
    [[nodiscard]] Result<double> own_error(std::uint32_t image, std::uint32_t chunks);
    [[nodiscard]] Result<const Surface*> surface(std::uint32_t stage);
    [[nodiscard]] Result<picture::Texture> texture(std::uint32_t image, std::uint32_t chunks);

    const OrderSource& source_;
    const OrderOptions& options_;
    std::vector<bool> drawn_;
    std::vector<picture::View> views_;
    std::vector<picture::Picture> originals_;
    std::map<std::uint32_t, Surface> surfaces_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, picture::Texture> textures_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, double> own_errors_;
    std::map<OrderState, double> drawn_errors_;
};

}  // namespace vsplit::precompute
