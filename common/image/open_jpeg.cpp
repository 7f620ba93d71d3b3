#include "image/open_jpeg.h"

#include "core/assert.h"
#include "image/code_stream.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <openjpeg.h>

namespace vsplit::image {

namespace {

struct CodecDeleter
{
    void operator()(opj_codec_t* codec) const { opj_destroy_codec(codec); }
};

struct ImageDeleter
{
    void operator()(opj_image_t* image) const { opj_image_destroy(image); }
};

struct StreamDeleter
{
    void operator()(opj_stream_t* stream) const { opj_stream_destroy(stream); }
};

using Codec = std::unique_ptr<opj_codec_t, CodecDeleter>;
using Image = std::unique_ptr<opj_image_t, ImageDeleter>;
using Stream = std::unique_ptr<opj_stream_t, StreamDeleter>;

constexpr OPJ_SIZE_T kStreamBuffer = 1U << 16;

/// A code stream in memory that OpenJPEG reads.
struct Source
{
    std::span<const std::byte> bytes;
    std::size_t at = 0;
};

/// One that it writes, and for every seek back overwrites.
struct Sink
{
    std::vector<std::byte> bytes;
    std::size_t at = 0;
};

OPJ_SIZE_T read_source(void* buffer, OPJ_SIZE_T count, void* user)
{
    auto& source = *static_cast<Source*>(user);
    const std::size_t taken = std::min<std::size_t>(count, source.bytes.size() - source.at);
    if (taken == 0)
    {
        return static_cast<OPJ_SIZE_T>(-1);
    }
    std::memcpy(buffer, source.bytes.data() + source.at, taken);
    source.at += taken;
    return taken;
}

OPJ_OFF_T skip_source(OPJ_OFF_T count, void* user)
{
    auto& source = *static_cast<Source*>(user);
    if (count < 0)
    {
        return -1;
    }
    const auto left = static_cast<OPJ_OFF_T>(source.bytes.size() - source.at);
    source.at += static_cast<std::size_t>(std::min(count, left));
    return count;
}

OPJ_BOOL seek_source(OPJ_OFF_T place, void* user)
{
    auto& source = *static_cast<Source*>(user);
    if (place < 0 || static_cast<std::uint64_t>(place) > source.bytes.size())
    {
        return OPJ_FALSE;
    }
    source.at = static_cast<std::size_t>(place);
    return OPJ_TRUE;
}

OPJ_SIZE_T write_sink(void* buffer, OPJ_SIZE_T count, void* user)
{
    auto& sink = *static_cast<Sink*>(user);
    sink.bytes.resize(std::max(sink.bytes.size(), sink.at + count));
    std::memcpy(sink.bytes.data() + sink.at, buffer, count);
    sink.at += count;
    return count;
}

OPJ_OFF_T skip_sink(OPJ_OFF_T count, void* user)
{
    auto& sink = *static_cast<Sink*>(user);
    if (count < 0)
    {
        return -1;
    }
    sink.at += static_cast<std::size_t>(count);
    return count;
}

OPJ_BOOL seek_sink(OPJ_OFF_T place, void* user)
{
    if (place < 0)
    {
        return OPJ_FALSE;
    }
    static_cast<Sink*>(user)->at = static_cast<std::size_t>(place);
    return OPJ_TRUE;
}

Image image_of(const Raster& raster)
{
    std::array<opj_image_cmptparm_t, 4> parameters{};
    for (auto& channel : parameters)
    {
        channel.dx = 1;
        channel.dy = 1;
        channel.w = raster.width;
        channel.h = raster.height;
        channel.prec = 8;
    }
    Image image(opj_image_create(
        raster.channels, parameters.data(), raster.channels < 3 ? OPJ_CLRSPC_GRAY : OPJ_CLRSPC_SRGB
    ));
    if (!image)
    {
        return image;
    }
    image->x1 = raster.width;
    image->y1 = raster.height;
    const std::size_t pixels = std::size_t{raster.width} * raster.height;
    for (std::size_t channel = 0; channel < raster.channels; ++channel)
    {
        OPJ_INT32* const target = image->comps[channel].data;
        for (std::size_t i = 0; i < pixels; ++i)
        {
            target[i] = raster.pixels[i * raster.channels + channel];
        }
    }
    return image;
}

opj_cparameters_t encoder_parameters(
    const TextureHeader& header, std::span<const double> layer_bytes
)
{
    opj_cparameters_t parameters;
    opj_set_default_encoder_parameters(&parameters);
    parameters.cp_disto_alloc = 1;
    parameters.tcp_numlayers = static_cast<int>(layer_bytes.size());
    const double raw = double{1} * header.width * header.height * header.channels;
    for (std::size_t layer = 0; layer < layer_bytes.size(); ++layer)
    {
        parameters.tcp_rates[layer] =
            layer_bytes[layer] > 0 ? static_cast<float>(raw / layer_bytes[layer]) : 0.0F;
    }
    parameters.tcp_mct = header.color_transform ? 1 : 0;
    parameters.irreversible = header.reversible ? 0 : 1;
    parameters.numresolution = header.levels + 1;
    parameters.prog_order = OPJ_LRCP;
    parameters.csty = 1;
    parameters.res_spec = parameters.numresolution;
    for (int i = 0; i < parameters.res_spec; ++i)
    {
        parameters.prcw_init[i] = 1 << precinct_side_log(header);
        parameters.prch_init[i] = 1 << precinct_side_log(header);
    }
    return parameters;
}

bool run_encoder(opj_codec_t* codec, opj_image_t* image, Sink& sink)
{
    const Stream stream(opj_stream_create(kStreamBuffer, OPJ_FALSE));
    if (!stream)
    {
        return false;
    }
    opj_stream_set_user_data(stream.get(), &sink, nullptr);
    opj_stream_set_write_function(stream.get(), write_sink);
    opj_stream_set_skip_function(stream.get(), skip_sink);
    opj_stream_set_seek_function(stream.get(), seek_sink);
    return opj_start_compress(codec, image, stream.get()) != OPJ_FALSE &&
           opj_encode(codec, stream.get()) != OPJ_FALSE &&
           opj_end_compress(codec, stream.get()) != OPJ_FALSE;
}

Result<Raster> raster_of(const opj_image_t& image)
{
    Raster raster{
        .width = image.comps[0].w,
        .height = image.comps[0].h,
        .channels = static_cast<std::uint8_t>(image.numcomps),
        .pixels = {},
    };
    const std::size_t pixels = std::size_t{raster.width} * raster.height;
    raster.pixels.resize(pixels * raster.channels);
    for (std::size_t channel = 0; channel < raster.channels; ++channel)
    {
        const opj_image_comp_t& source = image.comps[channel];
        if (source.data == nullptr || source.w != raster.width || source.h != raster.height)
        {
            return fail(ErrorCode::BadChunk, "a channel of an image is missing");
        }
        for (std::size_t i = 0; i < pixels; ++i)
        {
            raster.pixels[i * raster.channels + channel] =
                static_cast<std::uint8_t>(std::clamp(source.data[i], 0, 255));
        }
    }
    return raster;
}

}  // namespace

Result<std::vector<std::byte>> open_jpeg_encode(
    const Raster& raster, const TextureHeader& header, std::span<const double> layer_bytes
)
{
    VSPLIT_ASSERT(layer_bytes.size() == header.layers);
    const auto refused = [] {
        return fail(ErrorCode::Internal, "OpenJPEG could not encode an image");
    };
    opj_cparameters_t parameters = encoder_parameters(header, layer_bytes);
    const Image image = image_of(raster);
    const Codec codec(opj_create_compress(OPJ_CODEC_J2K));
    if (!image || !codec || opj_setup_encoder(codec.get(), &parameters, image.get()) == OPJ_FALSE)
    {
        return refused();
    }
    const std::array<const char*, 2> options{"PLT=YES", nullptr};
    Sink sink;
    if (opj_encoder_set_extra_options(codec.get(), options.data()) == OPJ_FALSE ||
        !run_encoder(codec.get(), image.get(), sink))
    {
        return refused();
    }
    return std::move(sink.bytes);
}

Result<Raster> open_jpeg_decode(std::span<const std::byte> bytes, unsigned reduce)
{
    const auto refused = [] {
        return fail(ErrorCode::BadChunk, "the coded part of an image is malformed");
    };
    opj_dparameters_t parameters;
    opj_set_default_decoder_parameters(&parameters);
    // Strict, as the default is: code streams of TextureDecoder are complete, and what OpenJPEG 2.5.0
    // does with packets that are cut reads beyond its buffer (found by texture_fuzzer).
    parameters.cp_reduce = reduce;
    const Codec codec(opj_create_decompress(OPJ_CODEC_J2K));
    const Stream stream(opj_stream_create(kStreamBuffer, OPJ_TRUE));
    if (!codec || !stream || opj_setup_decoder(codec.get(), &parameters) == OPJ_FALSE)
    {
        return refused();
    }
    Source source{bytes};
    opj_stream_set_user_data(stream.get(), &source, nullptr);
    opj_stream_set_user_data_length(stream.get(), bytes.size());
    opj_stream_set_read_function(stream.get(), read_source);
    opj_stream_set_skip_function(stream.get(), skip_source);
    opj_stream_set_seek_function(stream.get(), seek_source);
    opj_image_t* raw = nullptr;
    const bool read = opj_read_header(stream.get(), codec.get(), &raw) != OPJ_FALSE;
    const Image image(raw);
    if (!read || !image || image->numcomps < 1 || image->numcomps > 4 ||
        opj_decode(codec.get(), stream.get(), image.get()) == OPJ_FALSE)
    {
        return refused();
    }
    return raster_of(*image);
}

}  // namespace vsplit::image
