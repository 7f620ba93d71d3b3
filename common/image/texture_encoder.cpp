// Based on: Taubman, High performance scalable image compression with EBCOT, 2000: every layer's end
// is the best image of its bytes. OpenJPEG chooses what a layer holds; where layers end is chosen here.
#include "image/texture_encoder.h"

#include "core/assert.h"
#include "image/code_stream.h"
#include "image/downsample.h"
#include "image/open_jpeg.h"
#include "image/texture_cutter.h"
#include "image/texture_decoder.h"
#include "image/texture_plan.h"

#include <algorithm>
#include <span>
#include <utility>

namespace vsplit::image {

namespace {

/// Gives chunks between two measured ones errors that fall evenly with their bytes.
void interpolate(std::span<TextureChunk> chunks, double error_before)
{
    std::size_t total = 0;
    for (const TextureChunk& chunk : chunks)
    {
        total += chunk.payload.size();
    }
    const double error = chunks.back().squared_error;
    std::size_t sent = 0;
    for (TextureChunk& chunk : chunks.first(chunks.size() - 1))
    {
        sent += chunk.payload.size();
        const double part = static_cast<double>(sent) / static_cast<double>(total);
        chunk.squared_error = error_before + (error - error_before) * part;
    }
}

Result<void> measure(const Raster& raster, std::span<TextureChunk> chunks, bool every_chunk)
{
    TextureDecoder decoder;
    double error_before = 0.0;
    std::size_t first = 0;
    for (std::size_t i = 0; i < chunks.size(); ++i)
    {
        VSPLIT_TRY(decoder.feed(chunks[i].payload));
        const bool ends_layer = i + 1 == chunks.size() || chunks[i + 1].layer != chunks[i].layer;
        if (!every_chunk && !ends_layer && i > 0)
        {
            continue;
        }
        const auto picture = decoder.picture(kMaxTextureSide);
        VSPLIT_TRY(picture);
        chunks[i].squared_error = mean_squared_error(*picture, raster);
        interpolate(chunks.subspan(first, i + 1 - first), error_before);
        error_before = chunks[i].squared_error;
        first = i + 1;
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
    auto plan = plan_texture(raster, options);
    VSPLIT_TRY(plan);
    TextureHeader header = plan->header;
    const auto coded = encode_layers(raster, header, plan->layer_ends);
    VSPLIT_TRY(coded);
    EncodedTexture result{
        .info =
            {.name = {},
             .width = raster.width,
             .height = raster.height,
             .channels = raster.channels},
        .chunks = cut_chunks(*coded, header, options.image),
    };
    VSPLIT_TRY(measure(raster, result.chunks, options.measure_every_chunk));
    return result;
}

}  // namespace vsplit::image
