#pragma once

#include "mesh/indexed_mesh.h"
#include "precompute/mesh_io.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace vsplit::test {

/// A folder of its own for every test, removed afterwards.
class MeshFiles : public ::testing::Test
{
protected:
    void SetUp() override
    {
        const auto* const info = ::testing::UnitTest::GetInstance()->current_test_info();
        folder_ = std::filesystem::temp_directory_path() /
                  (std::string("vsplit-") + info->test_suite_name() + "-" + info->name());
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_);
    }

    void TearDown() override { std::filesystem::remove_all(folder_); }

    [[nodiscard]] std::filesystem::path path(std::string_view name) const { return folder_ / name; }

    /// Writes a file into the folder and returns its path.
    std::filesystem::path save(std::string_view name, std::string_view contents) const
    {
        std::ofstream(path(name), std::ios::binary) << contents;
        return path(name);
    }

    /// Writes a file and reads it as a mesh.
    [[nodiscard]] Result<IndexedMesh> read(std::string_view name, std::string_view contents) const
    {
        return precompute::read_mesh(save(name, contents));
    }

private:
    std::filesystem::path folder_;
};

/// Appends a value in either byte order.
template <typename T>
void append_value(std::string& out, T value, bool big_endian = false)
{
    std::array<char, sizeof(T)> bytes{};
    for (std::size_t i = 0; i < sizeof(T); ++i)
    {
        const auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
        bytes[i] = raw[big_endian ? sizeof(T) - 1 - i : i];
    }
    out.append(bytes.data(), bytes.size());
}

/// A tetrahedron, outwards.
inline IndexedMesh tetrahedron()
{
    return {
        {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}},
        {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
}

/// The folder of development meshes, empty when there is none.
inline std::filesystem::path models_folder()
{
    const char* const given = std::getenv("VSPLIT_MODELS");
    const std::filesystem::path folder =
        given != nullptr ? given : VSPLIT_SOURCE_DIR "/../shared/models";
    return std::filesystem::is_directory(folder) ? folder : std::filesystem::path();
}

/// All meshes of that folder, sorted by name.
inline std::vector<std::filesystem::path> model_files()
{
    std::vector<std::filesystem::path> files;
    if (models_folder().empty())
    {
        return files;
    }
    for (const auto& entry : std::filesystem::directory_iterator(models_folder()))
    {
        const auto extension = entry.path().extension();
        if (extension == ".ply" || extension == ".obj" || extension == ".off" ||
            extension == ".stl")
        {
            files.push_back(entry.path());
        }
    }
    std::sort(files.begin(), files.end());
    return files;
}

}  // namespace vsplit::test
