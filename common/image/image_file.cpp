#include "image/image_file.h"

#include "image/image_formats.h"

#include <algorithm>
#include <array>
#include <string>

namespace vsplit::image {

namespace {

constexpr std::array<std::byte, 4> kPngMagic{
    std::byte{0x89}, std::byte{'P'}, std::byte{'N'}, std::byte{'G'}};
constexpr std::array<std::byte, 3> kJpegMagic{std::byte{0xFF}, std::byte{0xD8}, std::byte{0xFF}};

bool starts_with(std::span<const std::byte> bytes, std::span<const std::byte> magic)
{
    return bytes.size() >= magic.size() && std::equal(magic.begin(), magic.end(), bytes.begin());
}

Result<Raster> read(std::span<const std::byte> bytes, const ImageLimits& limits, Extent extent)
{
    if (starts_with(bytes, kPngMagic))
    {
        return read_png(bytes, limits, extent);
    }
    if (starts_with(bytes, kJpegMagic))
    {
        return read_jpeg(bytes, limits, extent);
    }
    return fail(ErrorCode::UnsupportedInput, "an image is neither PNG nor JPEG");
}

}  // namespace

Result<void> check_size(std::uint64_t width, std::uint64_t height, const ImageLimits& limits)
{
    if (width > limits.max_side || height > limits.max_side || width * height > limits.max_pixels)
    {
        return fail(
            ErrorCode::InputTooLarge,
            "an image of " + std::to_string(width) + " x " + std::to_string(height) +
                " pixels is too large"
        );
    }
    return {};
}

Result<ImageInfo> probe_image(std::span<const std::byte> bytes, const ImageLimits& limits)
{
    const auto head = read(bytes, limits, Extent::Header);
    VSPLIT_TRY(head);
    return ImageInfo{
        .name = {}, .width = head->width, .height = head->height, .channels = head->channels};
}

Result<Raster> read_image(std::span<const std::byte> bytes, const ImageLimits& limits)
{
    return read(bytes, limits, Extent::All);
}

}  // namespace vsplit::image
