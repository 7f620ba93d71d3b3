#pragma once

#include "codec/stream_info.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace vsplit::test {

/// A stream file and what its index says.
struct EncodedModel
{
    std::filesystem::path path;
    std::vector<std::byte> bytes;
    codec::StreamInfo info;
};

/// A test with a folder of its own (removed afterwards): `root` for a server, `logs`, and room.
class ModelFolderTest : public testing::Test
{
protected:
    void SetUp() override;
    void TearDown() override;

    /// Encodes a mesh of assets/ into the root as NAME.vsplit with `vsplit encode`. Throws when that
    /// fails.
    [[nodiscard]] EncodedModel encode(const std::string& asset, const std::string& name) const;

    /// Encodes any mesh file, with further options of `vsplit encode`; otherwise as encode().
    [[nodiscard]] EncodedModel encode_file(
        const std::filesystem::path& mesh,
        const std::string& name,
        const std::vector<std::string>& options = {}
    ) const;

    /// Encodes a terrain of random heights at 20 bits: noise compresses badly, so the stream is some
    /// 100 kB long, more than the kernels hold for a client that reads slowly.
    [[nodiscard]] EncodedModel encode_large(const std::string& name) const;

    /// Returns a mesh file of assets/.
    [[nodiscard]] static std::filesystem::path asset(const std::string& file);

    std::filesystem::path folder_;
    std::filesystem::path root_;
    std::filesystem::path logs_;
};

}  // namespace vsplit::test
