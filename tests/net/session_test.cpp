#include "net/session.h"

#include "net/stream_store.h"
#include "net/test_streams.h"

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/local/connect_pair.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/strand.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <future>
#include <thread>

namespace vsplit::net {
namespace {

namespace asio = boost::asio;
using std::chrono::milliseconds;
using test::Bytes;
using testing::ElementsAre;
using wire::FrameType;
using Socket = asio::local::stream_protocol::socket;

/// Long enough for any machine; only failing tests wait so long.
constexpr std::chrono::seconds kPatience{30};

/// A session over a socket pair, whose other end the test plays.
class SessionTest : public testing::Test
{
protected:
    SessionTest()
    {
        settings_.find = [this](const std::string& name, const auto& done) {
            name == "cow" ? done(stream_)
                          : done(fail(ErrorCode::NotFound, "there is no model " + name));
        };
        settings_.on_end = [this](const SessionSummary& summary) { ended_.set_value(summary); };
    }

    ~SessionTest() override
    {
        client_.close();
        work_.reset();
        thread_.join();
        session_.reset();  // Its strand must go before the context does.
    }

    void start()
    {
        Socket server(asio::make_strand(context_));
        asio::local::connect_pair(client_, server);
        // Small, so that a client that does not read is noticed soon.
        server.set_option(asio::socket_base::send_buffer_size(4096));
        session_ = std::make_shared<Session<Socket>>(std::move(server), settings_, ticket_);
        watch_ = session_;
        if (refusal_)
        {
            session_->refuse(*refusal_);
        }
        session_->start();
    }

    void send(const Bytes& bytes) { asio::write(client_, asio::buffer(bytes)); }

    void open(const std::string& model) { send(encode(wire::Open{.model = model}).value()); }

    Bytes read(std::size_t count)
    {
        Bytes bytes(count);
        asio::read(client_, asio::buffer(bytes));
        return bytes;
    }

    /// Reads until the server closes the connection.
    test::ServerTalk read_all()
    {
        Bytes bytes;
        boost::system::error_code error;
        asio::read(client_, asio::dynamic_buffer(bytes), error);
        EXPECT_EQ(error, asio::error::eof);
        return test::understand(bytes);
    }

    /// Says that no more requests will come.
    void finish_sending() { client_.shutdown(asio::socket_base::shutdown_send); }

    SessionSummary summary()
    {
        auto future = ended_.get_future();
        EXPECT_EQ(future.wait_for(kPatience), std::future_status::ready);
        return future.get();
    }

    [[nodiscard]] Bytes file() const { return {stream_->bytes.begin(), stream_->bytes.end()}; }

    StreamPtr stream_ = test::make_served_stream({900, 5'000, 400'000}, 1);
    SessionSettings settings_;
    std::optional<Error> refusal_;
    std::shared_ptr<void> ticket_ = std::make_shared<int>(0);
    std::promise<SessionSummary> ended_;
    std::shared_ptr<Session<Socket>> session_;
    std::weak_ptr<Session<Socket>> watch_;
    asio::io_context context_;
    asio::executor_work_guard<asio::io_context::executor_type> work_{context_.get_executor()};
    std::thread thread_{[this] { context_.run(); }};
    Socket client_{context_};
};

TEST_F(SessionTest, SendsTheModelAndEndsWithTheClient)
{
    start();
    open("cow");
    finish_sending();
    const auto talk = read_all();
    EXPECT_THAT(talk.frames, ElementsAre(FrameType::ModelInfo, FrameType::Data, FrameType::Done));
    EXPECT_EQ(talk.data, file());
    const auto end = summary();
    EXPECT_EQ(end.model, "cow");
    EXPECT_EQ(end.data_bytes, file().size());
}

TEST_F(SessionTest, SeveralRequestsFollowEachOther)
{
    start();
    open("dog");
    const Bytes head = read(proto::kFrameHeaderBytes);
    const Bytes failure = read(static_cast<std::size_t>(head[0]));
    EXPECT_EQ(wire::parse_failure(failure)->code, static_cast<unsigned>(ErrorCode::NotFound));
    open("cow");
    finish_sending();
    EXPECT_EQ(read_all().data, file());
}

TEST_F(SessionTest, GarbageIsAnsweredAndCutOff)
{
    start();
    send(Bytes(3000, std::byte{0xEE}));
    const auto talk = read_all();
    ASSERT_EQ(talk.failures.size(), 1U);
    EXPECT_EQ(talk.failures[0].code, static_cast<unsigned>(ErrorCode::BadFrame));
    EXPECT_TRUE(talk.failures[0].closing);
}

TEST_F(SessionTest, OversizeFrameIsRefusedWithoutItsPayload)
{
    start();
    const auto header = wire::frame_header(FrameType::Open, proto::kMaxControlBytes + 1);
    send(Bytes(header.begin(), header.end()));
    EXPECT_EQ(read_all().failures.at(0).code, static_cast<unsigned>(ErrorCode::BadFrame));
}

TEST_F(SessionTest, RequestCutShortEndsQuietly)
{
    start();
    Bytes request = encode(wire::Open{.model = "cow"}).value();
    request.resize(request.size() / 2);
    send(request);
    finish_sending();
    EXPECT_EQ(read_all().bytes, 0U);
    EXPECT_EQ(summary().data_bytes, 0U);
}

TEST_F(SessionTest, ClientThatVanishesFreesItsPlace)
{
    start();
    open("cow");
    static_cast<void>(read(1000));
    client_.close();
    const auto end = summary();
    EXPECT_LT(end.data_bytes, file().size());
    EXPECT_EQ(ticket_.use_count(), 1);
}

TEST_F(SessionTest, ClientThatStopsReadingIsCutOff)
{
    settings_.idle_timeout = milliseconds(300);
    start();
    open("cow");
    EXPECT_EQ(summary().reason, "the client takes no data");
}

TEST_F(SessionTest, SlowReaderIsNotCutOff)
{
    settings_.idle_timeout = milliseconds(2000);
    stream_ = test::make_served_stream({900, 100'000}, 1);
    start();
    open("cow");
    Bytes received;
    // Takes longer in all than the idle timeout, but never pauses for as long.
    for (int i = 0; i < 10; ++i)
    {
        std::this_thread::sleep_for(milliseconds(250));
        received = test::joined(received, read(8'000));
    }
    finish_sending();
    Bytes rest;
    boost::system::error_code error;
    asio::read(client_, asio::dynamic_buffer(rest), error);
    EXPECT_EQ(test::understand(test::joined(received, rest)).data, file());
}

TEST_F(SessionTest, ClientThatNeverAsksIsTimedOut)
{
    settings_.handshake_timeout = milliseconds(50);
    start();
    send(wire::make_frame(FrameType::Ping, Bytes(proto::kPingBytes)));
    const auto talk = read_all();
    EXPECT_THAT(talk.frames, ElementsAre(FrameType::Pong, FrameType::Failure));
    EXPECT_EQ(talk.failures[0].code, static_cast<unsigned>(ErrorCode::Timeout));
}

TEST_F(SessionTest, SilenceDuringAPauseIsTimedOut)
{
    settings_.idle_timeout = milliseconds(200);
    start();
    send(
        test::joined(encode(wire::Open{.model = "cow"}).value(), wire::make_frame(FrameType::Pause))
    );
    EXPECT_EQ(read_all().failures.at(0).code, static_cast<unsigned>(ErrorCode::Timeout));
}

TEST_F(SessionTest, WaitingIsSentWhileAModelIsPrepared)
{
    settings_.waiting_interval = milliseconds(20);
    std::promise<std::function<void(Result<StreamPtr>)>> asked;
    settings_.find = [&asked](const std::string&, auto done) { asked.set_value(std::move(done)); };
    start();
    open("cow");
    const auto done = asked.get_future().get();
    EXPECT_EQ(read(4), wire::make_frame(FrameType::Waiting));
    EXPECT_EQ(read(4), wire::make_frame(FrameType::Waiting));
    done(stream_);
    finish_sending();
    EXPECT_EQ(read_all().data, file());
}

TEST_F(SessionTest, LookUpThatEndsAfterTheSessionIsHarmless)
{
    std::promise<std::function<void(Result<StreamPtr>)>> asked;
    settings_.find = [&asked](const std::string&, auto done) { asked.set_value(std::move(done)); };
    start();
    open("cow");
    const auto done = asked.get_future().get();
    session_->abort();
    static_cast<void>(summary());
    session_.reset();
    done(stream_);
    EXPECT_EQ(read_all().bytes, 0U);
}

TEST_F(SessionTest, FinishLetsTheTransferEnd)
{
    start();
    open("cow");
    const Bytes begin = read(1000);
    session_->finish();
    Bytes rest;
    boost::system::error_code error;
    asio::read(client_, asio::dynamic_buffer(rest), error);
    const auto talk = test::understand(test::joined(begin, rest));
    EXPECT_EQ(talk.data, file());
    EXPECT_EQ(talk.failures.at(0).code, static_cast<unsigned>(ErrorCode::Cancelled));
}

TEST_F(SessionTest, FinishClosesWhatIsIdle)
{
    start();
    session_->finish();
    const auto talk = read_all();
    EXPECT_THAT(talk.frames, ElementsAre(FrameType::Failure));
    EXPECT_TRUE(talk.failures[0].closing);
}

TEST_F(SessionTest, RefusedClientLearnsWhy)
{
    refusal_ = Error{ErrorCode::Overloaded, "full", 0};
    start();
    open("cow");
    const auto talk = read_all();
    EXPECT_THAT(talk.frames, ElementsAre(FrameType::Failure));
    EXPECT_EQ(talk.failures[0].code, static_cast<unsigned>(ErrorCode::Overloaded));
    client_.close();
    static_cast<void>(summary());
}

TEST_F(SessionTest, FileThatIsCutWhileItIsSentEndsTheSessionOnly)
{
    const test::TemporaryFolder folder;
    const auto path = folder.write("m.vsplit", file());
    StreamStore store;
    stream_ = store.open(path).value();
    start();
    send(
        test::joined(encode(wire::Open{.model = "cow"}).value(), wire::make_frame(FrameType::Pause))
    );
    std::filesystem::resize_file(path, 1000);
    send(wire::make_frame(FrameType::Resume));
    Bytes received;
    boost::system::error_code error;
    asio::read(client_, asio::dynamic_buffer(received), error);
    EXPECT_LT(received.size(), 100'000U);
    EXPECT_NE(summary().reason, "closed");
}

TEST_F(SessionTest, NothingOfItIsLeftAfterwards)
{
    start();
    session_.reset();
    EXPECT_FALSE(watch_.expired());
    client_.close();
    static_cast<void>(summary());
    for (int i = 0; i < 3000 && !watch_.expired(); ++i)
    {
        std::this_thread::sleep_for(milliseconds(10));
    }
    EXPECT_TRUE(watch_.expired());
}

}  // namespace
}  // namespace vsplit::net
