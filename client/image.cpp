#include "image.h"

#include "core/assert.h"
#include "core/file_io.h"
#include "image/image_file.h"

#include <cstddef>

namespace vsplit::client {

Result<void> write_png(const std::filesystem::path& path, const Image& image)
{
    VSPLIT_ASSERT(image.pixels.size() == std::size_t{3} * image.width * image.height);
    const auto bytes = vsplit::image::write_png(
        {.width = image.width, .height = image.height, .channels = 3, .pixels = image.pixels}
    );
    if (!bytes)
    {
        return fail(
            bytes.error().code,
            "cannot make the picture " + path.string() + ": " + bytes.error().message
        );
    }
    return write_file_atomically(path, *bytes);
}

}  // namespace vsplit::client
