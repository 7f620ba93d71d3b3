#include "display.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <numbers>
#include <string>
#include <system_error>
#include <utility>

namespace vsplit::client {
namespace {

constexpr double kTurnPerFrame = 2.0 * std::numbers::pi / 180.0;
constexpr double kPictureAngle = -0.7;

// Draws one triangle, so that the driver compiles its programs before the clock starts, as a device
// does when the application is installed.
Result<void> warm_up(Renderer& renderer)
{
    constexpr std::array<float, 9> kPoints{0, 0, 0, 1, 0, 0, 0, 1, 0};
    const std::array<codec::TriangleUpdate, 1> triangle{{{0, {0, 1, 2}}}};
    codec::Step step;
    step.kind = codec::StepKind::Chunk;
    step.vertices = 3;
    step.faces = 1;
    step.triangles = std::span<const codec::TriangleUpdate>(triangle);
    GpuBuffers buffers(1.0);
    buffers.apply(step, [&](std::uint32_t first, std::uint32_t count, std::span<float> out) {
        std::copy_n(kPoints.begin() + 3 * first, 3 * count, out.begin());
    });
    VSPLIT_TRY(renderer.reserve(step.vertices, step.faces));
    renderer.upload(buffers);
    const View view = Turntable({0, 0, 0}, {1, 1, 1}, 1.0).view(0.0);
    renderer.draw(view);
    VSPLIT_TRY(renderer.picture(view));
    return {};
}

}  // namespace

Display::Display(const Options& options, std::unique_ptr<Renderer> renderer)
    : aspect_(static_cast<double>(options.device.width) / options.device.height),
      up_(options.up),
      folder_(options.screenshots),
      renderer_(std::move(renderer))
{
}

Result<std::unique_ptr<Display>> Display::create(const Options& options)
{
    if (!options.screenshots.empty())
    {
        std::error_code result;
        std::filesystem::create_directories(options.screenshots, result);
        if (result)
        {
            return fail(
                ErrorCode::IoError,
                "cannot make the folder " + options.screenshots.string() + ": " + result.message()
            );
        }
    }
    auto renderer =
        Renderer::create({options.device.width, options.device.height, options.wireframe});
    VSPLIT_TRY(renderer);
    VSPLIT_TRY(warm_up(**renderer));
    return std::unique_ptr<Display>(new Display(options, std::move(*renderer)));
}

Result<void> Display::prepare(const codec::StreamInfo& info, bool surface)
{
    turntable_.emplace(info.box_min, info.box_max, aspect_, up_);
    return surface ? renderer_->reserve(0, 0)
                   : renderer_->reserve(info.vertex_count, info.face_count);
}

void Display::set_appearance(const Appearance& appearance)
{
    renderer_->surface().set_appearance(appearance);
}

Result<void> Display::replace_texture(std::uint32_t image, const Raster& raster)
{
    return renderer_->surface().replace_texture(image, raster);
}

std::uint64_t Display::texture_memory_bytes() const
{
    return renderer_->surface().texture_memory_bytes();
}

std::chrono::duration<double, std::milli> Display::draw(GpuBuffers& buffers)
{
    const auto start = std::chrono::steady_clock::now();
    renderer_->upload(buffers);
    renderer_->draw(turntable_->view(kPictureAngle + kTurnPerFrame * static_cast<double>(frame_)));
    ++frame_;
    return std::chrono::steady_clock::now() - start;
}

Result<void> Display::save_picture(std::uint32_t level)
{
    if (folder_.empty())
    {
        return {};
    }
    std::array<char, 32> name{};
    std::snprintf(name.data(), name.size(), "level-%03u.png", level);
    const auto image = renderer_->picture(turntable_->view(kPictureAngle));
    VSPLIT_TRY(image);
    return write_png(folder_ / name.data(), *image);
}

}  // namespace vsplit::client
