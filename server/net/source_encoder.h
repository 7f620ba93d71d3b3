#pragma once

#include "core/result.h"
#include "net/child_process.h"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>

namespace vsplit::net {

/// How source meshes are encoded.
struct EncoderSettings
{
    std::filesystem::path program;              ///< The vsplit tool, absolute.
    std::filesystem::path cache;                ///< Folder for encoded streams; empty: none.
    std::uint64_t memory_bytes = 0;             ///< Address space of an encoder, 0 no bound.
    std::chrono::seconds time_limit{600};       ///< Longest time that one mesh may take.
    std::uint64_t max_source_bytes = 1U << 31;  ///< Larger source meshes are refused.
};

/// Encodes source meshes into the cache folder, each in a child process with limits. Thread safe.
class SourceEncoder
{
public:
    /// `settings`: the program need not exist until the first encode().
    explicit SourceEncoder(EncoderSettings settings) : settings_(std::move(settings)) {}

    /// Returns where the encoded form of a source mesh is or will be. The name depends on the path,
    /// size and time of the source and on the state of the encoder program, so that neither a changed
    /// mesh nor a new encoder meets an old result.
    /// Errors: UnsupportedInput without a cache folder, InputTooLarge, NotFound, IoError.
    [[nodiscard]] Result<std::filesystem::path> target_of(const std::filesystem::path& source
    ) const;

    /// Says whether a file that `source` refers to (materials, images, buffers) has changed, come or been
    /// put in place of another since encode() made or failed to make `target`. False when nothing is known.
    [[nodiscard]] bool is_stale(
        const std::filesystem::path& source, const std::filesystem::path& target
    ) const;

    /// Takes an encoded form, or what is known of one that failed, out of the cache folder.
    void forget(const std::filesystem::path& target) const;

    /// Encodes `source` into `target`; blocks until the child has ended. The target appears complete
    /// or not at all; what the source refers to is listed beside it for is_stale(). Errors: EncodeFailed with the child's own words (without the folder of the
    /// source), IoError when it cannot be started, Cancelled after
    /// stop().
    [[nodiscard]] Result<void> encode(
        const std::filesystem::path& source, const std::filesystem::path& target
    ) const;

    /// Kills the running children; later ones end at once.
    void stop() { stop_.set(); }

private:
    EncoderSettings settings_;
    StopEvent stop_;
};

}  // namespace vsplit::net
