#include "player.h"

#include "memory_plan.h"
#include "saved_level.h"

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

ConnectionOptions connection_options(const Options& options)
{
    ConnectionOptions result;
    result.address = options.address;
    const DeviceProfile& device = options.device;
    const std::uint32_t textures = options.attributes ? device.texture_limit : 0;
    result.request = {
        options.address.model, device.width, device.height, device.memory_bytes, textures};
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

// What a link carries while a request is on its way: leaving out less does not pay.
std::uint64_t least_gap_bytes(const LinkProfile& link)
{
    constexpr std::uint64_t kLeast = 4096;
    const double seconds = std::chrono::duration<double>(link.latency).count();
    return std::max(kLeast, static_cast<std::uint64_t>(link.bytes_per_second * seconds));
}

std::string megabytes(std::uint64_t bytes)
{
    const std::uint64_t tenths = (bytes + 50000) / 100000;
    return std::to_string(tenths / 10) + "." + std::to_string(tenths % 10) + " MB";
}

std::string memory_line(const DeviceProfile& device, const MemoryPlan& plan)
{
    return "memory: " + device.name + " has " + megabytes(device.memory_bytes) + "; " +
           megabytes(plan.needed_bytes) + " are used: ";
}

}  // namespace

Player::Player(const Options& options, std::ostream& out)
    : options_(options), out_(out), presenter_(options, out, report_), block_(kBlockBytes)
{
    report_.model = options.address.model;
    report_.device = options.device.name;
    report_.link = options.link.name;
    report_.memory_cap_bytes = options.device.memory_bytes;
}

Result<void> Player::run()
{
    VSPLIT_TRY(presenter_.open());
    presenter_.start_clock();
    connection_ = std::make_unique<Connection>(connection_options(options_));
    const auto outcome = play();
    report_.seconds = presenter_.elapsed();
    if (outcome && !restricted_)
    {
        await_goodbye();
    }
    report_.transferred = connection_->counters();
    presenter_.finish();
    VSPLIT_TRY(outcome);
    return finish();
}

Result<void> Player::play()
{
    VSPLIT_TRY(read_header());
    VSPLIT_TRY(plan());
    VSPLIT_TRY(start_refining());
    while (presenter_.needs_frames() || !reached_end())
    {
        if (presenter_.needs_frames() && !more_of_textures_waits())
        {
            VSPLIT_TRY(presenter_.draw_frame());
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
    stop_ = options_.stop;
    if (stop_.error_in_percent)
    {
        stop_.condition.error *= info_.diagonal() / 100.0;
        stop_.error_in_percent = false;
    }
    end_ = codec::stop_offset(info_, stop_.condition);
    const std::uint32_t wanted = level_at(info_, end_);
    const ConnectionOptions transfer = connection_options(options_);
    const bool surface = options_.attributes && has_surface(info_);
    MemoryUse use;
    use.cap_bytes = options_.device.memory_bytes;
    use.queue_bytes = transfer.queue_bytes + header_.size();
    use.wireframe = options_.wireframe;
    use.surface = surface;
    use.texture_limit = surface ? options_.device.texture_limit : 0;
    const auto fitting = plan_memory(info_, wanted, use);
    VSPLIT_TRY(fitting);
    report_.memory_planned_bytes = fitting->needed_bytes;
    report_.texture_planned_bytes = fitting->texture_bytes;
    report_.texture_limit = fitting->texture_limit;
    level_ = fitting->level;
    texture_limit_ = fitting->texture_limit;
    restricted_ = level_ < wanted;
    if (restricted_)
    {
        stop_.condition.level = level_;
        end_ = codec::stop_offset(info_, stop_.condition);
        out_ << memory_line(options_.device, *fitting) << "level " << level_ << " of "
             << info_.levels.size() - 1 << " is the finest that fits\n";
    }
    if (texture_limit_ < use.texture_limit && report_.texture_planned_bytes > 0)
    {
        out_ << memory_line(options_.device, *fitting) << "textures fit with sides up to "
             << texture_limit_ << " pixels\n";
    }
    return {};
}

Result<void> Player::start_refining()
{
    const codec::StreamInfo shown = codec::prefix_info(info_, level_);
    codec::DecodeLimits limits = header_limits(options_.device);
    limits.max_heap_bytes = options_.device.memory_bytes;
    limits.max_level = level_;
    limits.attributes = options_.attributes;
    refiner_ = std::make_unique<Refiner>(shown, limits, options_.attributes);
    refiner_->stop_at(end_);
    VSPLIT_TRY(feed_header());
    VSPLIT_TRY(presenter_.prepare(shown, *refiner_, texture_limit_));
    unwanted_ = find_unwanted();
    if (restricted_ || !unwanted_.empty())
    {
        connection_->restrict_to(stop_, unwanted_);
    }
    return {};
}

bool Player::wants(const codec::ChunkInfo& chunk) const
{
    using Kind = proto::ChunkKind;
    const bool known = chunk.kind == Kind::Attributes || chunk.kind == Kind::Appearance ||
                       chunk.kind == Kind::Texture;
    return options_.attributes && known && presenter_.images().wants(chunk);
}

std::vector<ByteRange> Player::find_unwanted() const
{
    const auto wanted = [this](const codec::ChunkInfo& chunk) { return wants(chunk); };
    return unwanted_chunks(info_, wanted, end_, least_gap_bytes(options_.link));
}

// Once the materials have come it is known which images are drawn at all.
void Player::leave_out_unwanted()
{
    if (knows_materials_ || presenter_.images().appearance() == nullptr)
    {
        return;
    }
    knows_materials_ = true;
    auto unwanted = find_unwanted();
    std::erase_if(unwanted, [this](const ByteRange& range) {
        return range.begin < refiner_->decoder().received_bytes();
    });
    const bool more = std::ranges::any_of(unwanted, [this](const ByteRange& range) {
        return std::ranges::find(unwanted_, range) == unwanted_.end();
    });
    if (more)
    {
        unwanted_ = std::move(unwanted);
        connection_->restrict_to(stop_, unwanted_);
    }
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
    const std::chrono::duration<double> budget = options_.device.frame_budget;
    const auto progress =
        refiner_->advance(std::max(kLeastDecodeBudget, budget - presenter_.last_frame()));
    VSPLIT_TRY(progress);
    VSPLIT_TRY(presenter_.account(*progress));
    leave_out_unwanted();
    return progress->bytes.sum() > 0 ? Result<void>{} : wait_or_draw();
}

// Decoding an image takes longer than receiving a part of it: what has come goes into one decode.
// Not beyond a chunk of another kind, so that a level is drawn with all that came before the next one.
bool Player::more_of_textures_waits()
{
    const codec::ChunkInfo* const next = refiner_->decoder().next_chunk();
    return next != nullptr && next->kind == proto::ChunkKind::Texture && next->offset < end_ &&
           presenter_.has_enough_frames() && connection_->bytes().wait(milliseconds(0));
}

Result<void> Player::pump_bytes()
{
    while (true)
    {
        // In this order: what was left out is known before what follows it is in the queue.
        const bool there = connection_->bytes().wait(milliseconds(0));
        if (there || connection_->bytes().drained())
        {
            skip_left_out();
        }
        const codec::StreamDecoder& decoder = refiner_->decoder();
        const std::uint64_t missing = end_ - std::min(end_, decoder.received_bytes());
        const std::uint64_t wanted =
            std::min<std::uint64_t>({decoder.wanted_bytes(), missing, block_.size()});
        const auto part = std::span(block_).first(there ? wanted : 0);
        const std::size_t count = connection_->bytes().pop(part);
        if (count == 0)
        {
            return {};
        }
        VSPLIT_TRY(refiner_->feed(part.first(count)));
    }
}

// Returns whether there was any.
bool Player::skip_left_out()
{
    const codec::StreamDecoder& decoder = refiner_->decoder();
    bool skipped = false;
    while (decoder.next_chunk() != nullptr && decoder.received_bytes() == decoder.decoded_bytes() &&
           connection_->leaves_out(decoder.next_chunk()->offset))
    {
        refiner_->skip();
        skipped = true;
    }
    return skipped;
}

Result<void> Player::wait_or_draw()
{
    if (connection_->bytes().drained())
    {
        return skip_left_out() || reached_end() ? Result<void>{} : accept_end_of_transfer();
    }
    const auto now = std::chrono::steady_clock::now();
    const auto next_frame = presenter_.next_frame();
    if (next_frame && now >= *next_frame)
    {
        return presenter_.draw_frame();
    }
    const auto pause =
        next_frame ? std::chrono::ceil<milliseconds>(*next_frame - now) : kLongestWait;
    connection_->bytes().wait(std::min(kLongestWait, pause));
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
    return options_.save.empty() ? Result<void>{} : save_level(options_.save, *refiner_);
}

// The server's last words follow the last byte; they belong to the bytes on the wire. After a stop
// that was moved forward, what was already on its way comes before them: better hang up.
void Player::await_goodbye()
{
    const auto deadline = std::chrono::steady_clock::now() + kGoodbyeWait;
    ByteQueue& bytes = connection_->bytes();
    while (!bytes.drained() && std::chrono::steady_clock::now() < deadline)
    {
        bytes.wait(kLongestWait);
        bytes.pop(block_);
    }
}

bool Player::reached_end() const
{
    return refiner_->decoder().decoded_bytes() >= end_;
}

}  // namespace vsplit::client
