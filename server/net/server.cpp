#include "net/server.h"

#include "net/model_library.h"
#include "net/session.h"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/strand.hpp>
#include <spdlog/spdlog.h>

#include <atomic>
#include <csignal>
#include <exception>
#include <list>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <thread>
#include <vector>

namespace vsplit::net {
namespace {

namespace asio = boost::asio;
using Strand = asio::strand<asio::io_context::executor_type>;
using Socket = asio::basic_stream_socket<asio::ip::tcp, Strand>;
using Acceptor = asio::basic_socket_acceptor<asio::ip::tcp, Strand>;

/// Unsent bytes that the kernel keeps for one connection: enough to stay busy, few enough that Pause
/// and Cancel act quickly and a client that stops reading costs little.
constexpr int kUnsentBytes = 2 * static_cast<int>(proto::kSentDataBytes);

/// So many clients more than the limit are told that the server is full; further ones are cut off.
constexpr std::size_t kMaxRefusals = 64;

constexpr std::chrono::milliseconds kAcceptRetry{100};

void tune(Socket& socket)
{
    const auto set = [&socket](int option, int value) {
        ::setsockopt(socket.native_handle(), IPPROTO_TCP, option, &value, sizeof(value));
    };
    set(TCP_NODELAY, 1);
    set(TCP_NOTSENT_LOWAT, kUnsentBytes);
}

std::string text_of(const asio::ip::tcp::endpoint& endpoint)
{
    const std::string address = endpoint.address().to_string();
    const std::string port = std::to_string(endpoint.port());
    return endpoint.address().is_v6() ? "[" + address + "]:" + port : address + ":" + port;
}

void log_summary(const SessionSummary& summary)
{
    spdlog::info(
        "{} client='{}' model='{}' data_bytes={} seconds={:.3f} end='{}'",
        summary.peer,
        summary.client,
        summary.model,
        summary.data_bytes,
        std::chrono::duration<double>(summary.duration).count(),
        summary.reason
    );
}

}  // namespace

/// Everything but the sessions runs on one strand.
class Server::Impl
{
public:
    Impl(ServerSettings settings, std::filesystem::path root, EncoderSettings encoder)
        : settings_(std::move(settings)),
          strand_(asio::make_strand(context_)),
          acceptor_(strand_),
          signals_(strand_, SIGTERM, SIGINT),
          timer_(strand_),
          library_(std::move(root), std::move(encoder))
    {
    }

    Result<std::string> listen()
    {
        boost::system::error_code error;
        const auto address = asio::ip::make_address(settings_.address, error);
        if (error)
        {
            return fail(ErrorCode::BadRequest, "'" + settings_.address + "' is not an address");
        }
        const asio::ip::tcp::endpoint endpoint(address, settings_.port);
        acceptor_.open(endpoint.protocol(), error);
        if (!error)
        {
            acceptor_.set_option(asio::socket_base::reuse_address(true), error);
            acceptor_.bind(endpoint, error);
        }
        if (!error)
        {
            acceptor_.listen(asio::socket_base::max_listen_connections, error);
        }
        if (error)
        {
            return fail(
                ErrorCode::IoError, "cannot listen on " + text_of(endpoint) + ": " + error.message()
            );
        }
        return text_of(acceptor_.local_endpoint());
    }

    void run()
    {
        const auto log_exception = [](const std::exception_ptr& thrown) {
            if (thrown)
            {
                spdlog::error("defect: the listener threw an exception");
            }
        };
        // The logger exists before the threads: the guard of its making is inside a library, where
        // the thread sanitizer cannot see it.
        spdlog::default_logger_raw();
        asio::co_spawn(strand_, accept_loop(), log_exception);
        asio::co_spawn(strand_, stop_on_signal(), log_exception);
        std::vector<std::jthread> threads;
        for (std::size_t i = 1; i < settings_.threads; ++i)
        {
            threads.emplace_back([this] { work(); });
        }
        work();
    }

private:
    /// Runs handlers until there is nothing left to do. What one of them throws (memory, for one)
    /// ends that handler alone.
    void work()
    {
        while (true)
        {
            try
            {
                context_.run();
                return;
            }
            catch (const std::exception& thrown)
            {
                spdlog::error("defect: {}", thrown.what());
            }
        }
    }

    asio::awaitable<void> accept_loop()
    {
        while (acceptor_.is_open())
        {
            auto [error, socket] = co_await acceptor_.async_accept(
                asio::make_strand(context_), asio::as_tuple(asio::use_awaitable)
            );
            if (!error)
            {
                admit(std::move(socket));
                continue;
            }
            if (acceptor_.is_open())
            {
                // Most often too many open files; sessions that end make room.
                spdlog::warn("cannot accept a connection: {}", error.message());
                timer_.expires_after(kAcceptRetry);
                co_await timer_.async_wait(asio::as_tuple(asio::use_awaitable));
            }
        }
    }

    void admit(Socket socket)
    {
        const std::size_t present = sessions_count_.load();
        if (present >= settings_.max_sessions + kMaxRefusals)
        {
            return;
        }
        tune(socket);
        boost::system::error_code error;
        const auto peer = socket.remote_endpoint(error);
        SessionSettings session_settings{
            .idle_timeout = settings_.idle_timeout,
            .peer = error ? "unknown" : text_of(peer),
            .find = [this](
                        std::string name, ModelLibrary::Done done
                    ) { library_.find(std::move(name), std::move(done)); },
            .on_end = log_summary,
        };
        auto session = std::make_shared<Session<Socket>>(
            std::move(socket), std::move(session_settings), make_ticket()
        );
        if (present >= settings_.max_sessions)
        {
            session->refuse(Error{ErrorCode::Overloaded, "the server is full, try again later", 0});
        }
        std::erase_if(sessions_, [](const auto& known) { return known.expired(); });
        sessions_.push_back(session);
        session->start();
    }

    /// Counts a session until its connection is closed.
    std::shared_ptr<void> make_ticket()
    {
        ++sessions_count_;
        return std::shared_ptr<void>(this, [](void* impl) {
            --static_cast<Impl*>(impl)->sessions_count_;
        });
    }

    asio::awaitable<void> stop_on_signal()
    {
        constexpr auto kToken = asio::as_tuple(asio::use_awaitable);
        co_await signals_.async_wait(kToken);
        spdlog::info("shutting down, {} sessions are open", sessions_count_.load());
        boost::system::error_code ignored;
        acceptor_.close(ignored);
        timer_.cancel();
        for (const auto& known : sessions_)
        {
            if (const auto session = known.lock())
            {
                session->finish();
            }
        }
        co_await wait_for_sessions();
        library_.stop();
        for (const auto& known : sessions_)
        {
            if (const auto session = known.lock())
            {
                session->abort();
            }
        }
        signals_.cancel(ignored);
    }

    /// Returns when no session is left, the grace period is over, or another signal came.
    asio::awaitable<void> wait_for_sessions()
    {
        constexpr std::chrono::milliseconds kStep{20};
        // A member, because the handler may run after this coroutine has returned.
        signals_.async_wait([this](const boost::system::error_code& error, int) {
            impatient_ = impatient_ || !error;
        });
        const auto deadline = std::chrono::steady_clock::now() + settings_.grace;
        while (!impatient_ && sessions_count_ > 0 && std::chrono::steady_clock::now() < deadline)
        {
            timer_.expires_after(kStep);
            co_await timer_.async_wait(asio::as_tuple(asio::use_awaitable));
        }
    }

    ServerSettings settings_;
    std::atomic<std::size_t> sessions_count_ = 0;
    bool impatient_ = false;  ///< A second signal came; used on the strand only.
    std::list<std::weak_ptr<SessionControl>> sessions_;
    asio::io_context context_;
    Strand strand_;
    Acceptor acceptor_;
    asio::basic_signal_set<Strand> signals_;
    asio::basic_waitable_timer<
        std::chrono::steady_clock,
        asio::wait_traits<std::chrono::steady_clock>,
        Strand>
        timer_;
    ModelLibrary library_;  ///< Last: its threads post to the context.
};

Server::Server(ServerSettings settings, std::filesystem::path root, EncoderSettings encoder)
    : impl_(std::make_unique<Impl>(std::move(settings), std::move(root), std::move(encoder)))
{
}

Server::~Server() = default;

Result<std::string> Server::listen()
{
    return impl_->listen();
}

void Server::run()
{
    impl_->run();
}

}  // namespace vsplit::net
