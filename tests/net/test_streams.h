#pragma once

#include "net/served_stream.h"
#include "wire/frame.h"
#include "wire/message.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace vsplit::test {

using Bytes = std::vector<std::byte>;

/// A stream file whose header and index are real and whose chunks are noise: a server never looks into
/// chunks. `chunk_bytes`: one length per level; `seed`: of the noise.
[[nodiscard]] Bytes make_stream_file(const std::vector<std::uint32_t>& chunk_bytes, unsigned seed);

/// The same as a session holds it.
[[nodiscard]] net::StreamPtr make_served_stream(
    const std::vector<std::uint32_t>& chunk_bytes, unsigned seed
);

/// A folder that is deleted with everything in it.
class TemporaryFolder
{
public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

    /// Writes a file, and the folders it needs, below this folder; returns its path.
    std::filesystem::path write(const std::string& name, std::span<const std::byte> bytes) const;

    /// Writes a text file that may be executed.
    std::filesystem::path write_program(const std::string& name, const std::string& text) const;

private:
    std::filesystem::path path_;
};

/// What a server sent, taken apart and checked to be well formed.
struct ServerTalk
{
    std::vector<wire::FrameType> frames;  ///< Neighbouring Data frames count once.
    std::vector<wire::ModelInfo> infos;
    std::vector<wire::Done> dones;
    std::vector<wire::Failure> failures;
    Bytes data;
    std::size_t bytes = 0;
    bool complete = false;  ///< True when it ends between two frames.
};

/// Takes apart all bytes that a server sent on one connection. Throws std::runtime_error when they
/// break the protocol.
[[nodiscard]] ServerTalk understand(std::span<const std::byte> bytes);

/// Concatenates.
[[nodiscard]] Bytes joined(Bytes first, const Bytes& second);

}  // namespace vsplit::test
