#include "precompute/mesh_io.h"

#include "core/file_io.h"
#include "precompute/mesh_readers.h"
#include "precompute/text_scan.h"

#include <algorithm>
#include <array>
#include <exception>
#include <new>
#include <string>

namespace vsplit::precompute {
namespace {

Result<IndexedMesh> read_text(
    std::span<const std::byte> bytes, Result<IndexedMesh> (*reader)(std::string_view)
)
{
    if (std::find(bytes.begin(), bytes.end(), std::byte{0}) != bytes.end())
    {
        return fail(ErrorCode::NotAMesh, "it holds binary data, not text");
    }
    std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    text.remove_prefix(text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0);
    return reader(text);
}

Result<IndexedMesh> parse(const std::string& extension, std::span<const std::byte> bytes)
{
    if (bytes.empty())
    {
        return fail(ErrorCode::NotAMesh, "the file is empty");
    }
    if (extension == ".ply")
    {
        return read_ply(bytes);
    }
    if (extension == ".stl")
    {
        return read_stl(bytes);
    }
    if (extension == ".om")
    {
        return read_om(bytes);
    }
    return read_text(bytes, extension == ".off" ? read_off : read_obj);
}

bool is_readable(const std::string& extension)
{
    constexpr std::array kExtensions{".ply", ".stl", ".off", ".obj", ".om"};
    return std::find(kExtensions.begin(), kExtensions.end(), extension) != kExtensions.end();
}

}  // namespace

Result<IndexedMesh> read_mesh(const std::filesystem::path& path)
{
    const std::string extension = lower_case(path.extension().string());
    const std::string start = "cannot read " + path.string() + ": ";
    try
    {
        // The name is looked up first, so that a missing file is called missing.
        if (std::filesystem::exists(path) && !is_readable(extension))
        {
            return fail(
                ErrorCode::UnsupportedInput,
                start + "the extension is none of .obj, .ply, .off, .stl and .om"
            );
        }
        const auto bytes = read_file(path);
        if (!bytes)
        {
            return tl::unexpected<Error>(bytes.error());
        }
        return parse(extension, *bytes).map_error([&](const Error& error) {
            return Error{error.code, start + error.message, error.offset};
        });
    }
    catch (const std::bad_alloc&)
    {
        return fail(ErrorCode::InputTooLarge, start + "there is not enough memory for it");
    }
    catch (const std::exception& exception)
    {
        return fail(ErrorCode::IoError, start + exception.what());
    }
}

}  // namespace vsplit::precompute
