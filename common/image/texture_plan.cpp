// Based on: Taubman and Marcellin, JPEG2000: Image Compression Fundamentals, Standards and Practice,
// 2002, on layers; where they end and which wavelet an image gets is our choice, by measuring.
#include "image/texture_plan.h"

#include "image/open_jpeg.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace vsplit::image {

namespace {

/// Resolutions are halved until the longest side is at most this.
constexpr std::uint32_t kCoarsestSide = 48;

/// Interpolated lengths tend to be a little short, decibels.
constexpr double kInterpolationMargin = 0.2;

/// Differences between images that are better than this are not seen, decibels.
constexpr double kSeenPsnr = 42.0;

/// Steps between the lengths at which quality is measured.
constexpr double kCurveRatio = 2.0;

double decibels(double squared_error)
{
    return 10.0 * std::log10(255.0 * 255.0 / std::max(squared_error, 1e-6));
}

/// Bytes up to which an image may become better than it has to.
double cheap_bytes(const Raster& raster, const TextureOptions& options)
{
    const double pixels = double{1} * raster.width * raster.height;
    const double small = double{1} * options.small_bytes;
    const double bytes = std::max(
        options.cheap_bits_per_pixel / 8.0 * pixels,
        std::min(options.small_bits_per_pixel / 8.0 * pixels, small)
    );
    return std::min(bytes, std::max(static_cast<double>(options.cheap_bytes), small));
}

TextureHeader header_for(const Raster& raster, const TextureOptions& options)
{
    TextureHeader header{
        .width = raster.width,
        .height = raster.height,
        .channels = raster.channels,
        .reversible = false,
        .color_transform = raster.channels >= 3 && !options.is_normal_map,
        .levels = 0,
        .layers = 1,
    };
    std::uint32_t side = std::max(raster.width, raster.height);
    while (side > kCoarsestSide && header.levels < kMaxTextureLevels)
    {
        side = (side + 1) / 2;
        ++header.levels;
    }
    return header;
}

/// Ends that grow by about `ratio` from the preview to `last`; a last end of 0 stands for everything.
std::vector<double> spaced_ends(
    const TextureOptions& options, double last, double ratio, bool everything
)
{
    const double span = std::max(1.0, last / options.preview_bytes);
    const double steps = std::round(std::log(span) / std::log(ratio));
    const double count = std::clamp(steps, 0.0, double{kMaxTextureLayers - 1});
    std::vector<double> ends;
    for (double i = 0; i < count; ++i)
    {
        ends.push_back(options.preview_bytes * std::pow(span, i / count));
    }
    ends.push_back(everything ? 0.0 : last);
    return ends;
}

/// Length of a prefix and how good it is.
struct CurvePoint
{
    double bytes = 0.0;
    double psnr = 0.0;
};

/// Measures a code stream of many layers at their ends, until nobody would want more.
Result<std::vector<CurvePoint>> quality_curve(
    const Raster& raster,
    const TextureHeader& header,
    const CodedPackets& coded,
    const TextureOptions& options
)
{
    const std::uint32_t per_layer = TextureLayout(header).packets_per_layer();
    const double cheap = cheap_bytes(raster, options);
    std::vector<CurvePoint> curve;
    std::uint64_t bytes = 0;
    for (unsigned layer = 0; layer < header.layers; ++layer)
    {
        const auto first = coded.lengths.begin() + std::ptrdiff_t{layer} * per_layer;
        bytes = std::accumulate(first, first + per_layer, bytes);
        auto stream = main_header(header, 0, layer + 1);
        append_tile(stream, std::span(coded.bytes).first(bytes));
        const auto picture = open_jpeg_decode(stream, 0);
        VSPLIT_TRY(picture);
        const double psnr = decibels(mean_squared_error(*picture, raster));
        curve.push_back({static_cast<double>(bytes), psnr});
        const double wanted = curve.back().bytes < cheap ? options.cheap_psnr : options.psnr;
        if (psnr >= wanted)
        {
            break;
        }
    }
    return curve;
}

/// The length at which a quality is reached, between measured points interpolated: decibels over the
/// logarithm of bytes. The last point's when it is nowhere.
double bytes_for_quality(const std::vector<CurvePoint>& curve, double psnr)
{
    const auto after = std::find_if(curve.begin(), curve.end(), [&](const CurvePoint& point) {
        return point.psnr >= psnr;
    });
    if (after == curve.end())
    {
        return curve.back().bytes;
    }
    if (after == curve.begin() || after->psnr <= std::prev(after)->psnr)
    {
        return after->bytes;
    }
    const CurvePoint& before = *std::prev(after);
    const double part = (psnr - before.psnr) / (after->psnr - before.psnr);
    return before.bytes * std::pow(after->bytes / before.bytes, part);
}

/// A plan, and what it was made from.
struct MeasuredPlan
{
    TexturePlan plan;
    std::vector<CurvePoint> curve;
    bool exact = false;
};

/// Compares curves measured at the same lengths: the mean of the decibels decides, as long as one is below
/// what is seen; further on the sharper wavelet is always the better one.
bool is_better(const std::vector<CurvePoint>& a, const std::vector<CurvePoint>& b)
{
    double gain = 0.0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    {
        if (std::min(a[i].psnr, b[i].psnr) < kSeenPsnr || i == 0)
        {
            gain += a[i].psnr - b[i].psnr;
        }
    }
    return gain > 0.0;
}

Result<MeasuredPlan> plan_lossy(
    const Raster& raster, TextureHeader header, const TextureOptions& options
)
{
    const double raw = double{1} * raster.width * raster.height * raster.channels;
    const auto coded = encode_layers(raster, header, spaced_ends(options, raw, kCurveRatio, true));
    VSPLIT_TRY(coded);
    const auto curve = quality_curve(raster, header, *coded, options);
    VSPLIT_TRY(curve);
    if (header.reversible && coded->bytes.size() <= options.exact_bytes)
    {
        const auto all = static_cast<double>(coded->bytes.size());
        return MeasuredPlan{
            {header, spaced_ends(options, all, options.layer_ratio, true)}, *curve, true};
    }
    const double cheap =
        std::min(cheap_bytes(raster, options), bytes_for_quality(*curve, options.cheap_psnr));
    const double wanted = bytes_for_quality(*curve, options.psnr + kInterpolationMargin);
    const double last = std::max(wanted, cheap);
    return MeasuredPlan{{header, spaced_ends(options, last, options.layer_ratio, false)}, *curve};
}

Result<TexturePlan> plan_lossless(
    const Raster& raster, TextureHeader header, const TextureOptions& options
)
{
    header.reversible = true;
    const auto coded = encode_layers(raster, header, std::vector<double>{0.0});
    VSPLIT_TRY(coded);
    const auto last = static_cast<double>(coded->bytes.size());
    return TexturePlan{header, spaced_ends(options, last, options.layer_ratio, true)};
}

}  // namespace

double mean_squared_error(const Raster& a, const Raster& b)
{
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
    {
        const int difference = int{a.pixels[i]} - int{b.pixels[i]};
        sum += static_cast<std::uint64_t>(difference * difference);
    }
    return static_cast<double>(sum) / static_cast<double>(a.pixels.size());
}

Result<CodedPackets> encode_layers(
    const Raster& raster, TextureHeader& header, std::span<const double> layer_ends
)
{
    std::vector<double> ends(layer_ends.begin(), layer_ends.end());
    header.layers = static_cast<std::uint8_t>(ends.size());
    const auto head = static_cast<double>(main_header(header, 0, header.layers).size());
    for (double& end : ends)
    {
        end = end > 0 ? end + head : 0;
    }
    const auto stream = open_jpeg_encode(raster, header, ends);
    VSPLIT_TRY(stream);
    return split_code_stream(*stream, header);
}

Result<TexturePlan> plan_texture(const Raster& raster, const TextureOptions& options)
{
    TextureHeader header = header_for(raster, options);
    if (options.lossless)
    {
        return plan_lossless(raster, header, options);
    }
    const auto smooth = plan_lossy(raster, header, options);
    header.reversible = true;
    const auto sharp = plan_lossy(raster, header, options);
    VSPLIT_TRY(smooth);
    VSPLIT_TRY(sharp);
    const bool is_sharp = sharp->exact || is_better(sharp->curve, smooth->curve);
    return is_sharp ? sharp->plan : smooth->plan;
}

}  // namespace vsplit::image
