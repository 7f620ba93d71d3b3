#include "shader.h"

#include <GLES3/gl3.h>

#include <array>
#include <string>

namespace vsplit::client {
namespace {

// Positions go to eye space first: lighting belongs to the viewer, so that a turning model shows
// its relief.
constexpr const char* kModelVertex = R"(#version 300 es
layout(location = 0) in vec3 a_position;
layout(location = 1) in vec4 a_normal;
uniform mat4 u_to_eye;
uniform mat4 u_to_clip;
out highp vec3 v_eye;
out highp vec3 v_normal;
out highp float v_flatness;
void main()
{
    vec4 eye = u_to_eye * vec4(a_position, 1.0);
    v_eye = eye.xyz;
    float sum = length(a_normal.xyz);
    v_normal = sum > 0.0 ? mat3(u_to_eye) * (a_normal.xyz / sum) : vec3(0.0);
    v_flatness = a_normal.w > 0.0 ? sum / a_normal.w : 0.0;
    gl_Position = u_to_clip * eye;
}
)";

// The plane of the triangle comes from derivatives. Where the triangles around a vertex fold, the
// plane wins over the smooth normal: edges of machined parts and coarse levels stay sharp, and
// curved surfaces turn smooth as their triangles get small. Both sides are lit.
constexpr const char* kModelFragment = R"(#version 300 es
precision highp float;
in vec3 v_eye;
in vec3 v_normal;
in float v_flatness;
out vec4 colour;
const vec3 kKey = vec3(-0.4575, 0.6100, 0.6481);
const vec3 kFill = vec3(0.8305, 0.0615, 0.5536);
const float kShininess = 38.0;
void main()
{
    vec3 to_viewer = normalize(-v_eye);
    vec3 plane = normalize(cross(dFdx(v_eye), dFdy(v_eye)));
    plane = dot(plane, to_viewer) < 0.0 ? -plane : plane;
    vec3 smooth_normal = gl_FrontFacing ? v_normal : -v_normal;
    vec3 normal = normalize(mix(plane, smooth_normal, smoothstep(0.90, 0.985, v_flatness)));

    float key = max(dot(normal, kKey), 0.0);
    float fill = max(dot(normal, kFill), 0.0);
    float sky = 0.5 + 0.5 * normal.y;
    float edge = pow(1.0 - max(dot(normal, to_viewer), 0.0), 3.0);
    float gloss = pow(max(dot(normal, normalize(kKey + to_viewer)), 0.0), kShininess);

    vec3 surface = gl_FrontFacing ? vec3(0.700, 0.560, 0.400) : vec3(0.300, 0.360, 0.440);
    vec3 ambient = mix(vec3(0.090, 0.080, 0.080), vec3(0.280, 0.320, 0.380), sky);
    vec3 light = ambient + 0.88 * key * vec3(1.00, 0.96, 0.90) + 0.16 * fill * vec3(0.70, 0.80, 1.00);
    vec3 linear = surface * light + 0.10 * gloss + 0.10 * edge * vec3(0.75, 0.85, 1.00) * sky;
    colour = vec4(pow(clamp(linear, 0.0, 1.0), vec3(1.0 / 2.2)), 1.0);
}
)";

constexpr const char* kLineFragment = R"(#version 300 es
precision mediump float;
uniform float u_opacity;
out vec4 colour;
void main()
{
    colour = vec4(0.07, 0.11, 0.18, u_opacity);
}
)";

constexpr const char* kBackgroundVertex = R"(#version 300 es
out highp float v_height;
void main()
{
    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    v_height = 0.5 + 0.5 * corner.y;
    gl_Position = vec4(corner, 0.0, 1.0);
}
)";

constexpr const char* kBackgroundFragment = R"(#version 300 es
precision highp float;
in float v_height;
out vec4 colour;
void main()
{
    vec3 low = vec3(0.925, 0.918, 0.905);
    vec3 high = vec3(0.800, 0.838, 0.880);
    colour = vec4(mix(low, high, smoothstep(0.0, 1.0, v_height)), 1.0);
}
)";

constexpr std::size_t kLogBytes = 512;

Result<GLuint> compile(GLenum stage, const char* source)
{
    const GLuint shader = glCreateShader(stage);
    glShaderSource(shader, 1, &source, nullptr);
    glCompileShader(shader);
    GLint compiled = GL_FALSE;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    if (compiled != GL_TRUE)
    {
        std::array<char, kLogBytes> log{};
        glGetShaderInfoLog(shader, kLogBytes - 1, nullptr, log.data());
        glDeleteShader(shader);
        return fail(ErrorCode::Internal, std::string("a shader does not compile: ") + log.data());
    }
    return shader;
}

}  // namespace

Result<unsigned> build_program(const char* vertex_source, const char* fragment_source)
{
    const auto vertex = compile(GL_VERTEX_SHADER, vertex_source);
    VSPLIT_TRY(vertex);
    const auto fragment = compile(GL_FRAGMENT_SHADER, fragment_source);
    if (!fragment)
    {
        glDeleteShader(*vertex);
        return tl::unexpected<Error>(fragment.error());
    }
    const GLuint program = glCreateProgram();
    glAttachShader(program, *vertex);
    glAttachShader(program, *fragment);
    glLinkProgram(program);
    glDeleteShader(*vertex);
    glDeleteShader(*fragment);
    GLint linked = GL_FALSE;
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    if (linked != GL_TRUE)
    {
        std::array<char, kLogBytes> log{};
        glGetProgramInfoLog(program, kLogBytes - 1, nullptr, log.data());
        glDeleteProgram(program);
        return fail(ErrorCode::Internal, std::string("a shader does not link: ") + log.data());
    }
    return program;
}

const char* model_vertex_source()
{
    return kModelVertex;
}

const char* model_fragment_source()
{
    return kModelFragment;
}

const char* line_fragment_source()
{
    return kLineFragment;
}

const char* background_vertex_source()
{
    return kBackgroundVertex;
}

const char* background_fragment_source()
{
    return kBackgroundFragment;
}

}  // namespace vsplit::client
