#pragma once

namespace vsplit::client {

/// Source of the vertex shader for levels with attributes: attribute 0 position, 1 normal times
/// flatness, 2 colour, 3 and 4 texture coordinates. Its uniforms are those of model_vertex_source().
[[nodiscard]] const char* surface_vertex_source();

/// Source of the fragment shader for levels with attributes. Uniforms: u_paint (0: without a material),
/// u_color_is_linear, u_base_factor, u_base_map, u_emissive_factor, u_emissive_map, u_normal_map,
/// u_normal_scale, u_map_sets (which texture coordinates these have; below 0: no map), u_alpha_cutoff
/// (below 0: none), u_roughness.
[[nodiscard]] const char* surface_fragment_source();

}  // namespace vsplit::client
