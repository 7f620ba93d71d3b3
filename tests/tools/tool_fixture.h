#pragma once

#include "mesh/indexed_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace vsplit::test {

/// A finished program.
struct Finished
{
    int status = -1;               ///< Exit status; 128 plus the signal's number when one ended it.
    std::string out;               ///< Standard output.
    std::string err;               ///< Standard error.
    std::uint64_t peak_bytes = 0;  ///< Largest resident memory.

    /// Standard output as JSON; discarded (a null-like value) when it is none.
    [[nodiscard]] nlohmann::json json() const { return nlohmann::json::parse(out, nullptr, false); }
};

/// A bumpy torus of `around` times `across` vertices, closed, two triangles for each.
[[nodiscard]] IndexedMesh bumpy_torus(std::uint32_t around = 32, std::uint32_t across = 16);

/// Runs the real `vsplit` in a folder of its own for every test, removed afterwards.
class VsplitTool : public ::testing::Test
{
protected:
    void SetUp() override;
    void TearDown() override;

    /// Path of a file in the test's folder.
    [[nodiscard]] std::string path(std::string_view name) const
    {
        return (folder_ / name).string();
    }

    /// Runs `vsplit` with arguments and waits for it.
    [[nodiscard]] Finished run(const std::vector<std::string>& arguments) const;

    /// Writes a file into the folder and returns its path.
    std::string save(std::string_view name, std::string_view contents) const;

    /// Whole contents of a file in the folder.
    [[nodiscard]] std::string load(std::string_view name) const;

    /// Writes the torus as `torus.ply`, encodes it as `torus.vsplit` and returns encode's JSON.
    nlohmann::json encode_torus() const;

    /// Names of all files in the folder, sorted.
    [[nodiscard]] std::vector<std::string> files() const;

    /// Checks for exactly one line "vsplit: ..." on standard error and nothing on standard output.
    static void expect_one_line_error(const Finished& finished, int status);

private:
    std::filesystem::path folder_;
};

}  // namespace vsplit::test
