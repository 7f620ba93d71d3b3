#include "net/server.h"

#include "net/test_streams.h"

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <gtest/gtest.h>

#include <charconv>
#include <csignal>
#include <string>
#include <thread>
#include <unistd.h>

namespace vsplit::net {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using test::Bytes;

/// A server in a thread of this process; signals sent to the process reach it.
class ServerTest : public testing::Test
{
protected:
    ServerTest() { folder_.write("cow.vsplit", file_); }

    ~ServerTest() override { stop(); }

    void start(const ServerSettings& settings)
    {
        server_ = std::make_unique<Server>(settings, folder_.path(), EncoderSettings{});
        const auto address = server_->listen();
        ASSERT_TRUE(address) << describe(address.error());
        address_ = *address;
        const std::string digits = address_.substr(address_.rfind(':') + 1);
        std::from_chars(digits.data(), digits.data() + digits.size(), port_);
        thread_ = std::thread([this] { server_->run(); });
    }

    void stop()
    {
        if (thread_.joinable())
        {
            ::kill(::getpid(), SIGTERM);
            thread_.join();
        }
    }

    tcp::socket connect()
    {
        tcp::socket socket(context_);
        socket.connect({asio::ip::address_v4::loopback(), port_});
        return socket;
    }

    static void ask(tcp::socket& socket)
    {
        asio::write(socket, asio::buffer(encode(wire::Open{.model = "cow"}).value()));
    }

    /// Reads until the server closes the connection; `bytes` were read before.
    static test::ServerTalk read_all(tcp::socket& socket, Bytes bytes = {})
    {
        boost::system::error_code error;
        asio::read(socket, asio::dynamic_buffer(bytes), error);
        return test::understand(bytes);
    }

    test::TemporaryFolder folder_;
    Bytes file_ = test::make_stream_file({500, 60'000}, 1);
    std::unique_ptr<Server> server_;
    std::string address_;
    std::uint16_t port_ = 0;
    std::thread thread_;
    asio::io_context context_;
};

TEST_F(ServerTest, ServesAndStopsOnASignal)
{
    start({});
    EXPECT_EQ(address_, "127.0.0.1:" + std::to_string(port_));
    auto client = connect();
    ask(client);
    client.shutdown(tcp::socket::shutdown_send);
    EXPECT_EQ(read_all(client).data, file_);
    stop();
    EXPECT_THROW(connect(), boost::system::system_error);
}

TEST_F(ServerTest, SessionsBeyondTheLimitAreToldSo)
{
    start({.max_sessions = 1});
    auto first = connect();
    ask(first);
    Bytes begin(4);
    asio::read(first, asio::buffer(begin));
    auto second = connect();
    ask(second);
    const auto talk = read_all(second);
    ASSERT_EQ(talk.failures.size(), 1U);
    EXPECT_EQ(talk.failures[0].code, static_cast<unsigned>(ErrorCode::Overloaded));
    EXPECT_TRUE(talk.failures[0].closing);
    EXPECT_TRUE(talk.data.empty());
}

TEST_F(ServerTest, StalledTransferIsCutOffAtTheEndOfTheGracePeriod)
{
    start({.grace = std::chrono::seconds(0)});
    auto client = connect();
    asio::write(
        client,
        asio::buffer(test::joined(
            encode(wire::Open{.model = "cow"}).value(), wire::make_frame(wire::FrameType::Pause)
        ))
    );
    Bytes begin(4);
    asio::read(client, asio::buffer(begin));
    stop();
    EXPECT_TRUE(read_all(client, begin).dones.empty());
}

TEST_F(ServerTest, RefusesAnAddressThatItCannotHave)
{
    start({});
    Server second({.port = port_}, folder_.path(), EncoderSettings{});
    EXPECT_EQ(second.listen().error().code, ErrorCode::IoError);
    Server third({.address = "localhost"}, folder_.path(), EncoderSettings{});
    EXPECT_EQ(third.listen().error().code, ErrorCode::BadRequest);
}

}  // namespace
}  // namespace vsplit::net
