#include "player.h"

#include "memory_plan.h"
#include "ply_file.h"

#include <algorithm>
#include <span>
#include <string>

namespace vsplit::client {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kLongestWait{100};
constexpr milliseconds kGoodbyeWait{2000};
constexpr std::chrono::duration<double> kLeastDecodeBudget{0.001};
constexpr std::size_t kBlockBytes = 16384;
// While bytes are on their way the model keeps turning; on a very slow link not for ever.
constexpr std::size_t kMostFramesPerLevel = 2000;

ConnectionOptions connection_options(const Options& options)
{
    ConnectionOptions result;
    result.address = options.address;
    result.request = {
        options.address.model,
        options.device.width,
        options.device.height,
        options.device.memory_bytes,
    };
    result.stop = options.stop;
    result.link = options.link;
    result.timeout = options.timeout;
    result.retries = options.retries;
    // A device with little memory cannot let much wait.
    result.queue_bytes = static_cast<std::size_t>(
        std::clamp<std::uint64_t>(options.device.memory_bytes / 256, 4096, 65536)
    );
    return result;
}

codec::DecodeLimits header_limits(const DeviceProfile& device)
{
    codec::DecodeLimits limits;
    limits.max_header_bytes = static_cast<std::uint32_t>(
        std::min<std::uint64_t>(limits.max_header_bytes, device.memory_bytes)
    );
    return limits;
}

// The level that a prefix of the stream reaches or is on its way to.
std::uint32_t level_at(const codec::StreamInfo& info, std::uint64_t prefix_bytes)
{
    const auto found = std::ranges::find_if(info.levels, [&](const codec::LevelInfo& level) {
        return level.cumulative_bytes >= prefix_bytes;
    });
    return found == info.levels.end() ? info.levels.back().level : found->level;
}

std::string megabytes(std::uint64_t bytes)
{
    const std::uint64_t tenths = (bytes + 50000) / 100000;
    return std::to_string(tenths / 10) + "." + std::to_string(tenths % 10) + " MB";
}

}  // namespace

Player::Player(const Options& options, std::ostream& out)
    : options_(options), out_(out), block_(kBlockBytes)
{
    report_.model = options.address.model;
    report_.device = options.device.name;
    report_.link = options.link.name;
    report_.memory_cap_bytes = options.device.memory_bytes;
}

Result<void> Player::run()
{
    if (options_.render)
    {
        auto display = Display::create(options_);
        VSPLIT_TRY(display);
        display_ = std::move(*display);
    }
    start_ = Clock::now();
    connection_ = std::make_unique<Connection>(connection_options(options_));
    const auto outcome = play();
    report_.seconds = elapsed();
    if (outcome && !restricted_)
    {
        await_goodbye();
    }
    report_.transferred = connection_->counters();
    print_last_row();
    VSPLIT_TRY(outcome);
    return finish();
}

Result<void> Player::play()
{
    VSPLIT_TRY(read_header());
    VSPLIT_TRY(plan());
    VSPLIT_TRY(start_refining());
    while (needs_frames() || !reached_end())
    {
        if (needs_frames())
        {
            draw_frame();
            continue;
        }
        VSPLIT_TRY(refine());
    }
    return {};
}

Result<void> Player::read_header()
{
    const codec::DecodeLimits limits = header_limits(options_.device);
    std::size_t needed = codec::header_probe_bytes();
    while (header_.size() < needed)
    {
        if (!connection_->bytes().wait(kLongestWait))
        {
            if (connection_->bytes().drained())
            {
                return tl::unexpected<Error>(connection_->error().value_or(Error{
                    ErrorCode::Truncated, "the stream ends inside its header"}));
            }
            continue;
        }
        const std::size_t have = header_.size();
        header_.resize(needed);
        header_.resize(have + connection_->bytes().pop(std::span(header_).subspan(have)));
        if (header_.size() == codec::header_probe_bytes())
        {
            const auto header_bytes = codec::parse_header_bytes(header_, limits);
            VSPLIT_TRY(header_bytes);
            needed = *header_bytes;
        }
    }
    auto info = codec::parse_stream_info(header_, limits);
    VSPLIT_TRY(info);
    info_ = std::move(*info);
    return {};
}

Result<void> Player::plan()
{
    StopPlan stop = options_.stop;
    if (stop.error_in_percent)
    {
        stop.condition.error *= info_.diagonal() / 100.0;
        stop.error_in_percent = false;
    }
    end_ = codec::stop_offset(info_, stop.condition);
    const std::uint32_t wanted = level_at(info_, end_);
    const ConnectionOptions transfer = connection_options(options_);
    const auto fitting = plan_memory(
        info_,
        wanted,
        {options_.device.memory_bytes, transfer.queue_bytes + header_.size(), options_.wireframe}
    );
    VSPLIT_TRY(fitting);
    report_.memory_planned_bytes = fitting->needed_bytes;
    level_ = fitting->level;
    if (level_ < wanted)
    {
        stop.condition.level = level_;
        end_ = codec::stop_offset(info_, stop.condition);
        connection_->restrict_to(stop);
        restricted_ = true;
        out_ << "memory: " << options_.device.name << " has "
             << megabytes(options_.device.memory_bytes) << "; level " << level_ << " of "
             << info_.levels.size() - 1 << " is the finest that fits ("
             << megabytes(fitting->needed_bytes) << ")\n";
    }
    return {};
}

Result<void> Player::start_refining()
{
    const codec::StreamInfo shown = codec::prefix_info(info_, level_);
    codec::DecodeLimits limits = header_limits(options_.device);
    limits.max_heap_bytes = options_.device.memory_bytes;
    limits.max_level = level_;
    refiner_ = std::make_unique<Refiner>(shown, limits);
    VSPLIT_TRY(feed_header());
    out_ << table_head() << '\n';
    return display_ ? display_->prepare(shown) : Result<void>{};
}

// The header was taken from the queue before there was a decoder.
Result<void> Player::feed_header()
{
    std::span<const std::byte> rest = header_;
    while (!rest.empty())
    {
        const auto taken = refiner_->feed(rest);
        VSPLIT_TRY(taken);
        rest = rest.subspan(*taken);
        VSPLIT_TRY(refiner_->advance({}));
    }
    return {};
}

Result<void> Player::refine()
{
    VSPLIT_TRY(pump_bytes());
    const std::chrono::duration<double> last_frame{
        report_.levels.empty() || report_.levels.back().frame_ms.empty()
            ? 0.0
            : report_.levels.back().frame_ms.back() / 1000.0};
    const std::chrono::duration<double> budget = options_.device.frame_budget;
    const auto progress = refiner_->advance(std::max(kLeastDecodeBudget, budget - last_frame));
    VSPLIT_TRY(progress);
    VSPLIT_TRY(account(*progress));
    return progress->chunk_bytes > 0 ? Result<void>{} : wait_or_draw();
}

Result<void> Player::pump_bytes()
{
    while (true)
    {
        const std::uint64_t missing = end_ - refiner_->decoder().received_bytes();
        const std::uint64_t wanted =
            std::min<std::uint64_t>({refiner_->decoder().wanted_bytes(), missing, block_.size()});
        const auto part = std::span(block_).first(wanted);
        const std::size_t count = connection_->bytes().pop(part);
        if (count == 0)
        {
            return {};
        }
        VSPLIT_TRY(refiner_->feed(part.first(count)));
    }
}

Result<void> Player::account(const Progress& progress)
{
    next_row_.chunk_bytes += progress.chunk_bytes;
    if (progress.chunk_bytes > 0)
    {
        next_row_.decode_ms += progress.decoding.count() * 1000.0;
    }
    if (!progress.level_complete)
    {
        if (progress.changed && display_ && !report_.levels.empty())
        {
            draw_frame();
        }
        return {};
    }
    print_last_row();
    const codec::StreamDecoder& decoder = refiner_->decoder();
    LevelRow row = std::move(next_row_);
    next_row_ = {};
    row.level = decoder.level();
    row.vertices = decoder.vertices();
    row.faces = decoder.faces();
    row.cumulative_bytes = decoder.decoded_bytes();
    report_.levels.push_back(std::move(row));
    if (display_)
    {
        draw_frame();
    }
    report_.levels.back().seconds = elapsed();
    report_.levels.back().resident_bytes = resident_bytes();
    return display_ ? display_->save_picture(decoder.level()) : Result<void>{};
}

Result<void> Player::wait_or_draw()
{
    if (connection_->bytes().drained())
    {
        return accept_end_of_transfer();
    }
    const bool turning = display_ && !report_.levels.empty() &&
                         report_.levels.back().frame_ms.size() < kMostFramesPerLevel;
    const auto now = Clock::now();
    if (turning && now >= next_frame_)
    {
        draw_frame();
        return {};
    }
    const auto until_frame = std::chrono::ceil<milliseconds>(next_frame_ - now);
    connection_->bytes().wait(turning ? std::min(kLongestWait, until_frame) : kLongestWait);
    return {};
}

Result<void> Player::accept_end_of_transfer()
{
    if (const auto error = connection_->error())
    {
        return tl::unexpected<Error>(*error);
    }
    // The server decides where a stop condition ends the stream; on a tie its arithmetic may differ.
    const codec::StreamDecoder& decoder = refiner_->decoder();
    const bool whole_chunks = decoder.decoded_bytes() == decoder.received_bytes();
    if (end_ == info_.file_bytes || !whole_chunks || decoder.vertices() == 0)
    {
        return fail(
            ErrorCode::Truncated, "the server ended the stream early", decoder.received_bytes()
        );
    }
    end_ = decoder.decoded_bytes();
    return {};
}

Result<void> Player::finish()
{
    const codec::StreamDecoder& decoder = refiner_->decoder();
    report_.complete = decoder.complete() && decoder.decoded_bytes() == info_.file_bytes &&
                       decoder.vertices() == info_.vertex_count &&
                       decoder.faces() == info_.face_count;
    out_ << totals_line(report_) << '\n';
    if (report_.complete)
    {
        out_ << "complete: the last level has " << decoder.vertices() << " vertices and "
             << decoder.faces() << " triangles, equal to the quantised original\n";
    }
    else
    {
        out_ << "stopped at level " << decoder.level() << " of " << info_.levels.size() - 1
             << ", after " << decoder.decoded_bytes() << " of " << info_.file_bytes << " bytes\n";
    }
    out_.flush();
    return options_.save.empty() ? Result<void>{}
                                 : write_ply(options_.save, codec::extract_mesh(decoder));
}

// The server's last words follow the last byte; they belong to the bytes on the wire. After a stop
// that was moved forward, what was already on its way comes before them: better hang up.
void Player::await_goodbye()
{
    const auto deadline = Clock::now() + kGoodbyeWait;
    ByteQueue& bytes = connection_->bytes();
    while (!bytes.drained() && Clock::now() < deadline)
    {
        bytes.wait(kLongestWait);
        bytes.pop(block_);
    }
}

void Player::draw_frame()
{
    next_frame_ = Clock::now() + options_.device.frame_budget;
    const auto time = display_->draw(refiner_->buffers());
    report_.levels.back().frame_ms.push_back(time.count());
}

void Player::print_last_row()
{
    if (!report_.levels.empty())
    {
        out_ << table_row(report_.levels.back()) << std::endl;
    }
}

double Player::elapsed() const
{
    return std::chrono::duration<double>(Clock::now() - start_).count();
}

bool Player::needs_frames() const
{
    return display_ && !report_.levels.empty() &&
           report_.levels.back().frame_ms.size() < options_.frames;
}

bool Player::reached_end() const
{
    return refiner_->decoder().decoded_bytes() >= end_;
}

}  // namespace vsplit::client
