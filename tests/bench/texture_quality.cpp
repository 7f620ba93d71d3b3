// Measures how good prefixes of progressive images are beside the best JPEG files of the same bytes:
// scaled down by powers of two (and three quarters of them), at the best quality that fits, baseline
// or progressive, chroma subsampled or not, scaled up bilinearly.
// usage: texture_quality IMAGE...
// VSPLIT_PSNR, VSPLIT_LAYER_RATIO and VSPLIT_LOSSLESS set options; VSPLIT_NO_JPEG leaves the search out.

#include "core/error.h"
#include "core/file_io.h"
#include "image/downsample.h"
#include "image/image_file.h"
#include "image/texture_decoder.h"
#include "image/texture_encoder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace {

using namespace vsplit;

constexpr std::array<std::size_t, 5> kBudgets{1500, 5000, 20000, 50000, 100000};
constexpr std::size_t kChecksumBytes = 4;

template <typename T>
T value_or_exit(Result<T> result, const std::string& what)
{
    if (!result)
    {
        std::fprintf(stderr, "%s: %s\n", what.c_str(), describe(result.error()).c_str());
        std::exit(1);
    }
    return std::move(*result);
}

double psnr(double squared_error)
{
    return 10.0 * std::log10(255.0 * 255.0 / std::max(squared_error, 1e-6));
}

/// Mean squared difference between an image and a smaller one that is scaled up to it.
double squared_error(const Raster& image, const Raster& small)
{
    double sum = 0.0;
    const auto place = [](std::uint32_t i, std::uint32_t to, std::uint32_t from) {
        const double center = (i + 0.5) * from / to - 0.5;
        return std::clamp(center, 0.0, from - 1.0);
    };
    for (std::uint32_t y = 0; y < image.height; ++y)
    {
        const double v = place(y, image.height, small.height);
        const auto row = static_cast<std::size_t>(v);
        const std::size_t next_row = std::min<std::size_t>(row + 1, small.height - 1);
        for (std::uint32_t x = 0; x < image.width; ++x)
        {
            const double u = place(x, image.width, small.width);
            const auto column = static_cast<std::size_t>(u);
            const std::size_t next = std::min<std::size_t>(column + 1, small.width - 1);
            for (std::size_t c = 0; c < image.channels; ++c)
            {
                const auto at = [&](std::size_t i, std::size_t j) {
                    return double{1} * small.pixels[(j * small.width + i) * small.channels + c];
                };
                const double a = u - static_cast<double>(column);
                const double b = v - static_cast<double>(row);
                const double upper = at(column, row) * (1 - a) + at(next, row) * a;
                const double lower = at(column, next_row) * (1 - a) + at(next, next_row) * a;
                const double value = std::round(upper * (1 - b) + lower * b);
                const double difference =
                    value - image.pixels[(std::size_t{y} * image.width + x) * image.channels + c];
                sum += difference * difference;
            }
        }
    }
    return sum / static_cast<double>(image.pixels.size());
}

/// The longest file of at most `budget` bytes; empty when even the worst quality has more.
std::vector<std::byte> largest_jpeg(
    const Raster& image, std::size_t budget, image::JpegOptions options
)
{
    std::vector<std::byte> best;
    int low = 1;
    int high = 100;
    while (low <= high)
    {
        options.quality = (low + high) / 2;
        auto bytes = value_or_exit(image::write_jpeg(image, options), "jpeg");
        if (bytes.size() <= budget)
        {
            best = std::move(bytes);
            low = options.quality + 1;
        }
        else
        {
            high = options.quality - 1;
        }
    }
    return best;
}

double best_jpeg(const Raster& image, std::size_t budget)
{
    const std::uint32_t side = std::max(image.width, image.height);
    double best = -1.0;
    for (std::uint32_t numerator : {4U, 3U})
    {
        for (std::uint32_t size = side * numerator / 4; size >= 16; size /= 2)
        {
            const Raster small = image::downsampled(image, size);
            for (const int kind : {0, 1, 2, 3})
            {
                const auto bytes = largest_jpeg(
                    small,
                    budget,
                    {.quality = 0, .subsampled = (kind & 1) != 0, .progressive = (kind & 2) != 0}
                );
                if (bytes.empty())
                {
                    continue;
                }
                const Raster decoded = value_or_exit(image::read_image(bytes), "jpeg");
                const double error = squared_error(image, decoded);
                best = best < 0.0 ? error : std::min(best, error);
            }
        }
    }
    return best;
}

image::TextureOptions options_from_environment()
{
    image::TextureOptions options{.measure_every_chunk = true};
    if (const char* ratio = std::getenv("VSPLIT_LAYER_RATIO"))
    {
        options.layer_ratio = std::atof(ratio);
    }
    if (const char* value = std::getenv("VSPLIT_PSNR"))
    {
        options.psnr = std::atof(value);
    }
    options.lossless = std::getenv("VSPLIT_LOSSLESS") != nullptr;
    return options;
}

void measure(const std::string& path, bool with_jpeg)
{
    const auto file = value_or_exit(read_file(path), path);
    const Raster image = value_or_exit(image::read_image(file), path);
    const auto coded =
        value_or_exit(image::encode_texture(image, options_from_environment()), path);
    std::size_t total = 0;
    for (const auto& chunk : coded.chunks)
    {
        total += chunk.payload.size() + kChecksumBytes;
    }
    std::printf(
        "%s: %u x %u x %u, file %zu, %zu chunks, preview %zu, %zu bytes, %.2f dB\n",
        std::filesystem::path(path).filename().c_str(),
        image.width,
        image.height,
        unsigned{image.channels},
        file.size(),
        coded.chunks.size(),
        coded.chunks.front().payload.size(),
        total,
        psnr(coded.chunks.back().squared_error)
    );
    for (const std::size_t budget : kBudgets)
    {
        std::size_t used = 0;
        double error = -1.0;
        for (const auto& chunk : coded.chunks)
        {
            const std::size_t next = used + chunk.payload.size() + kChecksumBytes;
            if (next > budget)
            {
                break;
            }
            used = next;
            error = chunk.squared_error;
        }
        std::printf("  %6zu: %6zu bytes %6.2f dB", budget, used, error < 0 ? 0.0 : psnr(error));
        if (with_jpeg)
        {
            std::printf("  jpeg %6.2f dB", psnr(best_jpeg(image, budget)));
        }
        std::printf("\n");
    }
}

}  // namespace

int main(int argc, char** argv)
{
    const bool with_jpeg = std::getenv("VSPLIT_NO_JPEG") == nullptr;
    for (int i = 1; i < argc; ++i)
    {
        measure(argv[i], with_jpeg);
    }
    return 0;
}
