#include "presenter.h"

#include <utility>

namespace vsplit::client {
namespace {

// While bytes are on their way the model keeps turning; on a very slow link not for ever.
constexpr std::size_t kMostFramesPerLevel = 2000;

}  // namespace

Presenter::Presenter(const Options& options, std::ostream& out, Report& report)
    : options_(options), out_(out), report_(report)
{
}

Result<void> Presenter::open()
{
    if (options_.render)
    {
        auto display = Display::create(options_);
        VSPLIT_TRY(display);
        display_ = std::move(*display);
    }
    return {};
}

Result<void> Presenter::prepare(
    const codec::StreamInfo& shown, Refiner& refiner, std::uint32_t texture_limit
)
{
    refiner_ = &refiner;
    images_ = ModelImages(texture_limit);
    report_.surface = refiner.shows_surface();
    out_ << table_head(report_) << '\n';
    if (!display_)
    {
        return {};
    }
    if (refiner.shows_surface())
    {
        refiner.set_appearance_sink(
            [this](const codec::ChunkInfo& chunk, std::span<const std::byte> contents) {
                return images_.take(chunk, contents);
            }
        );
    }
    return display_->prepare(shown, refiner.shows_surface());
}

double Presenter::elapsed() const
{
    return std::chrono::duration<double>(Clock::now() - start_).count();
}

Result<void> Presenter::account(const Progress& progress)
{
    // Textures that come before the next level belong to the one that shows them.
    const bool same_level =
        !progress.level_complete && !report_.levels.empty() && refiner_->at_level();
    LevelRow& row = same_level ? report_.levels.back() : next_row_;
    row.bytes += progress.bytes;
    row.cumulative_bytes = refiner_->decoder().decoded_bytes();
    if (progress.bytes.sum() > 0)
    {
        row.decode_ms += progress.decoding.count() * 1000.0;
    }
    VSPLIT_TRY(take_materials());
    if (progress.level_complete)
    {
        return start_level();
    }
    const bool drawable = display_ && !report_.levels.empty();
    return progress.changed && drawable ? draw_frame() : Result<void>{};
}

// Materials that come after a level was shown apply to it too, if it is still whole.
Result<void> Presenter::take_materials()
{
    if (!display_ || has_materials_ || images_.appearance() == nullptr)
    {
        return {};
    }
    has_materials_ = true;
    display_->set_appearance(*images_.appearance());
    return report_.levels.empty() || !refiner_->at_level() ? Result<void>{} : show_surface();
}

Result<void> Presenter::start_level()
{
    print_last_row();
    const codec::StreamDecoder& decoder = refiner_->decoder();
    LevelRow row = std::exchange(next_row_, {});
    row.level = decoder.level();
    row.vertices = decoder.vertices();
    row.faces = decoder.faces();
    row.cumulative_bytes = decoder.decoded_bytes();
    report_.levels.push_back(std::move(row));
    if (display_)
    {
        if (refiner_->shows_surface())
        {
            VSPLIT_TRY(show_surface());
        }
        VSPLIT_TRY(draw_frame());
    }
    report_.levels.back().seconds = elapsed();
    report_.levels.back().resident_bytes = resident_bytes();
    return display_ ? display_->save_picture(decoder.level()) : Result<void>{};
}

Result<void> Presenter::show_surface()
{
    const auto start = Clock::now();
    VSPLIT_TRY(display_->show(refiner_->make_surface(images_.appearance())));
    const std::chrono::duration<double, std::milli> time = Clock::now() - start;
    report_.levels.back().decode_ms += time.count();
    return {};
}

Result<void> Presenter::draw_frame()
{
    next_frame_ = Clock::now() + options_.device.frame_budget;
    LevelRow& row = report_.levels.back();
    const std::size_t images_before = row.images;
    VSPLIT_TRY(sharpen());
    const auto time = display_->draw(refiner_->buffers());
    row.frame_ms.push_back(time.count());
    last_frame_ = Clock::now() - (next_frame_ - options_.device.frame_budget);
    // The picture of a level shows the textures that came before the next one.
    return row.images > images_before && refiner_->at_level() ? display_->save_picture(row.level)
                                                              : Result<void>{};
}

Result<void> Presenter::sharpen()
{
    const auto sharper = images_.decode_next();
    VSPLIT_TRY(sharper);
    LevelRow& row = report_.levels.back();
    if (*sharper)
    {
        VSPLIT_TRY(display_->replace_texture((*sharper)->image, (*sharper)->raster));
        ++row.images;
        row.image_ms += (*sharper)->decoding.count();
    }
    row.texture_memory_bytes = display_->texture_memory_bytes() + images_.coded_bytes();
    return {};
}

bool Presenter::needs_frames() const
{
    return display_ && !report_.levels.empty() && (!has_enough_frames() || images_.has_sharper());
}

bool Presenter::has_enough_frames() const
{
    return !report_.levels.empty() && report_.levels.back().frame_ms.size() >= options_.frames;
}

std::optional<std::chrono::steady_clock::time_point> Presenter::next_frame() const
{
    const bool turning = display_ && !report_.levels.empty() &&
                         report_.levels.back().frame_ms.size() < kMostFramesPerLevel;
    return turning ? std::optional(next_frame_) : std::nullopt;
}

void Presenter::finish()
{
    if (report_.levels.empty())
    {
        return;
    }
    LevelRow& row = report_.levels.back();
    const LevelRow rest = std::exchange(next_row_, {});
    row.bytes += rest.bytes;
    row.decode_ms += rest.decode_ms;
    if (refiner_->at_level())
    {
        row.cumulative_bytes = refiner_->decoder().decoded_bytes();
    }
    print_last_row();
}

void Presenter::print_last_row()
{
    if (!report_.levels.empty())
    {
        out_ << table_row(report_, report_.levels.back()) << std::endl;
    }
}

}  // namespace vsplit::client
