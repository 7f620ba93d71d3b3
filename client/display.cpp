#include "display.h"

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
    return std::unique_ptr<Display>(new Display(options, std::move(*renderer)));
}

Result<void> Display::prepare(const codec::StreamInfo& info)
{
    turntable_.emplace(info.box_min, info.box_max, aspect_, up_);
    return renderer_->reserve(info.vertex_count, info.face_count);
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
