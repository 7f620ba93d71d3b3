#include "image/downsample.h"

#include "core/assert.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace vsplit::image {

namespace {

/// One weighed source pixel of a target pixel, along one axis.
struct Share
{
    std::uint32_t source = 0;
    std::uint32_t weight = 0;
};

/// For every target pixel of an axis the source pixels that it covers. In units of 1 / target of a
/// source pixel every target pixel is `source` units wide, so all weights are integers.
std::vector<std::vector<Share>> shares(std::uint32_t source, std::uint32_t target)
{
    std::vector<std::vector<Share>> result(target);
    for (std::uint64_t i = 0; i < target; ++i)
    {
        const std::uint64_t begin = i * source;
        const std::uint64_t end = begin + source;
        for (std::uint64_t pixel = begin / target; pixel * target < end; ++pixel)
        {
            const std::uint64_t low = std::max(begin, pixel * target);
            const std::uint64_t high = std::min(end, (pixel + 1) * target);
            result[i].push_back(
                {static_cast<std::uint32_t>(pixel), static_cast<std::uint32_t>(high - low)}
            );
        }
    }
    return result;
}

std::uint32_t scaled(std::uint32_t side, std::uint32_t longest, std::uint32_t max_size)
{
    const std::uint64_t product = std::uint64_t{side} * max_size + longest / 2;
    return static_cast<std::uint32_t>(std::max<std::uint64_t>(1, product / longest));
}

}  // namespace

Raster downsampled(const Raster& raster, std::uint32_t max_size)
{
    VSPLIT_ASSERT(raster.width >= 1 && raster.height >= 1 && max_size >= 1);
    const std::uint32_t longest = std::max(raster.width, raster.height);
    if (longest <= max_size)
    {
        return raster;
    }
    Raster result{
        .width = scaled(raster.width, longest, max_size),
        .height = scaled(raster.height, longest, max_size),
        .channels = raster.channels,
        .pixels = {},
    };
    result.pixels.reserve(std::size_t{result.width} * result.height * result.channels);
    const auto columns = shares(raster.width, result.width);
    const auto rows = shares(raster.height, result.height);
    const std::uint64_t area = std::uint64_t{raster.width} * raster.height;
    std::vector<std::uint64_t> sums(std::size_t{raster.width} * raster.channels);
    for (const auto& row : rows)
    {
        std::fill(sums.begin(), sums.end(), 0);
        for (const Share& share : row)
        {
            const std::uint8_t* const line = raster.pixels.data() + share.source * sums.size();
            for (std::size_t i = 0; i < sums.size(); ++i)
            {
                sums[i] += std::uint64_t{share.weight} * line[i];
            }
        }
        for (const auto& column : columns)
        {
            for (std::size_t channel = 0; channel < raster.channels; ++channel)
            {
                std::uint64_t sum = area / 2;
                for (const Share& share : column)
                {
                    sum +=
                        share.weight * sums[std::size_t{share.source} * raster.channels + channel];
                }
                result.pixels.push_back(static_cast<std::uint8_t>(sum / area));
            }
        }
    }
    return result;
}

}  // namespace vsplit::image
