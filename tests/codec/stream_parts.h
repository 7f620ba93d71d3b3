#pragma once

#include "codec/stream_decoder.h"
#include "codec/stream_info.h"
#include "core/result.h"
#include "mesh/indexed_mesh.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

namespace vsplit::test {

using Bytes = std::vector<std::byte>;

/// A stream taken apart, so that a test can change a part of it and still get past the checksums.
struct StreamParts
{
    codec::StreamInfo info;
    std::array<std::int32_t, 3> extent{};  ///< Largest grid index per axis.
    std::vector<Bytes> chunks;             ///< Contents without their checksums.
};

/// Takes a valid stream apart.
[[nodiscard]] StreamParts take_apart(std::span<const std::byte> file);

/// Puts a stream together: lengths and checksums are those of the chunks as they are now, everything
/// else is written as `parts.info` says, right or wrong.
[[nodiscard]] Bytes put_together(const StreamParts& parts);

/// Makes the header's checksum and, as far as the index can be read then, those of the chunks right.
void repair_checksums(Bytes& file);

/// What a decoder shows at one moment.
struct Snapshot
{
    std::uint32_t level = 0;
    int shift = 0;
    GridMesh mesh;  ///< Positions in units of 2^shift cells.

    friend bool operator==(const Snapshot& a, const Snapshot& b)
    {
        return a.level == b.level && a.shift == b.shift && a.mesh.positions == b.mesh.positions &&
               a.mesh.triangles == b.mesh.triangles;
    }
};

/// Copies what a decoder shows.
[[nodiscard]] Snapshot snapshot(const codec::StreamDecoder& decoder);

/// The attributes of a level.
struct ShownAttributes
{
    std::uint32_t level = 0;
    codec::LevelAttributes attributes;
};

/// What became of a stream.
struct Decoded
{
    std::vector<Snapshot> chunks;             ///< After every chunk that changed the mesh.
    std::vector<Snapshot> levels;             ///< After every level.
    Snapshot last;                            ///< In the end, also after an error.
    std::vector<ShownAttributes> attributes;  ///< Whenever some were complete.
    std::vector<std::uint32_t> stitches;
    std::optional<Error> error;
    bool complete = false;
    std::size_t taken = 0;  ///< Bytes that the decoder took.
};

/// Feeds a whole stream and decodes as far as it goes.
[[nodiscard]] Decoded decode(
    std::span<const std::byte> file, const codec::DecodeLimits& limits = {}
);

/// Whole contents of a file of the source tree; throws std::runtime_error when it cannot be read.
[[nodiscard]] Bytes read_source_file(const std::filesystem::path& path);

}  // namespace vsplit::test
