#include "renderer.h"

#include "core/assert.h"
#include "framebuffer.h"
#include "gl_context.h"
#include "shader.h"

#include <GLES3/gl3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace vsplit::client {
namespace {

constexpr int kPictureSamples = 4;
constexpr std::size_t kLineBlock = 512;
constexpr GLuint kPositionAttribute = 0;
constexpr GLuint kNormalAttribute = 1;

// Six indices, three lines; an inner edge is drawn by both of its triangles.
using LineIndices = std::array<std::uint32_t, 6>;

struct Program
{
    GLuint name = 0;
    GLint to_eye = -1;
    GLint to_clip = -1;
    GLint opacity = -1;

    Result<void> build(const char* vertex_source, const char* fragment_source)
    {
        const auto program = build_program(vertex_source, fragment_source);
        VSPLIT_TRY(program);
        name = *program;
        to_eye = glGetUniformLocation(name, "u_to_eye");
        to_clip = glGetUniformLocation(name, "u_to_clip");
        opacity = glGetUniformLocation(name, "u_opacity");
        return {};
    }

    void use(const View& view) const
    {
        glUseProgram(name);
        glUniformMatrix4fv(to_eye, 1, GL_FALSE, view.to_eye.data());
        glUniformMatrix4fv(to_clip, 1, GL_FALSE, view.to_clip.data());
    }
};

// A triangle edge covers so many pixels on average when the model fills about half of the picture.
float line_opacity(const RenderOptions& options, std::uint32_t faces)
{
    const double area = 0.5 * options.width * options.height;
    const double edge = std::sqrt(area / std::max(1.0, faces / 4.0));
    return static_cast<float>(std::clamp((edge - 1.0) / 10.0, 0.10, 0.85));
}

}  // namespace

struct Renderer::Objects
{
    Objects() = default;
    Objects(const Objects&) = delete;
    Objects& operator=(const Objects&) = delete;

    ~Objects()
    {
        glDeleteProgram(model.name);
        glDeleteProgram(lines.name);
        glDeleteProgram(background.name);
        const std::array<GLuint, 3> buffers{vertex_buffer, index_buffer, line_buffer};
        glDeleteBuffers(static_cast<GLsizei>(buffers.size()), buffers.data());
        glDeleteVertexArrays(1, &model_array);
        glDeleteVertexArrays(1, &background_array);
    }

    Framebuffer screen;
    Framebuffer sampled;
    bool sampled_ready = false;
    Program model;
    Program lines;
    Program background;
    GLuint model_array = 0;
    GLuint background_array = 0;
    GLuint vertex_buffer = 0;
    GLuint index_buffer = 0;
    GLuint line_buffer = 0;
};

Renderer::Renderer(const RenderOptions& options) : options_(options) {}

Renderer::~Renderer() = default;

Result<std::unique_ptr<Renderer>> Renderer::create(const RenderOptions& options)
{
    std::unique_ptr<Renderer> renderer(new Renderer(options));
    auto context = GlContext::create();
    VSPLIT_TRY(context);
    renderer->context_ = std::move(*context);
    renderer->objects_ = std::make_unique<Objects>();
    VSPLIT_TRY(renderer->build());
    auto surface = SurfaceRenderer::create();
    VSPLIT_TRY(surface);
    renderer->surface_ = std::move(*surface);
    return renderer;
}

Result<void> Renderer::build()
{
    Objects& gl = *objects_;
    VSPLIT_TRY(gl.screen.allocate(options_.width, options_.height, 0));
    VSPLIT_TRY(gl.model.build(model_vertex_source(), model_fragment_source()));
    VSPLIT_TRY(gl.lines.build(model_vertex_source(), line_fragment_source()));
    VSPLIT_TRY(gl.background.build(background_vertex_source(), background_fragment_source()));
    glGenVertexArrays(1, &gl.background_array);
    glGenVertexArrays(1, &gl.model_array);
    glGenBuffers(1, &gl.vertex_buffer);
    glGenBuffers(1, &gl.index_buffer);
    glGenBuffers(1, &gl.line_buffer);

    glBindVertexArray(gl.model_array);
    glBindBuffer(GL_ARRAY_BUFFER, gl.vertex_buffer);
    constexpr GLsizei kStride = sizeof(GpuVertex);
    const auto* normal_offset = reinterpret_cast<const void*>(offsetof(GpuVertex, normal));
    glEnableVertexAttribArray(kPositionAttribute);
    glVertexAttribPointer(kPositionAttribute, 3, GL_FLOAT, GL_FALSE, kStride, nullptr);
    glEnableVertexAttribArray(kNormalAttribute);
    glVertexAttribPointer(kNormalAttribute, 4, GL_INT, GL_FALSE, kStride, normal_offset);
    glBindVertexArray(0);
    return {};
}

Result<void> Renderer::reserve(std::uint32_t vertices, std::uint32_t faces)
{
    const Objects& gl = *objects_;
    while (glGetError() != GL_NO_ERROR)
    {
        // Only errors of the calls below count.
    }
    const auto allocate = [](GLuint buffer, std::size_t bytes) {
        // GL_ARRAY_BUFFER serves every buffer here: an index buffer bound as such would change the
        // vertex array object that happens to be bound.
        glBindBuffer(GL_ARRAY_BUFFER, buffer);
        glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(bytes), nullptr, GL_DYNAMIC_DRAW);
    };
    allocate(gl.vertex_buffer, std::size_t{vertices} * sizeof(GpuVertex));
    allocate(gl.index_buffer, std::size_t{faces} * sizeof(Triangle));
    if (options_.wireframe)
    {
        allocate(gl.line_buffer, std::size_t{faces} * sizeof(LineIndices));
    }
    if (glGetError() != GL_NO_ERROR)
    {
        return fail(
            ErrorCode::LimitExceeded,
            "the driver has no memory for " + std::to_string(faces) + " triangles"
        );
    }
    return {};
}

void Renderer::upload(GpuBuffers& buffers)
{
    const auto send = [](auto elements, const ElementRange& range) {
        const auto part = elements.subspan(range.first, range.count);
        const std::size_t size = sizeof(part.front());
        glBufferSubData(
            GL_ARRAY_BUFFER,
            static_cast<GLintptr>(range.first * size),
            static_cast<GLsizeiptr>(part.size_bytes()),
            part.data()
        );
    };
    glBindBuffer(GL_ARRAY_BUFFER, objects_->vertex_buffer);
    for (const ElementRange& range : buffers.take_dirty_vertices())
    {
        send(buffers.vertices(), range);
    }
    const auto triangle_ranges = buffers.take_dirty_triangles();
    glBindBuffer(GL_ARRAY_BUFFER, objects_->index_buffer);
    for (const ElementRange& range : triangle_ranges)
    {
        send(buffers.triangles(), range);
    }
    for (const ElementRange& range : triangle_ranges)
    {
        upload_lines(buffers.triangles(), range);
    }
    face_count_ = static_cast<std::uint32_t>(buffers.triangles().size());
}

Result<void> Renderer::show(const SurfaceArrays& arrays)
{
    VSPLIT_TRY(surface_->upload(arrays));
    if (options_.wireframe)
    {
        const auto faces = static_cast<std::uint32_t>(arrays.triangles.size());
        VSPLIT_TRY(reserve(0, faces));
        upload_lines(arrays.triangles, {0, faces});
    }
    return {};
}

void Renderer::upload_lines(std::span<const Triangle> triangles, const ElementRange& range)
{
    if (!options_.wireframe)
    {
        return;
    }
    glBindBuffer(GL_ARRAY_BUFFER, objects_->line_buffer);
    std::array<LineIndices, kLineBlock> block{};
    for (std::size_t done = 0; done < range.count; done += kLineBlock)
    {
        const std::size_t count = std::min<std::size_t>(kLineBlock, range.count - done);
        for (std::size_t i = 0; i < count; ++i)
        {
            const Triangle& t = triangles[range.first + done + i];
            block[i] = {t[0], t[1], t[1], t[2], t[2], t[0]};
        }
        glBufferSubData(
            GL_ARRAY_BUFFER,
            static_cast<GLintptr>((range.first + done) * sizeof(LineIndices)),
            static_cast<GLsizeiptr>(count * sizeof(LineIndices)),
            block.data()
        );
    }
}

void Renderer::draw_scene(const View& view) const
{
    const Objects& gl = *objects_;
    glDisable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
    glClear(GL_DEPTH_BUFFER_BIT);
    glBindVertexArray(gl.background_array);
    glUseProgram(gl.background.name);
    glDrawArrays(GL_TRIANGLES, 0, 3);

    glEnable(GL_DEPTH_TEST);
    if (options_.wireframe)
    {
        glEnable(GL_POLYGON_OFFSET_FILL);
        glPolygonOffset(1.0F, 1.0F);
    }
    draw_model(view);
    if (options_.wireframe)
    {
        glDisable(GL_POLYGON_OFFSET_FILL);
        draw_lines(view);
    }
    glBindVertexArray(0);
}

void Renderer::draw_model(const View& view) const
{
    if (surface_->has_surface())
    {
        surface_->draw(view);
        return;
    }
    const Objects& gl = *objects_;
    glBindVertexArray(gl.model_array);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, gl.index_buffer);
    gl.model.use(view);
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * face_count_), GL_UNSIGNED_INT, nullptr);
}

void Renderer::draw_lines(const View& view) const
{
    const Objects& gl = *objects_;
    const bool surface = surface_->has_surface();
    const std::uint32_t faces = surface ? surface_->face_count() : face_count_;
    if (surface)
    {
        surface_->bind_arrays();
    }
    else
    {
        glBindVertexArray(gl.model_array);
    }
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glDepthFunc(GL_LEQUAL);
    glDepthMask(GL_FALSE);
    gl.lines.use(view);
    glUniform1f(gl.lines.opacity, line_opacity(options_, faces));
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, gl.line_buffer);
    glDrawElements(GL_LINES, static_cast<GLsizei>(6 * faces), GL_UNSIGNED_INT, nullptr);
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_LESS);
    glDisable(GL_BLEND);
}

void Renderer::draw(const View& view)
{
    objects_->screen.bind();
    draw_scene(view);
    glFinish();
}

Result<Image> Renderer::picture(const View& view)
{
    Objects& gl = *objects_;
    if (!gl.sampled_ready)
    {
        VSPLIT_TRY(gl.sampled.allocate(options_.width, options_.height, kPictureSamples));
        gl.sampled_ready = true;
    }
    gl.sampled.bind();
    draw_scene(view);
    gl.sampled.resolve_into(gl.screen);
    return gl.screen.read();
}

}  // namespace vsplit::client
