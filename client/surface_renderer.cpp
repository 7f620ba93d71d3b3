#include "surface_renderer.h"

#include "shader.h"
#include "surface_shader.h"

#include <GLES3/gl3.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <utility>

namespace vsplit::client {
namespace {

// Places of the vertex attributes, as the vertex shader has them.
enum Place : GLuint
{
    kPosition,
    kNormal,
    kColor,
    kTexCoord0,
    kTexCoord1,
    kPlaceCount,
};

enum Unit : GLint
{
    kBaseUnit,
    kEmissiveUnit,
    kNormalUnit,
};

constexpr float kNoCutoff = -1.0F;

struct Uniforms
{
    GLint to_eye = -1;
    GLint to_clip = -1;
    GLint paint = -1;
    GLint color_is_linear = -1;
    GLint base_factor = -1;
    GLint emissive_factor = -1;
    GLint normal_scale = -1;
    GLint map_sets = -1;
    GLint alpha_cutoff = -1;
    GLint roughness = -1;

    void find(GLuint program)
    {
        const std::array<std::pair<GLint*, const char*>, 10> table{{
            {&to_eye, "u_to_eye"},
            {&to_clip, "u_to_clip"},
            {&paint, "u_paint"},
            {&color_is_linear, "u_color_is_linear"},
            {&base_factor, "u_base_factor"},
            {&emissive_factor, "u_emissive_factor"},
            {&normal_scale, "u_normal_scale"},
            {&map_sets, "u_map_sets"},
            {&alpha_cutoff, "u_alpha_cutoff"},
            {&roughness, "u_roughness"},
        }};
        for (const auto& [place, name] : table)
        {
            *place = glGetUniformLocation(program, name);
        }
    }
};

// How the GPU reads one vertex array.
struct ArrayFormat
{
    GLint components = 0;
    GLenum type = GL_FLOAT;
    GLboolean normalized = GL_FALSE;
};

template <typename Element>
void upload_array(
    Place place, GLuint buffer, const std::vector<Element>& array, const ArrayFormat& format
)
{
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glBufferData(
        GL_ARRAY_BUFFER,
        static_cast<GLsizeiptr>(array.size() * sizeof(Element)),
        array.data(),
        GL_STATIC_DRAW
    );
    if (array.empty())
    {
        glDisableVertexAttribArray(place);
        return;
    }
    glEnableVertexAttribArray(place);
    glVertexAttribPointer(place, format.components, format.type, format.normalized, 0, nullptr);
}

float depth(const View& view, const DrawRange& range)
{
    return view.to_eye[2] * range.centre[0] + view.to_eye[6] * range.centre[1] +
           view.to_eye[10] * range.centre[2] + view.to_eye[14];
}

}  // namespace

struct SurfaceRenderer::Objects
{
    Objects() = default;
    Objects(const Objects&) = delete;
    Objects& operator=(const Objects&) = delete;

    ~Objects()
    {
        glDeleteProgram(program);
        glDeleteBuffers(static_cast<GLsizei>(buffers.size()), buffers.data());
        glDeleteBuffers(1, &index_buffer);
        glDeleteVertexArrays(1, &vertex_array);
    }

    GLuint program = 0;
    Uniforms uniforms;
    GLuint vertex_array = 0;
    std::array<GLuint, kPlaceCount> buffers{};
    GLuint index_buffer = 0;
};

SurfaceRenderer::SurfaceRenderer() : objects_(std::make_unique<Objects>()) {}

SurfaceRenderer::~SurfaceRenderer() = default;

Result<std::unique_ptr<SurfaceRenderer>> SurfaceRenderer::create()
{
    std::unique_ptr<SurfaceRenderer> renderer(new SurfaceRenderer);
    VSPLIT_TRY(renderer->build());
    return renderer;
}

Result<void> SurfaceRenderer::build()
{
    Objects& gl = *objects_;
    const auto program = build_program(surface_vertex_source(), surface_fragment_source());
    VSPLIT_TRY(program);
    gl.program = *program;
    gl.uniforms.find(gl.program);
    glUseProgram(gl.program);
    glUniform1i(glGetUniformLocation(gl.program, "u_base_map"), kBaseUnit);
    glUniform1i(glGetUniformLocation(gl.program, "u_emissive_map"), kEmissiveUnit);
    glUniform1i(glGetUniformLocation(gl.program, "u_normal_map"), kNormalUnit);
    glGenVertexArrays(1, &gl.vertex_array);
    glGenBuffers(static_cast<GLsizei>(gl.buffers.size()), gl.buffers.data());
    glGenBuffers(1, &gl.index_buffer);
    return {};
}

void SurfaceRenderer::set_appearance(const Appearance& appearance)
{
    appearance_ = appearance;
    textures_.prepare(appearance_);
}

Result<void> SurfaceRenderer::upload(const SurfaceArrays& arrays)
{
    const Objects& gl = *objects_;
    while (glGetError() != GL_NO_ERROR)
    {
        // Only errors of the calls below count.
    }
    glBindVertexArray(gl.vertex_array);
    upload_array(kPosition, gl.buffers[kPosition], arrays.positions, {3, GL_FLOAT, GL_FALSE});
    upload_array(kNormal, gl.buffers[kNormal], arrays.normals, {4, GL_SHORT, GL_TRUE});
    upload_array(kColor, gl.buffers[kColor], arrays.colors, {4, GL_UNSIGNED_BYTE, GL_TRUE});
    upload_array(kTexCoord0, gl.buffers[kTexCoord0], arrays.tex_coords[0], {2});
    upload_array(kTexCoord1, gl.buffers[kTexCoord1], arrays.tex_coords[1], {2});
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, gl.index_buffer);
    glBufferData(
        GL_ELEMENT_ARRAY_BUFFER,
        static_cast<GLsizeiptr>(arrays.triangles.size() * sizeof(Triangle)),
        arrays.triangles.data(),
        GL_STATIC_DRAW
    );
    glBindVertexArray(0);
    ranges_ = arrays.ranges;
    has_surface_ = true;
    has_colors_ = !arrays.colors.empty();
    face_count_ = static_cast<std::uint32_t>(arrays.triangles.size());
    if (glGetError() != GL_NO_ERROR)
    {
        ranges_.clear();
        return fail(
            ErrorCode::LimitExceeded,
            "the driver has no memory for " + std::to_string(face_count_) + " triangles"
        );
    }
    return {};
}

Result<void> SurfaceRenderer::replace_texture(std::uint32_t image, const Raster& raster)
{
    return image < appearance_.images.size() ? textures_.replace(image, raster) : Result<void>{};
}

bool SurfaceRenderer::is_blended(const DrawRange& range) const
{
    const auto material = static_cast<std::size_t>(range.material);
    return range.material >= 0 && material < appearance_.materials.size() &&
           appearance_.materials[material].alpha_mode == AlphaMode::Blend;
}

void SurfaceRenderer::use_material(const DrawRange& range) const
{
    const Uniforms& u = objects_->uniforms;
    const auto number = static_cast<std::size_t>(range.material);
    const bool known = range.material >= 0 && number < appearance_.materials.size();
    const Material plain;
    const Material& material = known ? appearance_.materials[number] : plain;
    const auto set_of = [&](Unit unit, const TextureUse& use) -> GLint {
        return textures_.bind(static_cast<unsigned>(unit), use) ? use.tex_coord_set : -1;
    };
    glUniform1i(u.paint, known || has_colors_ ? 1 : 0);
    // glTF's colours are linear; those of files without materials are meant for the screen.
    glUniform1i(u.color_is_linear, known ? 1 : 0);
    glUniform4fv(u.base_factor, 1, material.base_color.data());
    glUniform1f(u.normal_scale, material.normal_scale);
    glUniform1f(u.roughness, material.roughness);
    glUniform1f(
        u.alpha_cutoff, material.alpha_mode == AlphaMode::Mask ? material.alpha_cutoff : kNoCutoff
    );
    const GLint base = set_of(kBaseUnit, material.base_color_texture);
    const GLint emissive = set_of(kEmissiveUnit, material.emissive_texture);
    // Without its texture, which may still come, the factor would make all of it glow.
    const bool dark = material.emissive_texture.image >= 0 && emissive < 0;
    glUniform3fv(u.emissive_factor, 1, dark ? plain.emissive.data() : material.emissive.data());
    glUniform3i(u.map_sets, base, emissive, set_of(kNormalUnit, material.normal_texture));
}

void SurfaceRenderer::draw_range(const DrawRange& range) const
{
    use_material(range);
    glDrawElements(
        GL_TRIANGLES,
        static_cast<GLsizei>(3 * range.count),
        GL_UNSIGNED_INT,
        reinterpret_cast<const void*>(std::uintptr_t{range.first} * sizeof(Triangle))
    );
}

void SurfaceRenderer::bind_arrays() const
{
    glBindVertexArray(objects_->vertex_array);
}

void SurfaceRenderer::draw(const View& view) const
{
    const Objects& gl = *objects_;
    glUseProgram(gl.program);
    glUniformMatrix4fv(gl.uniforms.to_eye, 1, GL_FALSE, view.to_eye.data());
    glUniformMatrix4fv(gl.uniforms.to_clip, 1, GL_FALSE, view.to_clip.data());
    bind_arrays();
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, gl.index_buffer);
    glVertexAttrib4f(kColor, 1.0F, 1.0F, 1.0F, 1.0F);
    glVertexAttrib4f(kTexCoord0, 0.0F, 0.0F, 0.0F, 1.0F);
    glVertexAttrib4f(kTexCoord1, 0.0F, 0.0F, 0.0F, 1.0F);
    std::vector<const DrawRange*> blended;
    for (const DrawRange& range : ranges_)
    {
        if (is_blended(range))
        {
            blended.push_back(&range);
        }
        else
        {
            draw_range(range);
        }
    }
    // In eye space the viewer looks along -z: the smallest is the farthest.
    std::ranges::stable_sort(blended, {}, [&](const DrawRange* range) {
        return depth(view, *range);
    });
    glEnable(GL_BLEND);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    glDepthMask(GL_FALSE);
    for (const DrawRange* range : blended)
    {
        draw_range(*range);
    }
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
    glBindVertexArray(0);
}

}  // namespace vsplit::client
