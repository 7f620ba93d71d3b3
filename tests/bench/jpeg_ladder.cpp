#include "jpeg_ladder.h"

#include "image/downsample.h"
#include "image/image_file.h"

#include <algorithm>

namespace vsplit::bench {
namespace {

/// Sixteenths of the original's sides.
constexpr std::array<std::uint32_t, 8> kScales{16, 12, 8, 6, 4, 3, 2, 1};
constexpr std::array<int, 20> kQualities{2,  4,  6,  8,  10, 13, 16, 20, 25, 30,
                                         36, 43, 50, 57, 64, 71, 78, 84, 90, 95};
constexpr std::uint32_t kSamples = 512;  // a side

double sampled_error(const picture::Texture& a, const picture::Texture& b)
{
    const auto footprint = [](const picture::Texture& texture) {
        const double step = static_cast<double>(std::max(texture.width(), texture.height()));
        return step / kSamples * step / kSamples;
    };
    double sum = 0.0;
    for (std::uint32_t y = 0; y < kSamples; ++y)
    {
        for (std::uint32_t x = 0; x < kSamples; ++x)
        {
            const double u = (x + 0.5) / kSamples;
            const double v = (y + 0.5) / kSamples;
            const auto of_a = a.sample(u, v, {}, footprint(a));
            const auto of_b = b.sample(u, v, {}, footprint(b));
            for (std::size_t k = 0; k < 3; ++k)
            {
                sum += (of_a[k] - of_b[k]) * (of_a[k] - of_b[k]);
            }
        }
    }
    return sum / (3.0 * kSamples * kSamples);
}

image::JpegOptions options_of(int quality, int subsampled)
{
    return {.quality = quality, .subsampled = subsampled != 0, .progressive = true};
}

}  // namespace

JpegLadder::JpegLadder(const Raster& original) : original_(original)
{
    const std::uint32_t side = std::max(original.width, original.height);
    for (const std::uint32_t scale : kScales)
    {
        scaled_.push_back(image::downsampled(original, std::max(side * scale / 16, 1U)));
    }
}

Result<std::size_t> JpegLadder::bytes_of(Key key)
{
    const auto known = bytes_.find(key);
    if (known != bytes_.end())
    {
        return known->second;
    }
    const auto& raster = scaled_[static_cast<std::size_t>(key[0])];
    const auto file = image::write_jpeg(raster, options_of(key[2], key[1]));
    VSPLIT_TRY(file);
    return bytes_[key] = file->size();
}

Result<int> JpegLadder::best_quality(int scale, int subsampled, std::size_t bytes)
{
    std::size_t low = 0, high = kQualities.size();
    while (low < high)
    {
        const std::size_t middle = (low + high) / 2;
        const auto size = bytes_of({scale, subsampled, kQualities[middle]});
        VSPLIT_TRY(size);
        *size <= bytes ? low = middle + 1 : high = middle;
    }
    if (low == 0)
    {
        return 0;
    }
    const int end = low < kQualities.size() ? kQualities[low] : 98;
    int quality = kQualities[low - 1];
    for (int next = quality + 1; next < end; ++next)
    {
        const auto size = bytes_of({scale, subsampled, next});
        VSPLIT_TRY(size);
        if (*size > bytes)
        {
            break;
        }
        quality = next;
    }
    return quality;
}

Result<const JpegFile*> JpegLadder::file_of(Key key)
{
    const auto known = files_.find(key);
    if (known != files_.end())
    {
        return &known->second;
    }
    const auto& raster = scaled_[static_cast<std::size_t>(key[0])];
    const auto coded = image::write_jpeg(raster, options_of(key[2], key[1]));
    VSPLIT_TRY(coded);
    auto shown = image::read_image(*coded);
    VSPLIT_TRY(shown);
    JpegFile& file = files_[key];
    file.bytes = coded->size();
    file.side = std::max(raster.width, raster.height);
    file.quality = key[2];
    file.subsampled = key[1] != 0;
    file.error = sampled_error(picture::Texture(*shown), original_);
    file.shown = std::move(*shown);
    return &file;
}

Result<std::vector<JpegFile>> JpegLadder::best_by_size(std::size_t bytes)
{
    std::vector<JpegFile> files;
    for (int scale = 0; scale < static_cast<int>(kScales.size()); ++scale)
    {
        const JpegFile* best = nullptr;
        for (const int subsampled : {0, 1})
        {
            const auto quality = best_quality(scale, subsampled, bytes);
            VSPLIT_TRY(quality);
            if (*quality == 0)
            {
                continue;
            }
            const auto file = file_of({scale, subsampled, *quality});
            VSPLIT_TRY(file);
            best = best == nullptr || (*file)->error < best->error ? *file : best;
        }
        if (best != nullptr)
        {
            files.push_back(*best);
        }
    }
    return files;
}

Result<JpegFile> JpegLadder::best(std::size_t bytes)
{
    const auto files = best_by_size(bytes);
    VSPLIT_TRY(files);
    const auto best = std::ranges::min_element(*files, {}, &JpegFile::error);
    return best == files->end() ? JpegFile{} : *best;
}

}  // namespace vsplit::bench
