#include "precompute/mesh_io.h"

#include "core/file_io.h"
#include "precompute/mesh_readers.h"
#include "precompute/surface_io.h"
#include "precompute/text_scan.h"

#include <algorithm>
#include <array>
#include <exception>
#include <new>
#include <string>
#include <utility>

namespace vsplit::precompute {
namespace {

Result<std::string_view> as_text(std::span<const std::byte> bytes)
{
    if (std::find(bytes.begin(), bytes.end(), std::byte{0}) != bytes.end())
    {
        return fail(ErrorCode::NotAMesh, "it holds binary data, not text");
    }
    std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    text.remove_prefix(text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0);
    return text;
}

/// Reads the formats that hold nothing but geometry for us.
Result<IndexedMesh> parse_bare(const std::string& extension, std::span<const std::byte> bytes)
{
    if (extension == ".stl")
    {
        return read_stl(bytes);
    }
    if (extension == ".om")
    {
        return read_om(bytes);
    }
    return as_text(bytes).and_then(read_off);
}

/// `read`: gives companions; empty when only the mesh is wanted.
Result<SourceModel> parse(
    const std::string& extension, std::span<const std::byte> bytes, const ReadCompanion& read
)
{
    if (bytes.empty())
    {
        return fail(ErrorCode::NotAMesh, "the file is empty");
    }
    if (extension == ".ply")
    {
        return read_ply_model(bytes, read);
    }
    if (extension == ".glb" || extension == ".gltf")
    {
        return read_gltf_model(bytes, read);
    }
    if (extension == ".obj")
    {
        return as_text(bytes).and_then([&](std::string_view text) {
            return read_obj_model(text, read);
        });
    }
    return parse_bare(extension, bytes).map([](IndexedMesh mesh) {
        SourceModel model;
        model.surface.mesh = std::move(mesh);
        return model;
    });
}

bool is_readable(const std::string& extension)
{
    constexpr std::array kExtensions{".ply", ".stl", ".off", ".obj", ".om", ".glb", ".gltf"};
    return std::find(kExtensions.begin(), kExtensions.end(), extension) != kExtensions.end();
}

Result<SourceModel> read_model(const std::filesystem::path& path, const ReadCompanion& read)
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
                start + "the extension is none of .obj, .ply, .glb, .gltf, .off, .stl and .om"
            );
        }
        const auto bytes = read_file(path);
        if (!bytes)
        {
            return tl::unexpected<Error>(bytes.error());
        }
        return parse(extension, *bytes, read).map_error([&](const Error& error) {
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

}  // namespace

Result<IndexedMesh> read_mesh(const std::filesystem::path& path)
{
    // A .gltf file has its mesh in another one.
    const bool split = lower_case(path.extension().string()) == ".gltf";
    return read_model(path, split ? companions_in(path.parent_path()) : nullptr)
        .map([](SourceModel model) { return std::move(model.surface.mesh); });
}

Result<SourceModel> read_surface(const std::filesystem::path& path)
{
    std::vector<std::string> unused;
    return read_surface(path, unused);
}

Result<SourceModel> read_surface(
    const std::filesystem::path& path, std::vector<std::string>& companions
)
{
    const ReadCompanion read = companions_in(path.parent_path());
    return read_model(path, [&](std::string_view name) {
        std::string portable(name);
        std::replace(portable.begin(), portable.end(), '\\', '/');
        if (std::find(companions.begin(), companions.end(), portable) == companions.end())
        {
            companions.push_back(std::move(portable));
        }
        return read(name);
    });
}

}  // namespace vsplit::precompute
