#include "net/test_streams.h"

#include "codec/stream_header_writer.h"
#include "core/byte_writer.h"
#include "core/crc32c.h"
#include "core/file_io.h"

#include <algorithm>
#include <fstream>
#include <numeric>
#include <random>
#include <stdexcept>
#include <unistd.h>

namespace vsplit::test {
namespace {

Bytes noise(std::size_t count, std::mt19937& random)
{
    Bytes bytes(count);
    std::generate(bytes.begin(), bytes.end(), [&] { return static_cast<std::byte>(random()); });
    return bytes;
}

void note(ServerTalk& talk, const wire::Frame& frame)
{
    if (talk.frames.empty() || talk.frames.back() != frame.type ||
        frame.type != wire::FrameType::Data)
    {
        talk.frames.push_back(frame.type);
    }
    switch (frame.type)
    {
        case wire::FrameType::ModelInfo:
            talk.infos.push_back(wire::parse_model_info(frame.payload).value());
            break;
        case wire::FrameType::Done:
            talk.dones.push_back(wire::parse_done(frame.payload).value());
            break;
        case wire::FrameType::Failure:
            talk.failures.push_back(wire::parse_failure(frame.payload).value());
            break;
        case wire::FrameType::Data:
            talk.data.insert(talk.data.end(), frame.payload.begin(), frame.payload.end());
            break;
        default:
            break;
    }
}

}  // namespace

Bytes make_stream_file(const std::vector<std::uint32_t>& chunk_bytes, unsigned seed)
{
    std::mt19937 random(seed);
    codec::StreamInfo info;
    Bytes chunks;
    std::uint32_t vertices = 4;
    std::uint32_t faces = 4;
    double error = 1.0;
    for (const std::uint32_t count : chunk_bytes)
    {
        // Noise that ends in its checksum, as a chunk does; `count` bytes of noise besides.
        Bytes bytes = noise(count, random);
        ByteWriter checksum;
        checksum.write(crc32c(bytes));
        bytes.insert(bytes.end(), checksum.view().begin(), checksum.view().end());
        info.chunks.push_back(codec::ChunkInfo{
            .kind = info.chunks.empty() ? proto::ChunkKind::Base : proto::ChunkKind::Batch,
            .bytes = static_cast<std::uint32_t>(bytes.size()),
            .vertices = vertices,
            .faces = faces,
            .rms_error = error,
            .max_error = 2.0 * error,
        });
        info.vertex_count = vertices;
        info.face_count = faces;
        vertices += 10;
        faces += 20;
        error /= 2.0;
        chunks.insert(chunks.end(), bytes.begin(), bytes.end());
        info.content_checksum = crc32c(checksum.view(), info.content_checksum);
    }
    return joined(codec::write_stream_header(info, {100, 200, 300}), chunks);
}

net::StreamPtr make_served_stream(const std::vector<std::uint32_t>& chunk_bytes, unsigned seed)
{
    const auto bytes = std::make_shared<const Bytes>(make_stream_file(chunk_bytes, seed));
    auto info = codec::parse_stream_info(*bytes).value();
    const std::uint64_t id = wire::content_id(std::span(*bytes).first(info.header_bytes));
    return std::make_shared<const net::ServedStream>(net::ServedStream{
        *bytes, std::move(info), id, bytes});
}

TemporaryFolder::TemporaryFolder()
{
    std::string pattern =
        (std::filesystem::canonical(std::filesystem::temp_directory_path()) / "vsplit-XXXXXX")
            .string();
    if (::mkdtemp(pattern.data()) == nullptr)
    {
        throw std::runtime_error("cannot make a temporary folder");
    }
    path_ = pattern;
}

TemporaryFolder::~TemporaryFolder()
{
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

std::filesystem::path TemporaryFolder::write(
    const std::string& name, std::span<const std::byte> bytes
) const
{
    const auto path = path_ / name;
    std::filesystem::create_directories(path.parent_path());
    if (const auto written = write_file_atomically(path, bytes); !written)
    {
        throw std::runtime_error(describe(written.error()));
    }
    return path;
}

std::filesystem::path TemporaryFolder::write_program(
    const std::string& name, const std::string& text
) const
{
    const auto path = write(name, std::as_bytes(std::span(text)));
    std::filesystem::permissions(path, std::filesystem::perms::owner_all);
    return path;
}

ServerTalk understand(std::span<const std::byte> bytes)
{
    ServerTalk talk;
    talk.bytes = bytes.size();
    wire::FrameParser parser(wire::Sender::Server);
    while (true)
    {
        const auto frame = parser.next(bytes);
        if (!frame)
        {
            throw std::runtime_error(describe(frame.error()));
        }
        if (!*frame)
        {
            talk.complete = parser.at_boundary();
            return talk;
        }
        note(talk, **frame);
    }
}

Bytes joined(Bytes first, const Bytes& second)
{
    first.insert(first.end(), second.begin(), second.end());
    return first;
}

}  // namespace vsplit::test
