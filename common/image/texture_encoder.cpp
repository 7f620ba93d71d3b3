// Based on: Taubman, High performance scalable image compression with EBCOT, 2000: every layer's end
// is the best image of its bytes. OpenJPEG chooses what a layer holds; where layers end is chosen here.
#include "image/texture_encoder.h"

#include "core/assert.h"
#include "image/code_stream.h"
#include "image/downsample.h"
#include "image/open_jpeg.h"
#include "image/texture_cutter.h"
#include "image/texture_decoder.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace vsplit::image {

namespace {

/// Resolutions are halved until the longest side is at most this.
constexpr std::uint32_t kCoarsestSide = 24;

/// Interpolated lengths tend to be a little short, decibels.
constexpr double kInterpolationMargin = 0.2;

/// Where quality layers end: bytes of packets.
using LayerEnds = std::vector<double>;

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

double decibels(double squared_error)
{
    return 10.0 * std::log10(255.0 * 255.0 / std::max(squared_error, 1e-6));
}

/// Bytes up to which an image may become better than it has to.
double cheap_bytes(const Raster& raster, const TextureOptions& options)
{
    return options.cheap_bits_per_pixel / 8.0 * raster.width * raster.height;
}

TextureHeader header_for(const Raster& raster, const TextureOptions& options)
{
    TextureHeader header{
        .width = raster.width,
        .height = raster.height,
        .channels = raster.channels,
        .reversible = options.lossless,
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
LayerEnds spaced_ends(const TextureOptions& options, double last, bool everything)
{
    const double span = std::max(1.0, last / options.preview_bytes);
    const double steps = std::round(std::log(span) / std::log(options.layer_ratio));
    const double count = std::clamp(steps, 0.0, double{kMaxTextureLayers - 1});
    LayerEnds ends;
    for (double i = 0; i < count; ++i)
    {
        ends.push_back(options.preview_bytes * std::pow(span, i / count));
    }
    ends.push_back(everything ? 0.0 : last);
    return ends;
}

Result<CodedPackets> encode_layers(const Raster& raster, TextureHeader& header, LayerEnds ends)
{
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

Result<LayerEnds> plan_layers(
    const Raster& raster, TextureHeader header, const TextureOptions& options
)
{
    const double raw = double{1} * raster.width * raster.height * raster.channels;
    const auto coded = encode_layers(
        raster, header, options.lossless ? LayerEnds{0.0} : spaced_ends(options, raw, true)
    );
    VSPLIT_TRY(coded);
    if (options.lossless)
    {
        return spaced_ends(options, static_cast<double>(coded->bytes.size()), true);
    }
    const auto curve = quality_curve(raster, header, *coded, options);
    VSPLIT_TRY(curve);
    const double cheap =
        std::min(cheap_bytes(raster, options), bytes_for_quality(*curve, options.cheap_psnr));
    const double wanted = bytes_for_quality(*curve, options.psnr + kInterpolationMargin);
    return spaced_ends(options, std::max(wanted, cheap), false);
}

Result<void> measure(const Raster& raster, std::vector<TextureChunk>& chunks)
{
    TextureDecoder decoder;
    for (TextureChunk& chunk : chunks)
    {
        VSPLIT_TRY(decoder.feed(chunk.payload));
        const auto picture = decoder.picture(kMaxTextureSide);
        VSPLIT_TRY(picture);
        chunk.squared_error = mean_squared_error(*picture, raster);
    }
    return {};
}

}  // namespace

Result<EncodedTexture> encode_texture(const Raster& source, const TextureOptions& options)
{
    VSPLIT_ASSERT(source.channels >= 1 && source.channels <= 4);
    VSPLIT_ASSERT(
        source.pixels.size() == std::size_t{source.width} * source.height * source.channels
    );
    if (source.width < 1 || source.height < 1 ||
        std::max(source.width, source.height) > kMaxTextureSide)
    {
        return fail(ErrorCode::InputTooLarge, "an image is empty or has a side above 32768 pixels");
    }
    const Raster raster = downsampled(source, options.max_size);
    TextureHeader header = header_for(raster, options);
    auto ends = plan_layers(raster, header, options);
    VSPLIT_TRY(ends);
    const auto coded = encode_layers(raster, header, std::move(*ends));
    VSPLIT_TRY(coded);
    EncodedTexture result{
        .info =
            {.name = {},
             .width = raster.width,
             .height = raster.height,
             .channels = raster.channels},
        .chunks = cut_chunks(*coded, header, options.image),
    };
    VSPLIT_TRY(measure(raster, result.chunks));
    return result;
}

}  // namespace vsplit::image
