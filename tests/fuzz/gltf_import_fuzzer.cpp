// Reads hostile GLB and glTF files, repairs what comes out and writes it again.

#include "precompute/mesh_readers.h"
#include "surface_check.h"

#include <cstddef>
#include <cstdint>
#include <span>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace vsplit;
    const auto bytes = std::as_bytes(std::span(data, size));
    // Every external file has the bytes of the document itself.
    const precompute::ReadCompanion read = [&](std::string_view) {
        return Result<std::vector<std::byte>>(std::vector<std::byte>(bytes.begin(), bytes.end()));
    };
    const auto model = precompute::read_gltf_model(bytes, read);
    if (!model)
    {
        fuzz::require(exit_status(model.error().code) == 3);  // bad input mesh, nothing else
        return 0;
    }
    fuzz::check_model(*model);
    fuzz::check_use(*model);
    return 0;
}
