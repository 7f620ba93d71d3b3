#pragma once

#include "core/result.h"
#include "precompute/model_view.h"
#include "precompute/source_model.h"

#include <filesystem>
#include <string>
#include <vector>

namespace vsplit::precompute {

/// Reads a model: GLB, glTF 2.0, OBJ with its materials, PLY, OFF, STL, OM (the latter three without attributes).
/// Polygons are triangulated as fans. Nothing is repaired; see repair_surface().
/// `path`: the format is told by the extension, then checked against the contents; images and material
/// libraries are read from its folder and below it, nowhere else.
/// Result: the triangles in file order, model units; attributes as tidy_attributes() leaves them;
/// textures whose image is missing or neither PNG nor JPEG are taken off and noted.
/// Errors: NotFound, IoError, UnsupportedInput, NotAMesh, BadCoordinate, BadIndex, InputTooLarge,
/// EmptyMesh. Counts that a file claims are checked against its size before anything is allocated.
/// Thread safe. Safe on untrusted input.
[[nodiscard]] Result<SourceModel> read_surface(const std::filesystem::path& path);

/// As above; `companions` gets the names of the files that the model refers to, each once, as paths from
/// its folder, whether they are there or not, and also when the model cannot be read.
[[nodiscard]] Result<SourceModel> read_surface(
    const std::filesystem::path& path, std::vector<std::string>& companions
);

/// Writes a model: GLB with everything in one file, OBJ with materials and images beside it, PLY with
/// what vertices can have and one image beside it, OFF and STL without attributes; told by the extension.
/// model_writers.h says what each can hold. Files beside the model are named after it; every file
/// appears under its name only when it is complete, the model last.
/// `model`: indices in range. Errors: UnsupportedInput (unknown extension), IoError, and for GLB EmptyMesh
/// and InputTooLarge. Deterministic. Thread safe.
[[nodiscard]] Result<void> write_surface(const std::filesystem::path& path, const ModelView& model);

}  // namespace vsplit::precompute
