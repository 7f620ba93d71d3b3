#include "precompute/model_writers.h"

#include "precompute/image_header.h"

#include <bit>

namespace vsplit::precompute {

void append_text(ByteWriter& out, std::string_view text)
{
    out.write_bytes(std::as_bytes(std::span(text.data(), text.size())));
}

void append_float(ByteWriter& out, double value)
{
    out.write(std::bit_cast<std::uint32_t>(static_cast<float>(value)));
}

const SurfaceAttribute* first_of(const ModelView& model, AttributeKind kind)
{
    const SurfaceAttribute* found = nullptr;
    for (const SurfaceAttribute& attribute : model.attributes)
    {
        if (attribute.kind == kind && (found == nullptr || attribute.set < found->set))
        {
            found = &attribute;
        }
    }
    return found;
}

std::string image_file_name(const ModelView& model, std::int32_t image, const std::string& stem)
{
    if (image < 0 || static_cast<std::size_t>(image) >= model.images.size())
    {
        return "";
    }
    const auto header = read_image_header(model.images[static_cast<std::size_t>(image)].bytes);
    if (!header)
    {
        return "";
    }
    const char* const extension = header->format == ImageFormat::Png ? ".png" : ".jpg";
    return stem + "-" + std::to_string(image) + extension;
}

}  // namespace vsplit::precompute
