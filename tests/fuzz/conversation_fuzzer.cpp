// Lets a hostile client talk to the server's side of a connection. The first byte is the number of bytes
// that arrive at a time; between two arrivals the server answers and sends.

#include "net/conversation.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <span>

namespace {

using namespace vsplit;

/// No answer to one arrival may be longer than a data frame and a screenful of control messages.
constexpr std::size_t kMaxOutputBytes = proto::kSentDataBytes + 16384;

net::StreamPtr make_stream()
{
    static const std::array<std::byte, 100'000> bytes{};
    net::ServedStream stream;
    stream.bytes = bytes;
    stream.content_id = 1;
    stream.info.header_bytes = 100;
    stream.info.file_bytes = bytes.size();
    std::uint64_t offset = stream.info.header_bytes;
    for (std::uint32_t level = 0; offset < bytes.size(); ++level)
    {
        const std::uint64_t chunk = std::min<std::uint64_t>(30'000, bytes.size() - offset);
        const double error = 1.0 / (level + 1);
        stream.info.chunks.push_back({
            .kind = level == 0 ? proto::ChunkKind::Base : proto::ChunkKind::Batch,
            .offset = offset,
            .bytes = static_cast<std::uint32_t>(chunk),
            .faces = 20 * (level + 1),
            .rms_error = error,
        });
        offset += chunk;
        stream.info.levels.push_back({
            .level = level,
            .faces = 20 * (level + 1),
            .cumulative_bytes = offset,
            .rms_error = error,
        });
    }
    return std::make_shared<const net::ServedStream>(std::move(stream));
}

void answer_and_send(net::Conversation& conversation, const net::StreamPtr& stream)
{
    if (const auto request = conversation.take_request())
    {
        const bool known = request->open.model.size() % 2 == 1;
        conversation.answer(
            request->number,
            known ? Result<net::StreamPtr>(stream) : fail(ErrorCode::NotFound, request->open.model)
        );
    }
    conversation.report_waiting();
    const net::Output output = conversation.next_output();
    if (output.head.size() + output.body.size() > kMaxOutputBytes)
    {
        std::abort();
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    static const net::StreamPtr stream = make_stream();
    if (size == 0)
    {
        return 0;
    }
    net::Conversation conversation;
    const std::size_t step = 1 + data[0];
    std::span<const std::byte> input = std::as_bytes(std::span(data, size)).subspan(1);
    while (!input.empty())
    {
        const auto piece = input.first(std::min(step, input.size()));
        input = input.subspan(piece.size());
        conversation.receive(piece);
        answer_and_send(conversation, stream);
    }
    return 0;
}
