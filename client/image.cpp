#include "image.h"

#include "core/assert.h"
#include "core/file_io.h"

#include <png.h>

#include <cstddef>
#include <span>

namespace vsplit::client {

Result<void> write_png(const std::filesystem::path& path, const Image& image)
{
    VSPLIT_ASSERT(image.pixels.size() == std::size_t{3} * image.width * image.height);
    png_image description{};
    description.version = PNG_IMAGE_VERSION;
    description.width = image.width;
    description.height = image.height;
    description.format = PNG_FORMAT_RGB;
    png_alloc_size_t length = PNG_IMAGE_PNG_SIZE_MAX(description);
    std::vector<std::byte> bytes(length);
    const int written = png_image_write_to_memory(
        &description, bytes.data(), &length, 0, image.pixels.data(), 0, nullptr
    );
    if (written == 0)
    {
        return fail(
            ErrorCode::Internal,
            "cannot make the picture " + path.string() + ": " + description.message
        );
    }
    return write_file_atomically(path, std::span(bytes).first(length));
}

}  // namespace vsplit::client
