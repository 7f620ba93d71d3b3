// libpng reports errors with longjmp: functions that it may leave so hold nothing with a destructor.
#include "core/assert.h"
#include "image/image_formats.h"

#include <png.h>

#include <csetjmp>
#include <cstring>
#include <string>

namespace vsplit::image {

namespace {

constexpr png_alloc_size_t kMaxAncillaryBytes = png_alloc_size_t{1} << 23U;

struct Source
{
    std::span<const std::byte> bytes;
    bool ended_early = false;
    std::string message;
};

void take_bytes(png_structp png, png_bytep target, std::size_t count)
{
    auto& source = *static_cast<Source*>(png_get_io_ptr(png));
    if (count > source.bytes.size())
    {
        source.ended_early = true;
        png_error(png, "the file ends too early");
    }
    std::memcpy(target, source.bytes.data(), count);
    source.bytes = source.bytes.subspan(count);
}

[[noreturn]] void stop(png_structp png, png_const_charp message)
{
    static_cast<Source*>(png_get_error_ptr(png))->message = message;
    png_longjmp(png, 1);
}

void ignore(png_structp /*png*/, png_const_charp /*message*/) {}

/// What reads one file; owns libpng's state.
class PngReader
{
public:
    explicit PngReader(std::span<const std::byte> bytes) : source_{bytes, false, {}}
    {
        png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, &source_, stop, ignore);
        info_ = png_ == nullptr ? nullptr : png_create_info_struct(png_);
    }

    ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }

    PngReader(const PngReader&) = delete;
    PngReader& operator=(const PngReader&) = delete;

    /// Reads up to the pixels and sets what they become.
    bool read_header(Raster& raster)
    {
        if (info_ == nullptr || setjmp(png_jmpbuf(png_)) != 0)
        {
            return false;
        }
        png_set_read_fn(png_, &source_, take_bytes);
        png_set_user_limits(png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
        png_set_chunk_malloc_max(png_, kMaxAncillaryBytes);
        png_set_chunk_cache_max(png_, 16);
        png_read_info(png_, info_);
        raster.width = png_get_image_width(png_, info_);
        raster.height = png_get_image_height(png_, info_);
        png_set_expand(png_);
        png_set_scale_16(png_);
        passes_ = png_set_interlace_handling(png_);
        png_read_update_info(png_, info_);
        raster.channels = png_get_channels(png_, info_);
        return png_get_rowbytes(png_, info_) == png_size_t{raster.width} * raster.channels;
    }

    bool read_pixels(Raster& raster)
    {
        if (setjmp(png_jmpbuf(png_)) != 0)
        {
            return false;
        }
        const png_size_t stride = png_size_t{raster.width} * raster.channels;
        for (int pass = 0; pass < passes_; ++pass)
        {
            for (png_size_t row = 0; row < raster.height; ++row)
            {
                png_read_row(png_, raster.pixels.data() + row * stride, nullptr);
            }
        }
        png_read_end(png_, nullptr);
        return true;
    }

    [[nodiscard]] tl::unexpected<Error> error() const
    {
        return fail(
            source_.ended_early ? ErrorCode::Truncated : ErrorCode::UnsupportedInput,
            "a PNG image cannot be read: " + source_.message
        );
    }

private:
    Source source_;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
    int passes_ = 1;
};

}  // namespace

Result<Raster> read_png(std::span<const std::byte> bytes, const ImageLimits& limits, Extent extent)
{
    PngReader reader(bytes);
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

Result<std::vector<std::byte>> write_png(const Raster& raster)
{
    VSPLIT_ASSERT(
        raster.pixels.size() == std::size_t{raster.channels} * raster.width * raster.height
    );
    png_image description{};
    description.version = PNG_IMAGE_VERSION;
    description.width = raster.width;
    description.height = raster.height;
    description.format = (raster.channels >= 3 ? PNG_FORMAT_FLAG_COLOR : 0U) |
                         (raster.channels % 2 == 0 ? PNG_FORMAT_FLAG_ALPHA : 0U);
    png_alloc_size_t length = PNG_IMAGE_PNG_SIZE_MAX(description);
    std::vector<std::byte> bytes(length);
    const int written = png_image_write_to_memory(
        &description, bytes.data(), &length, 0, raster.pixels.data(), 0, nullptr
    );
    if (written == 0)
    {
        return fail(
            ErrorCode::Internal, std::string("cannot make a PNG image: ") + description.message
        );
    }
    bytes.resize(length);
    return bytes;
}

}  // namespace vsplit::image
