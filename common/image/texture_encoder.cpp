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
#include <cmath>
#include <numeric>
#include <utility>

namespace vsplit::image {

namespace {

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
    VSPLIT_TRY(measure(raster, result.chunks));
    return result;
}

}  // namespace vsplit::image
