#include "precompute/order_pictures.h"

#include "picture/view.h"

#include <algorithm>

namespace vsplit::precompute {
namespace {

/// Share of its own error that an image which is not drawn (a normal map, roughness) adds to the picture's:
/// it changes the light, not the colour.
constexpr double kUnseenShare = 1.0 / 16.0;

/// Mean squared difference of an image to its original, sampled where the smaller one has pixels.
double image_error(const Raster& shown, const Raster& original)
{
    const std::uint32_t width = std::min(shown.width, original.width);
    const std::uint32_t height = std::min(shown.height, original.height);
    const std::size_t channels = std::min(shown.channels, original.channels);
    std::uint64_t sum = 0;
    for (std::uint64_t y = 0; y < height; ++y)
    {
        for (std::uint64_t x = 0; x < width; ++x)
        {
            const auto place = [&](const Raster& image) {
                const std::uint64_t row = y * image.height / height;
                return (row * image.width + x * image.width / width) * image.channels;
            };
            for (std::size_t k = 0; k < channels; ++k)
            {
                const int step =
                    shown.pixels[place(shown) + k] - original.pixels[place(original) + k];
                sum += static_cast<std::uint64_t>(step * step);
            }
        }
    }
    const std::uint64_t count = std::uint64_t{width} * height * channels;
    return count == 0 ? 0.0 : static_cast<double>(sum) / static_cast<double>(count);
}

std::vector<bool> find_drawn(const OrderSource& source)
{
    std::vector<bool> drawn(source.texture_bytes.size(), false);
    for (const Material& material : source.appearance->materials)
    {
        const std::int32_t image = material.base_color_texture.image;
        if (image >= 0 && static_cast<std::size_t>(image) < drawn.size())
        {
            drawn[static_cast<std::size_t>(image)] = true;
        }
    }
    return drawn;
}

}  // namespace

OrderPictures::OrderPictures(const OrderSource& source, const OrderOptions& options)
    : source_(source),
      options_(options),
      drawn_(find_drawn(source)),
      views_(picture::corner_views(source.original->mesh.positions, options.views))
{
    std::vector<picture::Texture> textures;
    for (std::size_t i = 0; i < drawn_.size(); ++i)
    {
        textures.push_back(
            drawn_[i] ? picture::Texture(source.original_images[i]) : picture::Texture()
        );
    }
    const picture::Scene scene{source.original, source.appearance, textures};
    for (const picture::View& view : views_)
    {
        originals_.push_back(picture::draw(scene, view, {.size = options.picture_side}));
    }
}

OrderState OrderPictures::drawn_part(OrderState state) const
{
    for (std::size_t i = 0; i < drawn_.size(); ++i)
    {
        state[i + 1] = drawn_[i] ? state[i + 1] : 0;
    }
    return state;
}

bool OrderPictures::is_known(const OrderState& state) const
{
    return drawn_errors_.contains(drawn_part(state));
}

Result<double> OrderPictures::error(const OrderState& state)
{
    auto sum = drawn_error(drawn_part(state));
    VSPLIT_TRY(sum);
    for (std::uint32_t i = 0; i < drawn_.size(); ++i)
    {
        if (!drawn_[i])
        {
            const auto own = own_error(i, state[i + 1]);
            VSPLIT_TRY(own);
            *sum += kUnseenShare * *own;
        }
    }
    return sum;
}

Result<double> OrderPictures::drawn_error(const OrderState& state)
{
    const auto known = drawn_errors_.find(state);
    if (known != drawn_errors_.end())
    {
        return known->second;
    }
    const auto shown = surface(state[0]);
    VSPLIT_TRY(shown);
    std::vector<picture::Texture> textures;
    for (std::uint32_t i = 0; i < drawn_.size(); ++i)
    {
        auto made = texture(i, state[i + 1]);
        VSPLIT_TRY(made);
        textures.push_back(std::move(*made));
    }
    const picture::Scene scene{*shown, source_.appearance, textures};
    picture::SquaredDifference total;
    for (std::size_t v = 0; v < views_.size(); ++v)
    {
        const auto seen = picture::draw(scene, views_[v], {.size = options_.picture_side});
        const auto part = picture::squared_difference(seen, originals_[v], picture::Region::All);
        total.sum += part.sum;
        total.pixels += part.pixels;
    }
    return drawn_errors_[state] = total.mean();
}

Result<double> OrderPictures::own_error(std::uint32_t image, std::uint32_t chunks)
{
    if (chunks == 0)
    {
        constexpr double kNothingShown = 4096.0;  // as wrong as a quarter of the range
        return source_.texture_bytes[image].empty() ? 0.0 : kNothingShown;
    }
    const auto known = own_errors_.find({image, chunks});
    if (known != own_errors_.end())
    {
        return known->second;
    }
    const auto shown = source_.image(image, chunks);
    VSPLIT_TRY(shown);
    return own_errors_[{image, chunks}] = image_error(*shown, source_.original_images[image]);
}

Result<const Surface*> OrderPictures::surface(std::uint32_t stage)
{
    const auto known = surfaces_.find(stage);
    if (known != surfaces_.end())
    {
        return &known->second;
    }
    auto made = source_.stage(stage);
    VSPLIT_TRY(made);
    // An order only goes up: earlier stages are hardly asked for again.
    constexpr std::size_t kKept = 6;
    if (surfaces_.size() >= kKept)
    {
        surfaces_.erase(surfaces_.begin());
    }
    return &(surfaces_[stage] = std::move(*made));
}

Result<picture::Texture> OrderPictures::texture(std::uint32_t image, std::uint32_t chunks)
{
    if (chunks == 0)
    {
        return picture::Texture();
    }
    const auto known = textures_.find({image, chunks});
    if (known != textures_.end())
    {
        return known->second;
    }
    const auto shown = source_.image(image, chunks);
    VSPLIT_TRY(shown);
    return textures_[{image, chunks}] = picture::Texture(*shown);
}

}  // namespace vsplit::precompute
