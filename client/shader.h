#pragma once

#include "core/result.h"

namespace vsplit::client {

/// Compiles and links a program for the current OpenGL ES 3 context.
/// `vertex_source`, `fragment_source`: GLSL ES 3.00 text, zero-terminated.
/// Result: the program's name, to be deleted by the caller. Error: Internal with the driver's log.
[[nodiscard]] Result<unsigned> build_program(
    const char* vertex_source, const char* fragment_source
);

/// Source of the vertex shader for the model: attribute 0 position, 1 sum of normals and
/// of their weights (GpuVertex).
[[nodiscard]] const char* model_vertex_source();

/// Source of the fragment shader for the model.
[[nodiscard]] const char* model_fragment_source();

/// Source of the fragment shader for the lines of the grid display.
[[nodiscard]] const char* line_fragment_source();

/// Source of the vertex shader for the background, one triangle without attributes.
[[nodiscard]] const char* background_vertex_source();

/// Source of the fragment shader for the background.
[[nodiscard]] const char* background_fragment_source();

}  // namespace vsplit::client
