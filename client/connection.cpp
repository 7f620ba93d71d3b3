#include "connection.h"

#include "client_socket.h"
#include "link_shaper.h"
#include "retry_policy.h"

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <exception>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace vsplit::client {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;
using tcp = asio::ip::tcp;
using Clock = std::chrono::steady_clock;

constexpr auto kAwait = asio::as_tuple(asio::use_awaitable);
constexpr std::size_t kReadBytes = 65536;

}  // namespace

class Connection::Impl
{
public:
    explicit Impl(ConnectionOptions options)
        : options_(std::move(options)),
          resolver_(context_),
          socket_(context_),
          deadline_(context_),
          pause_(context_),
          room_(context_),
          shaper_(options_.link, Clock::now()),
          transfer_(options_.request),
          queue_(options_.queue_bytes, [this] { wake_receiver(); }),
          input_(kReadBytes)
    {
        asio::co_spawn(context_, run(), [this](const std::exception_ptr& thrown) { end(thrown); });
        thread_ = std::thread([this] { context_.run(); });
    }

    ~Impl()
    {
        context_.stop();
        thread_.join();
    }

    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    ByteQueue& bytes() { return queue_; }

    void restrict_to(const StopPlan& stop, std::vector<ByteRange> unwanted)
    {
        asio::post(context_, [this, stop, ranges = std::move(unwanted)] {
            transfer_.leave_out(ranges);
            change_stop(stop);
        });
    }

    bool leaves_out(std::uint64_t offset) const
    {
        const std::lock_guard lock(mutex_);
        return std::ranges::find(gaps_, offset, &ByteRange::begin) != gaps_.end();
    }

    std::optional<Error> error() const
    {
        const std::lock_guard lock(mutex_);
        return error_;
    }

    TransferCounters counters() const { return {payload_bytes_, wire_bytes_, reconnects_}; }

private:
    using Task = asio::awaitable<Result<void>>;

    // Connects and reconnects until the transfer is over.
    asio::awaitable<void> run()
    {
        RetryPolicy policy(options_.retries);
        while (true)
        {
            const std::uint64_t before = transfer_.received();
            const Result<void> outcome = co_await session();
            close_socket();
            if (outcome)
            {
                co_return;
            }
            const bool progress = transfer_.received() > before;
            const auto pause = policy.next_pause(outcome.error().code, progress);
            // An address that never answered is more likely wrong than lost.
            if (connections_ == 0 || !pause)
            {
                set_error(outcome.error());
                co_return;
            }
            pause_.expires_after(*pause);
            co_await pause_.async_wait(kAwait);
        }
    }

    void end(const std::exception_ptr& thrown)
    {
        if (thrown)
        {
            set_error({ErrorCode::Internal, "the connection ran out of resources"});
        }
        queue_.close();
    }

    // One connection, from its start to the end of the transfer or of the connection.
    Task session()
    {
        transfer_.start_connection();
        auto connected = co_await connect();
        if (!connected)
        {
            co_return connected;
        }
        while (true)
        {
            stop_changed_ = false;
            auto outcome = co_await fetch();
            note_gaps();
            if (!outcome || !(stop_changed_ || transfer_.has_more()))
            {
                co_return outcome;
            }
        }
    }

    Task connect()
    {
        timed_out_ = false;
        arm_deadline();
        const auto [resolve_error, endpoints] = co_await resolver_.async_resolve(
            options_.address.host, std::to_string(options_.address.port), kAwait
        );
        if (resolve_error)
        {
            co_return lost("cannot find the host", resolve_error);
        }
        error_code result = asio::error::host_not_found;
        for (const auto& endpoint : endpoints)
        {
            result = prepare_socket(socket_, endpoint.endpoint(), options_.link);
            if (!result)
            {
                const auto [connect_error] =
                    co_await socket_.async_connect(endpoint.endpoint(), kAwait);
                result = connect_error;
            }
            if (!result || timed_out_)
            {
                break;
            }
        }
        disarm_deadline();
        if (result || timed_out_)
        {
            co_return lost("cannot connect", result);
        }
        reconnects_ += connections_ > 0 ? 1 : 0;
        ++connections_;
        // Loopback connects at once; a link needs a round trip for it.
        pause_.expires_after(options_.link.latency);
        co_await pause_.async_wait(kAwait);
        co_return Result<void>{};
    }

    // Asks for the bytes that are missing and receives them.
    Task fetch()
    {
        const auto frame = transfer_.open(options_.stop);
        if (!frame)
        {
            co_return tl::unexpected<Error>(frame.error());
        }
        note_gaps();
        arm_deadline();
        const auto [write_error, written] =
            co_await asio::async_write(socket_, asio::buffer(*frame), kAwait);
        disarm_deadline();
        if (write_error)
        {
            co_return lost("the connection broke", write_error);
        }
        shaper_.hold_for_round_trip(Clock::now());
        fetching_ = true;
        if (stop_changed_)
        {
            send_cancel();  // The stop was changed while Open was on its way.
        }
        auto outcome = co_await receive();
        fetching_ = false;
        co_return outcome;
    }

    Task receive()
    {
        while (!transfer_.done())
        {
            const std::size_t most = co_await wait_until_readable();
            arm_deadline();
            const auto [read_error, count] =
                co_await socket_.async_read_some(asio::buffer(input_.data(), most), kAwait);
            disarm_deadline();
            if (read_error)
            {
                co_return lost("the connection broke", read_error);
            }
            shaper_.consume(count);
            wire_bytes_ += count;
            // Counted before it is handed over: who has taken the last byte sees the right sum.
            const auto hand_over = [this](std::span<const std::byte> piece) {
                payload_bytes_ += piece.size();
                queue_.push(piece);
            };
            auto taken = transfer_.take(std::span(input_).first(count), hand_over);
            if (!taken)
            {
                co_return taken;
            }
        }
        co_return Result<void>{};
    }

    // Waits for the link and for room in the queue; returns how many bytes may be read.
    asio::awaitable<std::size_t> wait_until_readable()
    {
        const auto ready = shaper_.next_read(Clock::now());
        if (ready > Clock::now())
        {
            pause_.expires_at(ready);
            co_await pause_.async_wait(kAwait);
        }
        while (queue_.space() == 0)
        {
            // The reader's thread ends this wait through wake_receiver().
            room_.expires_at(Clock::time_point::max());
            co_await room_.async_wait(kAwait);
        }
        const std::size_t ready_bytes = std::max<std::size_t>(1, shaper_.readable(Clock::now()));
        co_return std::min({ready_bytes, queue_.space(), input_.size()});
    }

    void wake_receiver()
    {
        asio::post(context_, [this] { room_.cancel(); });
    }

    // Before the bytes that follow them are in the queue; see Connection::leaves_out().
    void note_gaps()
    {
        const auto passed = transfer_.take_gaps();
        const std::lock_guard lock(mutex_);
        gaps_.insert(gaps_.end(), passed.begin(), passed.end());
    }

    void change_stop(const StopPlan& stop)
    {
        options_.stop = stop;
        stop_changed_ = true;
        if (fetching_ && !transfer_.done())
        {
            send_cancel();
        }
    }

    void send_cancel()
    {
        auto frame = std::make_shared<std::vector<std::byte>>(transfer_.cancel());
        asio::async_write(socket_, asio::buffer(*frame), [frame](const error_code&, std::size_t) {
        });
    }

    // Closing the socket is what ends a wait for a silent peer; the wait then reports a Timeout.
    void arm_deadline()
    {
        const std::uint64_t generation = ++deadline_generation_;
        deadline_.expires_after(options_.timeout);
        deadline_.async_wait([this, generation](const error_code& result) {
            if (!result && generation == deadline_generation_)
            {
                timed_out_ = true;
                resolver_.cancel();
                close_socket();
            }
        });
    }

    void disarm_deadline()
    {
        ++deadline_generation_;
        deadline_.cancel();
    }

    void close_socket() { static_cast<void>(socket_.close(ignored_)); }

    [[nodiscard]] tl::unexpected<Error> lost(const std::string& what, const error_code& why) const
    {
        const std::string peer =
            options_.address.host + ":" + std::to_string(options_.address.port);
        if (timed_out_)
        {
            return fail(ErrorCode::Timeout, peer + " does not answer", transfer_.received());
        }
        const std::string reason = why == asio::error::eof ? "the server closed it" : why.message();
        const std::string text = peer + ": " + what + ": " + reason;
        return fail(ErrorCode::ConnectionLost, text, transfer_.received());
    }

    void set_error(Error error)
    {
        const std::lock_guard lock(mutex_);
        error_ = std::move(error);
    }

    asio::io_context context_{1};
    ConnectionOptions options_;
    tcp::resolver resolver_;
    tcp::socket socket_;
    asio::steady_timer deadline_;
    asio::steady_timer pause_;
    asio::steady_timer room_;
    LinkShaper shaper_;
    Transfer transfer_;
    ByteQueue queue_;
    std::vector<std::byte> input_;
    std::uint64_t deadline_generation_ = 0;
    error_code ignored_;
    bool timed_out_ = false;
    bool fetching_ = false;
    bool stop_changed_ = false;
    unsigned connections_ = 0;
    std::atomic<std::uint64_t> payload_bytes_ = 0;
    std::atomic<std::uint64_t> wire_bytes_ = 0;
    std::atomic<std::uint32_t> reconnects_ = 0;
    mutable std::mutex mutex_;
    std::optional<Error> error_;
    std::vector<ByteRange> gaps_;
    std::thread thread_;
};

Connection::Connection(ConnectionOptions options)
{
    if (options.request.model.empty())
    {
        options.request.model = options.address.model;
    }
    impl_ = std::make_unique<Impl>(std::move(options));
}

Connection::~Connection() = default;

ByteQueue& Connection::bytes()
{
    return impl_->bytes();
}

void Connection::restrict_to(const StopPlan& stop, std::vector<ByteRange> unwanted)
{
    impl_->restrict_to(stop, std::move(unwanted));
}

bool Connection::leaves_out(std::uint64_t offset) const
{
    return impl_->leaves_out(offset);
}

std::optional<Error> Connection::error() const
{
    return impl_->error();
}

TransferCounters Connection::counters() const
{
    return impl_->counters();
}

}  // namespace vsplit::client
