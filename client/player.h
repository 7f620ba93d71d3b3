#pragma once

#include "connection.h"
#include "fetch_plan.h"
#include "options.h"
#include "presenter.h"
#include "refiner.h"
#include "report.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <ostream>
#include <vector>

namespace vsplit::client {

/// Runs one session of the simulated device: connect, refine, draw, report. Use on one thread.
class Player
{
public:
    /// `options`, `out` (where people read the table as it grows): must outlive the player.
    Player(const Options& options, std::ostream& out);

    /// Plays the stream to its end or to the stop condition, and saves what was asked for.
    /// Errors: those of Connection, codec::StreamDecoder, plan_memory(), Display and of writing
    /// files. What was shown before an error is in report() all the same.
    [[nodiscard]] Result<void> run();

    /// What was found out so far.
    [[nodiscard]] const Report& report() const { return report_; }

private:
    [[nodiscard]] Result<void> play();
    [[nodiscard]] Result<void> read_header();
    [[nodiscard]] Result<void> plan();
    [[nodiscard]] Result<void> start_refining();
    [[nodiscard]] Result<void> feed_header();
    [[nodiscard]] Result<void> refine();
    [[nodiscard]] bool more_of_textures_waits();
    [[nodiscard]] Result<void> pump_bytes();
    bool skip_left_out();
    [[nodiscard]] Result<void> wait_or_draw();
    [[nodiscard]] Result<void> accept_end_of_transfer();
    [[nodiscard]] Result<void> finish();
    [[nodiscard]] bool wants(const codec::ChunkInfo& chunk) const;
    [[nodiscard]] std::vector<ByteRange> find_unwanted() const;
    void leave_out_unwanted();
    void await_goodbye();
    [[nodiscard]] bool reached_end() const;

    const Options& options_;
    std::ostream& out_;
    Report report_;
    Presenter presenter_;
    std::unique_ptr<Connection> connection_;
    std::vector<std::byte> header_;
    codec::StreamInfo info_;           ///< Of the whole stream.
    StopPlan stop_;                    ///< What the server was told.
    std::vector<ByteRange> unwanted_;  ///< Likewise.
    std::uint32_t level_ = 0;          ///< The finest level that will be decoded.
    std::uint32_t texture_limit_ = 0;  ///< Longest side of a texture, pixels.
    std::uint64_t end_ = 0;            ///< Length of the prefix that will be decoded.
    bool restricted_ = false;          ///< The stop was moved forward during the transfer.
    bool knows_materials_ = false;     ///< unwanted_ was chosen with them.
    std::unique_ptr<Refiner> refiner_;
    std::vector<std::byte> block_;
};

}  // namespace vsplit::client
