// Based on: Schueler, "Normal Mapping without Precomputed Tangents", ShaderX 5, 2006 (the frame of a
// normal map from derivatives).
#include "surface_shader.h"

namespace vsplit::client {
namespace {

constexpr const char* kSurfaceVertex = R"(#version 300 es
layout(location = 0) in vec3 a_position;
layout(location = 1) in vec4 a_normal;
layout(location = 2) in vec4 a_color;
layout(location = 3) in vec2 a_uv0;
layout(location = 4) in vec2 a_uv1;
uniform mat4 u_to_eye;
uniform mat4 u_to_clip;
out highp vec3 v_eye;
out highp vec3 v_normal;
out highp float v_flatness;
out highp vec4 v_color;
out highp vec2 v_uv0;
out highp vec2 v_uv1;
void main()
{
    vec4 eye = u_to_eye * vec4(a_position, 1.0);
    v_eye = eye.xyz;
    float flatness = length(a_normal.xyz);
    v_normal = flatness > 0.0 ? mat3(u_to_eye) * (a_normal.xyz / flatness) : vec3(0.0);
    v_flatness = flatness;
    v_color = a_color;
    v_uv0 = a_uv0;
    v_uv1 = a_uv1;
    gl_Position = u_to_clip * eye;
}
)";

// Lights and the choice of the normal are those of the model without attributes (shader.cpp); a
// surface with a material looks the same from both sides.
constexpr const char* kSurfaceFragment = R"(#version 300 es
precision highp float;
in vec3 v_eye;
in vec3 v_normal;
in float v_flatness;
in vec4 v_color;
in vec2 v_uv0;
in vec2 v_uv1;
uniform int u_paint;
uniform int u_color_is_linear;
uniform vec4 u_base_factor;
uniform sampler2D u_base_map;
uniform vec3 u_emissive_factor;
uniform sampler2D u_emissive_map;
uniform sampler2D u_normal_map;
uniform float u_normal_scale;
uniform ivec3 u_map_sets;
uniform float u_alpha_cutoff;
uniform float u_roughness;
out vec4 colour;
const vec3 kKey = vec3(-0.4575, 0.6100, 0.6481);
const vec3 kFill = vec3(0.8305, 0.0615, 0.5536);
const float kShininess = 38.0;

vec3 to_linear(vec3 c)
{
    return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), step(0.04045, c));
}

vec3 to_screen(vec3 c)
{
    return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c));
}

vec2 place(int set)
{
    return set == 1 ? v_uv1 : v_uv0;
}

vec3 bend(vec3 normal, vec3 texel, vec2 uv)
{
    vec3 along_x = dFdx(v_eye);
    vec3 along_y = dFdy(v_eye);
    vec2 uv_x = dFdx(uv);
    vec2 uv_y = dFdy(uv);
    vec3 across_x = cross(normal, along_x);
    vec3 across_y = cross(along_y, normal);
    vec3 tangent = across_y * uv_x.x + across_x * uv_y.x;
    // The second texture coordinate points down, what a normal map calls up does not.
    vec3 bitangent = -(across_y * uv_x.y + across_x * uv_y.y);
    float longest = max(dot(tangent, tangent), dot(bitangent, bitangent));
    if (!(longest > 0.0))
    {
        return normal;
    }
    vec3 lean = vec3((2.0 * texel.xy - 1.0) * u_normal_scale, 2.0 * texel.z - 1.0);
    float scale = inversesqrt(longest);
    return normalize(lean.x * scale * tangent + lean.y * scale * bitangent + lean.z * normal);
}

void main()
{
    vec4 own = v_color;
    own.rgb = u_color_is_linear != 0 ? own.rgb : to_linear(own.rgb);
    vec4 base = u_base_factor * own;
    if (u_map_sets.x >= 0)
    {
        base *= texture(u_base_map, place(u_map_sets.x));
    }
    if (base.a < u_alpha_cutoff)
    {
        discard;
    }
    vec3 to_viewer = normalize(-v_eye);
    vec3 plane = normalize(cross(dFdx(v_eye), dFdy(v_eye)));
    plane = dot(plane, to_viewer) < 0.0 ? -plane : plane;
    vec3 smooth_normal = gl_FrontFacing ? v_normal : -v_normal;
    vec3 normal = normalize(mix(plane, smooth_normal, smoothstep(0.90, 0.985, v_flatness)));
    if (u_map_sets.z >= 0)
    {
        vec2 uv = place(u_map_sets.z);
        normal = bend(normal, texture(u_normal_map, uv).rgb, uv);
    }

    float key = max(dot(normal, kKey), 0.0);
    float fill = max(dot(normal, kFill), 0.0);
    float sky = 0.5 + 0.5 * normal.y;
    float edge = pow(1.0 - max(dot(normal, to_viewer), 0.0), 3.0);
    float gloss = pow(max(dot(normal, normalize(kKey + to_viewer)), 0.0), kShininess);

    vec3 clay = gl_FrontFacing ? vec3(0.700, 0.560, 0.400) : vec3(0.300, 0.360, 0.440);
    vec3 surface = u_paint != 0 ? base.rgb : clay;
    float shine = u_paint != 0 ? 0.10 * (1.0 - u_roughness) : 0.10;
    vec3 ambient = mix(vec3(0.090, 0.080, 0.080), vec3(0.280, 0.320, 0.380), sky);
    vec3 light = ambient + 0.88 * key * vec3(1.00, 0.96, 0.90) + 0.16 * fill * vec3(0.70, 0.80, 1.00);
    vec3 linear = surface * light + shine * (gloss + edge * vec3(0.75, 0.85, 1.00) * sky);
    vec3 glow = u_emissive_factor;
    if (u_map_sets.y >= 0)
    {
        glow *= texture(u_emissive_map, place(u_map_sets.y)).rgb;
    }
    colour = vec4(to_screen(clamp(linear + glow, 0.0, 1.0)), u_paint != 0 ? base.a : 1.0);
}
)";

}  // namespace

const char* surface_vertex_source()
{
    return kSurfaceVertex;
}

const char* surface_fragment_source()
{
    return kSurfaceFragment;
}

}  // namespace vsplit::client
