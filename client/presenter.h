#pragma once

#include "display.h"
#include "model_images.h"
#include "options.h"
#include "refiner.h"
#include "report.h"

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <ostream>

namespace vsplit::client {

/// Shows what the refiner has: frames, sharper textures between them, pictures of levels, and the rows
/// of the report. Without rendering it only keeps the rows. Use on one thread.
class Presenter
{
public:
    /// `options`, `out`, `report`: must outlive it.
    Presenter(const Options& options, std::ostream& out, Report& report);

    /// Opens the display, if there is rendering. Errors: those of Display::create().
    [[nodiscard]] Result<void> open();

    /// Prepares for a model and follows `refiner`, which must outlive this.
    /// `shown`: header and index, cut to what will be shown; `texture_limit`: pixels, 0 no textures.
    /// Error: LimitExceeded when the GPU has no memory.
    [[nodiscard]] Result<void> prepare(
        const codec::StreamInfo& shown, Refiner& refiner, std::uint32_t texture_limit
    );

    /// Starts the clock of the report.
    void start_clock() { start_ = Clock::now(); }

    /// Seconds since start_clock().
    [[nodiscard]] double elapsed() const;

    /// Notes and shows what the refiner did. Errors: those of Display and ModelImages.
    [[nodiscard]] Result<void> account(const Progress& progress);

    /// Draws the next frame; before it at most one image is decoded. Precondition: a level is shown.
    [[nodiscard]] Result<void> draw_frame();

    /// True when the last level still wants frames: so many as were asked for, or sharper textures.
    [[nodiscard]] bool needs_frames() const;

    /// True when the last level has as many frames as were asked for.
    [[nodiscard]] bool has_enough_frames() const;

    /// When the next frame is due for a model that turns while bytes are on their way; nothing when
    /// there is nothing to draw or enough was drawn.
    [[nodiscard]] std::optional<std::chrono::steady_clock::time_point> next_frame() const;

    /// Time that the last frame took.
    [[nodiscard]] std::chrono::duration<double> last_frame() const { return last_frame_; }

    /// Adds what came after the last level to its row and prints it.
    void finish();

    /// Materials and images.
    [[nodiscard]] const ModelImages& images() const { return images_; }

private:
    using Clock = std::chrono::steady_clock;

    [[nodiscard]] Result<void> start_level();
    [[nodiscard]] Result<void> show_surface();
    [[nodiscard]] Result<void> take_materials();
    [[nodiscard]] Result<void> sharpen();
    void print_last_row();

    const Options& options_;
    std::ostream& out_;
    Report& report_;
    std::unique_ptr<Display> display_;
    Refiner* refiner_ = nullptr;
    ModelImages images_{0};
    bool has_materials_ = false;
    LevelRow next_row_;
    Clock::time_point start_;
    Clock::time_point next_frame_;
    std::chrono::duration<double> last_frame_{};
};

}  // namespace vsplit::client
