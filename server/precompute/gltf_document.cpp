// Based on: Khronos, "glTF 2.0 Specification", 2021, section 4.4 (GLB).
#include "precompute/gltf_document.h"

#include "core/byte_writer.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <exception>
#include <limits>
#include <new>
#include <string>
#include <string_view>
#include <utility>

namespace vsplit::precompute {
namespace {

constexpr std::size_t kGlbHeaderBytes = 20;
constexpr std::string_view kDracoName = "KHR_draco_mesh_compression";

std::uint32_t little_endian(std::span<const std::byte> bytes, std::size_t offset)
{
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
    {
        value |= static_cast<std::uint32_t>(bytes[offset + i]) << (8 * i);
    }
    return value;
}

bool is_glb(std::span<const std::byte> bytes)
{
    constexpr std::uint32_t kMagic = 0x46546C67;
    return bytes.size() >= kGlbHeaderBytes && little_endian(bytes, 0) == kMagic;
}

/// The JSON of either form; empty when a GLB file is cut off.
std::string_view json_of(std::span<const std::byte> bytes)
{
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (!is_glb(bytes))
    {
        return text;
    }
    const std::size_t length = little_endian(bytes, 12);
    return length <= text.size() - kGlbHeaderBytes ? text.substr(kGlbHeaderBytes, length) : "";
}

/// Tells whether JSON is nested so deeply that recursion over it is dangerous.
bool too_deep(std::string_view json)
{
    constexpr std::size_t kDeepest = 128;
    std::size_t depth = 0;
    bool inside_string = false;
    for (std::size_t i = 0; i < json.size(); ++i)
    {
        const char letter = json[i];
        if (inside_string)
        {
            i += letter == '\\' ? 1 : 0;
            inside_string = letter != '"';
            continue;
        }
        inside_string = letter == '"';
        depth += letter == '{' || letter == '[' ? 1 : 0;
        depth -= (letter == '}' || letter == ']') && depth > 0 ? 1 : 0;
        if (depth > kDeepest)
        {
            return true;
        }
    }
    return false;
}

/// Takes the index accessors off Draco's primitives: they have no buffer view, which tinygltf refuses,
/// and Draco says the indices itself.
std::string without_draco_indices(std::string_view text)
{
    nlohmann::json document = nlohmann::json::parse(text);
    for (auto& mesh : document.at("meshes"))
    {
        for (auto& primitive : mesh.at("primitives"))
        {
            if (primitive.contains("extensions") && primitive["extensions"].contains(kDracoName))
            {
                primitive.erase("indices");
            }
        }
    }
    return document.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// Puts other JSON into a GLB file.
std::vector<std::byte> with_json(std::span<const std::byte> bytes, std::string json)
{
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const auto rest = bytes.subspan(kGlbHeaderBytes + json_of(bytes).size());
    ByteWriter out;
    out.write_bytes(bytes.first(8));
    out.write(static_cast<std::uint32_t>(kGlbHeaderBytes + json.size() + rest.size()));
    out.write(static_cast<std::uint32_t>(json.size()));
    out.write_bytes(bytes.subspan(16, 4));
    out.write_bytes(std::as_bytes(std::span(json)));
    out.write_bytes(rest);
    return out.take();
}

/// Keeps the bytes of an image that is not in a buffer.
bool keep_image(
    tinygltf::Image* image,
    int /*index*/,
    std::string* /*error*/,
    std::string* /*warning*/,
    int /*width*/,
    int /*height*/,
    const unsigned char* bytes,
    int size,
    void* /*user*/
)
{
    if (image->bufferView < 0 && size > 0)
    {
        image->image.assign(bytes, bytes + size);
    }
    image->as_is = true;
    return true;
}

bool read_external(
    std::vector<unsigned char>* out, std::string* error, const std::string& name, void* user
)
{
    const auto& read = *static_cast<const ReadCompanion*>(user);
    if (!read)
    {
        return false;
    }
    const auto bytes = read(name);
    if (!bytes)
    {
        *error = bytes.error().message;
        return false;
    }
    out->resize(bytes->size());
    std::ranges::transform(*bytes, out->begin(), [](std::byte byte) {
        return static_cast<unsigned char>(byte);
    });
    return true;
}

tinygltf::FsCallbacks callbacks(const ReadCompanion& read)
{
    tinygltf::FsCallbacks calls{};
    calls.FileExists = [](const std::string&, void*) { return true; };  // reading will tell
    calls.ExpandFilePath = [](const std::string& name, void*) { return name; };
    calls.ReadWholeFile = read_external;
    calls.user_data = const_cast<ReadCompanion*>(&read);
    return calls;
}

tl::unexpected<Error> not_understood(std::string_view reason)
{
    std::string line(reason.substr(0, reason.find('\n')));
    std::replace_if(
        line.begin(), line.end(), [](char letter) { return letter < ' ' || letter > '~'; }, '?'
    );
    return fail(ErrorCode::NotAMesh, "the glTF file is not understood: " + line.substr(0, 200));
}

Result<tinygltf::Model> load(std::span<const std::byte> bytes, const ReadCompanion& read)
{
    tinygltf::TinyGLTF loader;
    loader.SetImageLoader(keep_image, nullptr);
    loader.SetFsCallbacks(callbacks(read));
    tinygltf::Model model;
    std::string error;
    std::string warning;
    const auto size = static_cast<unsigned int>(bytes.size());
    const bool loaded =
        is_glb(bytes)
            ? loader.LoadBinaryFromMemory(
                  &model,
                  &error,
                  &warning,
                  reinterpret_cast<const unsigned char*>(bytes.data()),
                  size
              )
            : loader.LoadASCIIFromString(
                  &model, &error, &warning, reinterpret_cast<const char*>(bytes.data()), size, ""
              );
    return loaded ? Result<tinygltf::Model>(std::move(model)) : not_understood(error);
}

}  // namespace

Result<tinygltf::Model> parse_gltf(std::span<const std::byte> bytes, const ReadCompanion& read)
{
    if (bytes.size() > std::numeric_limits<std::int32_t>::max())
    {
        return fail(ErrorCode::InputTooLarge, "glTF files of 2 GiB and more are not supported");
    }
    const std::string_view json = json_of(bytes);
    if (too_deep(json))
    {
        return fail(ErrorCode::InputTooLarge, "the JSON of the glTF file is nested too deeply");
    }
    try
    {
        if (json.find(kDracoName) == json.npos)
        {
            return load(bytes, read);
        }
        std::string changed = without_draco_indices(json);
        if (is_glb(bytes))
        {
            return load(with_json(bytes, std::move(changed)), read);
        }
        return load(std::as_bytes(std::span(changed)), read);
    }
    catch (const std::bad_alloc&)
    {
        throw;  // is an InputTooLarge of whoever reads the file
    }
    catch (const std::exception& exception)
    {
        return not_understood(exception.what());
    }
}

Result<std::span<const std::byte>> view_bytes(const tinygltf::Model& model, int view)
{
    const auto bad = fail(ErrorCode::NotAMesh, "a buffer view of the glTF file leaves its buffer");
    if (view < 0 || static_cast<std::size_t>(view) >= model.bufferViews.size())
    {
        return bad;
    }
    const tinygltf::BufferView& row = model.bufferViews[static_cast<std::size_t>(view)];
    if (row.buffer < 0 || static_cast<std::size_t>(row.buffer) >= model.buffers.size())
    {
        return bad;
    }
    const auto& data = model.buffers[static_cast<std::size_t>(row.buffer)].data;
    if (row.byteOffset > data.size() || row.byteLength > data.size() - row.byteOffset)
    {
        return bad;
    }
    return std::as_bytes(std::span(data)).subspan(row.byteOffset, row.byteLength);
}

}  // namespace vsplit::precompute
