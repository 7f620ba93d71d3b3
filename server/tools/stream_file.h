#pragma once

#include "codec/stream_decoder.h"
#include "codec/stream_info.h"
#include "core/result.h"

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

namespace vsplit::tools {

/// A vsplit file that is read piece by piece. Not thread safe. Safe on untrusted files.
class StreamFile
{
public:
    /// Opens a file and reads its header and index. Errors: NotFound, IoError, and those of
    /// codec::parse_stream_info(), with the file's name in the message.
    [[nodiscard]] static Result<StreamFile> open(const std::filesystem::path& path);

    /// Header and index.
    [[nodiscard]] const codec::StreamInfo& info() const { return info_; }

    /// Length of the file as it is, which may be cut off or too long.
    [[nodiscard]] std::uint64_t size() const { return size_; }

    /// Name for messages.
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

    /// Length of the longest prefix that ends with a chunk and that the file holds completely.
    /// Error: Truncated when not even the base mesh is there.
    [[nodiscard]] Result<std::uint64_t> complete_prefix() const;

    /// Called after every step that changed the mesh; an error ends the decoding.
    using StepSink = std::function<Result<void>(const codec::Step&)>;

    /// Feeds the first `bytes` of the file to a fresh decoder through a small buffer.
    /// `bytes`: a chunk boundary within the file; `seconds`: gets the time spent in the decoder.
    /// Errors: IoError, those of StreamDecoder with the file's name, those of `sink`.
    [[nodiscard]] Result<void> decode(
        codec::StreamDecoder& decoder,
        std::uint64_t bytes,
        double& seconds,
        const StepSink& sink = {}
    );

private:
    struct Closer
    {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };

    StreamFile() = default;
    [[nodiscard]] Result<std::size_t> read(std::uint64_t offset, std::span<std::byte> out);
    [[nodiscard]] Result<codec::StreamInfo> read_info();

    std::filesystem::path path_;
    std::unique_ptr<std::FILE, Closer> file_;
    std::uint64_t size_ = 0;
    codec::StreamInfo info_;
    std::vector<std::byte> buffer_;
};

}  // namespace vsplit::tools
