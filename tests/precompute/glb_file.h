#pragma once

#include "mesh_files.h"

#include <cstdint>
#include <string>
#include <string_view>

namespace vsplit::test {

/// Puts a GLB file together. `json`: the document, with one buffer of `buffer`.
inline std::string glb_file(std::string json, std::string buffer)
{
    json.resize((json.size() + 3) / 4 * 4, ' ');
    buffer.resize((buffer.size() + 3) / 4 * 4, '\0');
    std::string file("glTF");
    append_value(file, std::uint32_t{2});
    append_value(file, static_cast<std::uint32_t>(28 + json.size() + buffer.size()));
    append_value(file, static_cast<std::uint32_t>(json.size()));
    file += "JSON" + json;
    append_value(file, static_cast<std::uint32_t>(buffer.size()));
    file += std::string("BIN\0", 4) + buffer;
    return file;
}

/// Numbers one after the other, as a buffer has them.
template <typename T>
std::string packed(std::initializer_list<T> values)
{
    std::string bytes;
    for (const T value : values)
    {
        append_value(bytes, value);
    }
    return bytes;
}

}  // namespace vsplit::test
