#pragma once

#include "codec/stream_parts.h"
#include "mesh/indexed_mesh.h"
#include "precompute/encode_mesh.h"

#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

namespace vsplit::test {

/// A stream and what went into it.
struct EncodedSample
{
    IndexedMesh mesh;  ///< After repair.
    std::vector<std::uint32_t> stitches;
    GridMesh source;  ///< The same on the stream's grid.
    Bytes file;
    codec::StreamInfo info;
};

/// Repairs and encodes a mesh; throws std::runtime_error when that fails.
[[nodiscard]] EncodedSample encode(
    const IndexedMesh& mesh, const precompute::EncodeOptions& options = {}
);

/// A mesh by name, for tests that run over several.
struct NamedMesh
{
    std::string name;
    std::function<IndexedMesh()> make;
};

/// Prints the name.
std::ostream& operator<<(std::ostream& out, const NamedMesh& mesh);

/// Small meshes of every kind: single faces, closed and open ones, hubs, several components, holes,
/// a mesh that repair cuts.
[[nodiscard]] const std::vector<NamedMesh>& small_meshes();

}  // namespace vsplit::test
