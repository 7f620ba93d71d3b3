#pragma once

#include "net/conversation.h"

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/error.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/socket_base.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace vsplit::net {

/// Looks a model up and calls back exactly once, from any thread.
using FindModel = std::function<void(std::string, std::function<void(Result<StreamPtr>)>)>;

/// What became of a session, for the log.
struct SessionSummary
{
    std::string peer;
    std::string client;  ///< What the client called itself, if it did.
    std::string model;   ///< The model asked for last, if any.
    std::uint64_t data_bytes = 0;
    std::chrono::milliseconds duration{};
    std::string reason;  ///< Why it ended.
};

/// What a session needs to know.
struct SessionSettings
{
    std::chrono::milliseconds handshake_timeout{
        10'000};                                        ///< From the connection to the first Open.
    std::chrono::milliseconds idle_timeout{60'000};     ///< Longest silence or stalled write.
    std::chrono::milliseconds waiting_interval{2'000};  ///< Between two Waiting frames.
    std::string peer{};                                 ///< Who is connected, for the log.
    FindModel find{};
    std::function<void(const SessionSummary&)> on_end{};  ///< Called once, on the session's strand.
};

/// How the server ends sessions of any stream type.
class SessionControl
{
public:
    virtual ~SessionControl() = default;

    /// Lets the running transfer finish, then closes the connection. Thread safe.
    virtual void finish() = 0;

    /// Closes the connection at once. Thread safe.
    virtual void abort() = 0;
};

/// Drives one Conversation over a connection: one coroutine reads, one writes, one watches the clock.
/// `Stream`: an Asio stream socket whose executor is a strand; a template so that tests run it over a
/// socket pair. It keeps itself alive until the connection is closed. Every member runs on the strand
/// but finish() and abort(), which are thread safe. Safe on untrusted input.
template <typename Stream>
class Session : public SessionControl, public std::enable_shared_from_this<Session<Stream>>
{
public:
    /// Takes over a connected stream. `ticket`: released when the connection is closed.
    Session(Stream stream, SessionSettings settings, std::shared_ptr<void> ticket = nullptr)
        : stream_(std::move(stream)),
          settings_(std::move(settings)),
          ticket_(std::move(ticket)),
          output_ready_(stream_.get_executor()),
          clock_(stream_.get_executor())
    {
    }

    /// Begins to serve. Call once, on an object held by a shared_ptr. Thread safe.
    void start()
    {
        spawn(read_loop());
        spawn(write_loop());
        spawn(watch_loop());
    }

    /// Answers with a failure instead of serving, then closes. Before start().
    void refuse(const Error& error) { conversation_.close_with(error); }

    /// As SessionControl::finish().
    void finish() override
    {
        boost::asio::post(stream_.get_executor(), [self = this->shared_from_this()] {
            self->finishing_ = true;
            self->output_ready_.cancel();
        });
    }

    /// As SessionControl::abort().
    void abort() override
    {
        boost::asio::post(stream_.get_executor(), [self = this->shared_from_this()] {
            self->end("stopped by the server");
        });
    }

private:
    using Clock = std::chrono::steady_clock;
    static constexpr std::size_t kReadBytes = 4096;
    static constexpr std::chrono::milliseconds kLingerTime{2'000};

    void spawn(boost::asio::awaitable<void> loop)
    {
        // The handler owns the session: it lives as long as one of its loops.
        boost::asio::co_spawn(
            stream_.get_executor(),
            std::move(loop),
            [self = this->shared_from_this()](const std::exception_ptr& thrown) {
                if (thrown)
                {
                    self->end("defect: a session threw an exception");
                }
            }
        );
    }

    boost::asio::awaitable<void> read_loop()
    {
        constexpr auto kToken = boost::asio::as_tuple(boost::asio::use_awaitable);
        while (!ended_)
        {
            const auto [error, count] =
                co_await stream_.async_read_some(boost::asio::buffer(read_buffer_), kToken);
            if (error)
            {
                finish_reading(error == boost::asio::error::eof ? "" : error.message());
                break;
            }
            const std::uint64_t frames_before = conversation_.frames_received();
            conversation_.receive(std::span(read_buffer_).first(count));
            if (conversation_.frames_received() != frames_before)
            {
                last_sign_ = Clock::now();
            }
            look_up();
            output_ready_.cancel();
        }
    }

    /// The client will send no more. What it asked for is still sent, unless the connection broke.
    void finish_reading(const std::string& broken)
    {
        peer_finished_ = true;
        output_ready_.cancel();
        if (!broken.empty())
        {
            end(broken);
        }
        else if (write_finished_)
        {
            end("closed");
        }
    }

    boost::asio::awaitable<void> write_loop()
    {
        while (!ended_)
        {
            const Output output = conversation_.next_output();
            if (!output.empty())
            {
                co_await write(output);
                continue;
            }
            if (conversation_.closing() || (peer_finished_ && !conversation_.busy()))
            {
                finish_writing();
                break;
            }
            if (finishing_ && !conversation_.busy())
            {
                conversation_.close_with(Error{ErrorCode::Cancelled, "the server shuts down", 0});
                continue;
            }
            output_ready_.expires_at(Clock::time_point::max());
            co_await output_ready_.async_wait(boost::asio::as_tuple(boost::asio::use_awaitable));
        }
    }

    boost::asio::awaitable<void> write(Output output)
    {
        const std::array<boost::asio::const_buffer, 2> buffers{
            boost::asio::buffer(output.head.data(), output.head.size()),
            boost::asio::buffer(output.body.data(), output.body.size()),
        };
        // Called after every partial write: any progress renews the deadline.
        const auto progress = [this](const boost::system::error_code& error, std::size_t) {
            write_deadline_ = Clock::now() + settings_.idle_timeout;
            return error ? std::size_t{0} : proto::kMaxDataBytes;
        };
        const auto [error, count] = co_await boost::asio::async_write(
            stream_, buffers, progress, boost::asio::as_tuple(boost::asio::use_awaitable)
        );
        write_deadline_.reset();
        if (error)
        {
            end(error.message());
        }
    }

    /// Ends the sending side and leaves the client some time to read: closing while its bytes are
    /// unread would reset the connection and may destroy the last frames on their way.
    void finish_writing()
    {
        write_finished_ = true;
        boost::system::error_code ignored;
        stream_.shutdown(boost::asio::socket_base::shutdown_send, ignored);
        linger_deadline_ = Clock::now() + kLingerTime;
        if (peer_finished_)
        {
            end("closed");
        }
    }

    boost::asio::awaitable<void> watch_loop()
    {
        using std::chrono::milliseconds;
        const auto least = std::min(
            {settings_.handshake_timeout, settings_.idle_timeout, settings_.waiting_interval}
        );
        const auto interval =
            std::clamp<milliseconds>(least / 8, milliseconds(5), milliseconds(1000));
        while (!ended_)
        {
            clock_.expires_after(interval);
            co_await clock_.async_wait(boost::asio::as_tuple(boost::asio::use_awaitable));
            check_deadlines(Clock::now());
        }
    }

    void check_deadlines(Clock::time_point now)
    {
        if (ended_)
        {
            return;
        }
        if (write_deadline_ && now > *write_deadline_)
        {
            end("the client takes no data");
            return;
        }
        if (linger_deadline_ && now > *linger_deadline_)
        {
            end("closed by the server");
            return;
        }
        if (!conversation_.waits_for_client())
        {
            last_sign_ = now;
        }
        const bool no_request = !opened_ && now > started_ + settings_.handshake_timeout;
        if (no_request || now > last_sign_ + settings_.idle_timeout)
        {
            conversation_.close_with(Error{ErrorCode::Timeout, "nothing heard for too long", 0});
            output_ready_.cancel();
        }
        if (conversation_.busy() && now > last_waiting_ + settings_.waiting_interval)
        {
            last_waiting_ = now;
            conversation_.report_waiting();
            output_ready_.cancel();
        }
    }

    /// Passes a request on; at most one look-up of a session runs at any time.
    void look_up()
    {
        if (looking_up_ || ended_)
        {
            return;
        }
        auto request = conversation_.take_request();
        if (!request)
        {
            return;
        }
        opened_ = true;
        looking_up_ = true;
        last_waiting_ = Clock::now();
        client_ = request->open.client;
        model_ = request->open.model;
        auto answer = [weak = this->weak_from_this(),
                       executor = stream_.get_executor(),
                       number = request->number](Result<StreamPtr> stream) {
            boost::asio::post(executor, [weak, number, stream = std::move(stream)] {
                if (const auto self = weak.lock())
                {
                    self->deliver(number, stream);
                }
            });
        };
        settings_.find(model_, std::move(answer));
    }

    void deliver(std::uint64_t number, const Result<StreamPtr>& stream)
    {
        looking_up_ = false;
        conversation_.answer(number, stream);
        look_up();
        output_ready_.cancel();
    }

    void end(const std::string& reason)
    {
        if (std::exchange(ended_, true))
        {
            return;
        }
        boost::system::error_code ignored;
        stream_.close(ignored);
        output_ready_.cancel();
        clock_.cancel();
        ticket_.reset();
        if (settings_.on_end)
        {
            const auto duration =
                std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - started_);
            settings_.on_end(
                {settings_.peer, client_, model_, conversation_.data_bytes(), duration, reason}
            );
        }
    }

    Stream stream_;
    SessionSettings settings_;
    std::shared_ptr<void> ticket_;
    Conversation conversation_;
    boost::asio::steady_timer output_ready_;  ///< Cancelled to wake the writer.
    boost::asio::steady_timer clock_;
    std::array<std::byte, kReadBytes> read_buffer_{};
    std::string client_;
    std::string model_;
    Clock::time_point started_ = Clock::now();
    Clock::time_point last_sign_ = started_;
    Clock::time_point last_waiting_ = started_;
    std::optional<Clock::time_point> write_deadline_;
    std::optional<Clock::time_point> linger_deadline_;
    bool opened_ = false;
    bool looking_up_ = false;
    bool peer_finished_ = false;
    bool finishing_ = false;
    bool write_finished_ = false;
    bool ended_ = false;
};

}  // namespace vsplit::net
