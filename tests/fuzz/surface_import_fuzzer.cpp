// Reads hostile PLY and OBJ files with what lies on them; material libraries and images are the rest of
// the input. The first byte chooses the format, a byte 0xFF ends the model.

#include "precompute/mesh_readers.h"
#include "surface_check.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace {

using namespace vsplit;

Result<precompute::SourceModel> read(std::uint8_t format, std::span<const std::byte> bytes)
{
    const auto end = std::ranges::find(bytes, std::byte{0xFF});
    const std::span<const std::byte> text(bytes.begin(), end);
    const std::span<const std::byte> rest(end, bytes.end());
    const precompute::ReadCompanion companion = [&](std::string_view name) {
        // Images start with 0x89 or 0xFF, libraries with what follows that.
        const bool library = name.ends_with(".mtl") && !rest.empty();
        const auto file = library ? rest.subspan(1) : rest;
        return Result<std::vector<std::byte>>(std::vector<std::byte>(file.begin(), file.end()));
    };
    if (format % 2 == 0)
    {
        return precompute::read_ply_model(bytes, companion);
    }
    return precompute::read_obj_model(
        std::string_view(reinterpret_cast<const char*>(text.data()), text.size()), companion
    );
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    if (size == 0)
    {
        return 0;
    }
    const auto model = read(data[0], std::as_bytes(std::span(data, size)).subspan(1));
    if (!model)
    {
        fuzz::require(exit_status(model.error().code) == 3);  // bad input mesh, nothing else
        return 0;
    }
    fuzz::check_model(*model);
    fuzz::check_use(*model);
    return 0;
}
