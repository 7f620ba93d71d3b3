#pragma once

#include "core/byte_writer.h"
#include "core/result.h"
#include "precompute/model_view.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace vsplit::precompute {

/// A file that is to stand beside a model.
struct WrittenFile
{
    std::string name;  ///< Without folder.
    std::vector<std::byte> bytes;
};

/// A model in a file format. The first file is the model itself, its name is empty.
using WrittenFiles = std::vector<WrittenFile>;

/// Writes PLY, binary little-endian: positions, normals, the first texture coordinates (v upwards) and
/// colours (eight bits when they lose nothing), scalars; vertices are split where these have several
/// values. The first image of a base colour stands beside it, named in a comment.
/// `stem`: starts the names of other files. Cost: linear. Deterministic. Thread safe.
/// Source: Turk, "The PLY Polygon File Format", 1994.
[[nodiscard]] WrittenFiles format_ply(const ModelView& model, const std::string& stem);

/// Writes OBJ with its materials in `stem`.mtl and images beside it: positions (split only where colours
/// differ), colours behind them, the first texture coordinates (v upwards) and normals, groups.
/// Everything else as format_ply().
/// Source: Wavefront, "Object Files (.obj)", appendix B1 of the Advanced Visualizer manual.
[[nodiscard]] WrittenFiles format_obj(const ModelView& model, const std::string& stem);

/// Writes GLB: one mesh a group name with one primitive a group, everything in one buffer.
/// Errors: EmptyMesh (glTF knows no empty meshes), InputTooLarge (4 GiB and more). Cost: linear.
/// Deterministic. Thread safe.
/// Source: Khronos, "glTF 2.0 Specification", 2021.
[[nodiscard]] Result<WrittenFiles> format_glb(const ModelView& model);

/// Appends text.
void append_text(ByteWriter& out, std::string_view text);

/// Appends a number in single precision.
void append_float(ByteWriter& out, double value);

/// The attribute of a kind with the smallest set; nothing when there is none.
[[nodiscard]] const SurfaceAttribute* first_of(const ModelView& model, AttributeKind kind);

/// Name of the file of an image: `stem`, its number, and .png or .jpg; empty when it is neither.
[[nodiscard]] std::string image_file_name(
    const ModelView& model, std::int32_t image, const std::string& stem
);

}  // namespace vsplit::precompute
