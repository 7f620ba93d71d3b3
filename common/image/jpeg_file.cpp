// libjpeg reports errors with longjmp: functions that it may leave so hold nothing with a destructor.
#include "core/assert.h"
#include "image/image_formats.h"

#include <array>
#include <csetjmp>
#include <cstdio>  // jpeglib.h needs it
#include <cstdlib>
#include <jerror.h>
#include <jpeglib.h>
#include <string>

namespace vsplit::image {

namespace {

/// A progressive file of more scans only means to cost time.
constexpr int kMaxScans = 200;

/// libjpeg's error manager and what we want to know; libjpeg sees its first member only.
struct ErrorState
{
    jpeg_error_mgr manager{};
    std::jmp_buf target{};
    std::array<char, JMSG_LENGTH_MAX> message{};
    bool ended_early = false;
};

ErrorState& state_of(j_common_ptr jpeg)
{
    return *reinterpret_cast<ErrorState*>(jpeg->err);
}

[[noreturn]] void stop(j_common_ptr jpeg)
{
    ErrorState& state = state_of(jpeg);
    state.manager.format_message(jpeg, state.message.data());
    std::longjmp(state.target, 1);
}

/// Warnings: noise in the data is tolerated as every viewer does, a missing end is not.
void on_message(j_common_ptr jpeg, int level)
{
    ErrorState& state = state_of(jpeg);
    if (level < 0 && state.manager.msg_code == JWRN_JPEG_EOF)
    {
        state.ended_early = true;
        stop(jpeg);
    }
}

void on_progress(j_common_ptr jpeg)
{
    if (jpeg->is_decompressor != FALSE &&
        reinterpret_cast<j_decompress_ptr>(jpeg)->input_scan_number > kMaxScans)
    {
        ERREXIT(jpeg, JERR_BAD_PROGRESSION);
    }
}

void prepare(ErrorState& state)
{
    jpeg_std_error(&state.manager);
    state.manager.error_exit = stop;
    state.manager.emit_message = on_message;
}

/// What reads one file; owns libjpeg's state.
class JpegReader
{
public:
    explicit JpegReader(std::span<const std::byte> bytes) : bytes_(bytes)
    {
        prepare(state_);
        jpeg_.err = &state_.manager;
        progress_.progress_monitor = on_progress;
    }

    ~JpegReader() { jpeg_destroy_decompress(&jpeg_); }

    JpegReader(const JpegReader&) = delete;
    JpegReader& operator=(const JpegReader&) = delete;

    bool read_header(Raster& raster)
    {
        if (setjmp(state_.target) != 0)
        {
            return false;
        }
        jpeg_create_decompress(&jpeg_);
        jpeg_.progress = &progress_;
        jpeg_mem_src(&jpeg_, reinterpret_cast<const unsigned char*>(bytes_.data()), bytes_.size());
        jpeg_read_header(&jpeg_, TRUE);
        if (jpeg_.jpeg_color_space != JCS_GRAYSCALE && jpeg_.jpeg_color_space != JCS_YCbCr &&
            jpeg_.jpeg_color_space != JCS_RGB)
        {
            ERREXIT(&jpeg_, JERR_CONVERSION_NOTIMPL);
        }
        const bool grey = jpeg_.jpeg_color_space == JCS_GRAYSCALE;
        jpeg_.out_color_space = grey ? JCS_GRAYSCALE : JCS_RGB;
        jpeg_.dct_method = JDCT_ISLOW;
        raster.width = jpeg_.image_width;
        raster.height = jpeg_.image_height;
        raster.channels = grey ? 1 : 3;
        return true;
    }

    bool read_pixels(Raster& raster)
    {
        if (setjmp(state_.target) != 0)
        {
            return false;
        }
        jpeg_start_decompress(&jpeg_);
        const std::size_t stride = std::size_t{raster.width} * raster.channels;
        while (jpeg_.output_scanline < jpeg_.output_height)
        {
            JSAMPROW row = raster.pixels.data() + jpeg_.output_scanline * stride;
            jpeg_read_scanlines(&jpeg_, &row, 1);
        }
        jpeg_finish_decompress(&jpeg_);
        return true;
    }

    [[nodiscard]] tl::unexpected<Error> error() const
    {
        return fail(
            state_.ended_early ? ErrorCode::Truncated : ErrorCode::UnsupportedInput,
            std::string("a JPEG image cannot be read: ") + state_.message.data()
        );
    }

private:
    std::span<const std::byte> bytes_;
    ErrorState state_{};
    jpeg_progress_mgr progress_{};
    jpeg_decompress_struct jpeg_{};
};

/// Writes an image of one or three channels. False when libjpeg refuses; `buffer` is malloc's.
bool compress(
    const Raster& raster,
    const JpegOptions& options,
    ErrorState& state,
    unsigned char*& buffer,
    unsigned long& size
)
{
    jpeg_compress_struct jpeg{};
    jpeg.err = &state.manager;
    if (setjmp(state.target) != 0)
    {
        jpeg_destroy_compress(&jpeg);
        return false;
    }
    jpeg_create_compress(&jpeg);
    jpeg_mem_dest(&jpeg, &buffer, &size);
    jpeg.image_width = raster.width;
    jpeg.image_height = raster.height;
    jpeg.input_components = raster.channels;
    jpeg.in_color_space = raster.channels == 1 ? JCS_GRAYSCALE : JCS_RGB;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, options.quality, TRUE);
    jpeg.optimize_coding = TRUE;
    const int sampling = options.subsampled && raster.channels == 3 ? 2 : 1;
    jpeg.comp_info[0].h_samp_factor = sampling;
    jpeg.comp_info[0].v_samp_factor = sampling;
    if (options.progressive)
    {
        jpeg_simple_progression(&jpeg);
    }
    jpeg_start_compress(&jpeg, TRUE);
    const std::size_t stride = std::size_t{raster.width} * raster.channels;
    while (jpeg.next_scanline < jpeg.image_height)
    {
        JSAMPROW row =
            const_cast<JSAMPLE*>(raster.pixels.data() + jpeg.next_scanline * stride);  // only read
        jpeg_write_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    return true;
}

Raster without_alpha(const Raster& raster)
{
    Raster result{
        .width = raster.width,
        .height = raster.height,
        .channels = static_cast<std::uint8_t>(raster.channels - 1),
        .pixels = {},
    };
    result.pixels.reserve(raster.pixels.size() / raster.channels * result.channels);
    for (std::size_t i = 0; i < raster.pixels.size(); ++i)
    {
        if (i % raster.channels != result.channels)
        {
            result.pixels.push_back(raster.pixels[i]);
        }
    }
    return result;
}

}  // namespace

Result<Raster> read_jpeg(std::span<const std::byte> bytes, const ImageLimits& limits, Extent extent)
{
    JpegReader reader(bytes);
    Raster raster;
    if (!reader.read_header(raster))
    {
        return reader.error();
    }
    VSPLIT_TRY(check_size(raster.width, raster.height, limits));
    if (extent == Extent::Header)
    {
        return raster;
    }
    raster.pixels.resize(std::size_t{raster.width} * raster.height * raster.channels);
    if (!reader.read_pixels(raster))
    {
        return reader.error();
    }
    return raster;
}

Result<std::vector<std::byte>> write_jpeg(const Raster& raster, const JpegOptions& options)
{
    VSPLIT_ASSERT(
        raster.pixels.size() == std::size_t{raster.channels} * raster.width * raster.height
    );
    if (raster.channels % 2 == 0)
    {
        return write_jpeg(without_alpha(raster), options);
    }
    ErrorState state;
    prepare(state);
    unsigned char* buffer = nullptr;
    unsigned long size = 0;
    const bool written = compress(raster, options, state, buffer, size);
    const auto* const begin = reinterpret_cast<const std::byte*>(buffer);
    std::vector<std::byte> bytes(begin, begin + (written ? size : 0));
    std::free(buffer);  // jpeg_mem_dest() allocates so
    if (!written)
    {
        return fail(
            ErrorCode::Internal, std::string("cannot make a JPEG image: ") + state.message.data()
        );
    }
    return bytes;
}

}  // namespace vsplit::image
