#include "wire/message.h"

#include "messages_generated.h"
#include "wire/frame.h"

#include <flatbuffers/flatbuffers.h>
#include <flatbuffers/util.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

namespace vsplit::wire {
namespace {

/// Every FlatBuffers builder ends on this boundary, so a payload that does not was cut.
constexpr std::size_t kPayloadUnit = 4;
constexpr flatbuffers::uoffset_t kMaxDepth = 4;
constexpr flatbuffers::uoffset_t kMaxTables = 4;

tl::unexpected<Error> bad(std::string message)
{
    return fail(ErrorCode::BadRequest, std::move(message));
}

/// A verified table and the aligned copy it lives in; FlatBuffers reads scalars in place, and some
/// processors fault on unaligned ones.
template <typename Table>
class Payload
{
public:
    [[nodiscard]] Result<const Table*> open(std::span<const std::byte> payload)
    {
        if (payload.size() > bytes_.size() || payload.size() % kPayloadUnit != 0 || payload.empty())
        {
            return bad("a message has an impossible length");
        }
        std::copy(payload.begin(), payload.end(), bytes_.begin());
        const auto* const data = reinterpret_cast<const std::uint8_t*>(bytes_.data());
        flatbuffers::Verifier verifier(data, payload.size(), kMaxDepth, kMaxTables);
        if (!verifier.VerifyBuffer<Table>(nullptr))
        {
            return bad("a message is malformed");
        }
        return flatbuffers::GetRoot<Table>(data);
    }

private:
    alignas(8) std::array<std::byte, proto::kMaxControlBytes> bytes_{};
};

std::vector<std::byte> finish(FrameType type, const flatbuffers::FlatBufferBuilder& builder)
{
    return make_frame(
        type, std::as_bytes(std::span(builder.GetBufferPointer(), builder.GetSize()))
    );
}

std::string text_of(const flatbuffers::String* text)
{
    return text == nullptr ? "" : text->str();
}

Result<void> check(const Open& open)
{
    if (open.model.empty() || !is_valid_text(open.model))
    {
        return bad("the model name must be 1 to 255 bytes of printable UTF-8");
    }
    if (!is_valid_text(open.client))
    {
        return bad("the client name must be at most 255 bytes of printable UTF-8");
    }
    if (open.min_version == 0 || open.min_version > open.max_version)
    {
        return bad("the range of protocol versions is empty");
    }
    if (!std::isfinite(open.stop.error) || open.stop.error < 0.0)
    {
        return bad("the error to stop at must be finite and not negative");
    }
    if (open.stop.error_unit > ErrorUnit::DiagonalPercent)
    {
        return bad("the unit of the error to stop at is unknown");
    }
    if (open.start > 0 && open.content_id == 0)
    {
        return bad("a start offset needs the id of the content it belongs to");
    }
    return {};
}

}  // namespace

Result<std::vector<std::byte>> encode(const Open& open)
{
    VSPLIT_TRY(check(open));
    flatbuffers::FlatBufferBuilder builder(512);
    const auto model = builder.CreateString(open.model);
    const auto client = open.client.empty() ? flatbuffers::Offset<flatbuffers::String>()
                                            : builder.CreateString(open.client);
    fb::OpenBuilder table(builder);
    table.add_model(model);
    if (!client.IsNull())
    {
        table.add_client(client);
    }
    table.add_min_version(open.min_version);
    table.add_max_version(open.max_version);
    table.add_start(open.start);
    table.add_content_id(open.content_id);
    table.add_stop_level(open.stop.level);
    table.add_stop_bytes(open.stop.bytes);
    table.add_stop_faces(open.stop.faces);
    table.add_stop_error(open.stop.error);
    table.add_stop_error_unit(static_cast<fb::ErrorUnit>(open.stop.error_unit));
    table.add_screen_width(open.screen_width);
    table.add_screen_height(open.screen_height);
    table.add_memory_bytes(open.memory_bytes);
    table.add_max_texture_size(open.max_texture_size);
    builder.Finish(table.Finish());
    return finish(FrameType::Open, builder);
}

std::vector<std::byte> encode(const ModelInfo& info)
{
    flatbuffers::FlatBufferBuilder builder(128);
    const fb::Content content(info.content_id, info.file_bytes, info.end);
    builder.Finish(fb::CreateModelInfo(builder, &content, info.version, info.start));
    return finish(FrameType::ModelInfo, builder);
}

std::vector<std::byte> encode(const Done& done)
{
    flatbuffers::FlatBufferBuilder builder(64);
    builder.Finish(fb::CreateDone(builder, static_cast<fb::DoneReason>(done.reason)));
    return finish(FrameType::Done, builder);
}

std::vector<std::byte> encode(const Failure& failure)
{
    std::string message = failure.message.substr(0, proto::kMaxTextBytes);
    if (!is_valid_text(message))
    {
        const auto unprintable = [](char c) { return c < ' ' || c > '~'; };
        std::replace_if(message.begin(), message.end(), unprintable, '?');
    }
    flatbuffers::FlatBufferBuilder builder(512);
    const auto text = builder.CreateString(message);
    builder.Finish(fb::CreateFailure(builder, failure.code, text, failure.closing));
    return finish(FrameType::Failure, builder);
}

Result<Open> parse_open(std::span<const std::byte> payload)
{
    Payload<fb::Open> storage;
    const auto table = storage.open(payload);
    VSPLIT_TRY(table);
    const fb::Open& fields = **table;
    Open open;
    open.model = text_of(fields.model());
    open.client = text_of(fields.client());
    open.min_version = fields.min_version();
    open.max_version = fields.max_version();
    open.start = fields.start();
    open.content_id = fields.content_id();
    open.stop = StopRequest{
        .level = fields.stop_level(),
        .bytes = fields.stop_bytes(),
        .faces = fields.stop_faces(),
        .error = fields.stop_error(),
        .error_unit = static_cast<ErrorUnit>(fields.stop_error_unit()),
    };
    open.screen_width = fields.screen_width();
    open.screen_height = fields.screen_height();
    open.memory_bytes = fields.memory_bytes();
    open.max_texture_size = fields.max_texture_size();
    VSPLIT_TRY(check(open));
    return open;
}

Result<ModelInfo> parse_model_info(std::span<const std::byte> payload)
{
    Payload<fb::ModelInfo> storage;
    const auto table = storage.open(payload);
    VSPLIT_TRY(table);
    const fb::Content& content = *(*table)->content();
    const ModelInfo info{
        .version = (*table)->version(),
        .content_id = content.id(),
        .file_bytes = content.file_bytes(),
        .start = (*table)->start(),
        .end = content.end(),
    };
    if (info.version == 0 || info.content_id == 0 || info.end > info.file_bytes ||
        info.start > info.file_bytes)
    {
        return bad("the server's description of the model contradicts itself");
    }
    return info;
}

Result<Done> parse_done(std::span<const std::byte> payload)
{
    Payload<fb::Done> storage;
    const auto table = storage.open(payload);
    VSPLIT_TRY(table);
    const auto reason = static_cast<DoneReason>((*table)->reason());
    if (reason > DoneReason::Cancelled)
    {
        return bad("the server ended the transfer for an unknown reason");
    }
    return Done{reason};
}

Result<Failure> parse_failure(std::span<const std::byte> payload)
{
    Payload<fb::Failure> storage;
    const auto table = storage.open(payload);
    VSPLIT_TRY(table);
    Failure failure{(*table)->code(), text_of((*table)->message()), (*table)->closing()};
    if (failure.code == 0 || !is_valid_text(failure.message))
    {
        return bad("the server's failure message is malformed");
    }
    return failure;
}

Error to_error(const Failure& failure)
{
    const auto code = static_cast<ErrorCode>(failure.code);
    const bool known = error_name(code) != "unknown";
    std::string message = failure.message.empty() ? "the server gave no reason" : failure.message;
    if (!known)
    {
        message += " (code " + std::to_string(failure.code) + ")";
    }
    return Error{known ? code : ErrorCode::Internal, std::move(message), 0};
}

Result<std::uint16_t> negotiate_version(const Open& open)
{
    if (open.min_version > proto::kWireVersion || open.max_version < proto::kWireVersion)
    {
        return fail(
            ErrorCode::UnsupportedVersion,
            "the client speaks protocol versions " + std::to_string(open.min_version) + " to " +
                std::to_string(open.max_version) + ", the server " +
                std::to_string(proto::kWireVersion)
        );
    }
    return proto::kWireVersion;
}

bool is_valid_text(std::string_view text)
{
    if (text.size() > proto::kMaxTextBytes)
    {
        return false;
    }
    // FromUTF8 may look past a cut sequence, up to the terminating NUL that a std::string has.
    const std::string terminated(text);
    const char* position = terminated.data();
    const char* const end = position + terminated.size();
    while (position < end)
    {
        const int code_point = flatbuffers::FromUTF8(&position);
        const bool control = code_point < 0x20 || (code_point >= 0x7F && code_point < 0xA0);
        if (control)
        {
            return false;
        }
    }
    return position == end;
}

std::uint64_t content_id(std::span<const std::byte> header)
{
    constexpr std::uint64_t kOffsetBasis = 0xCBF29CE484222325U;
    constexpr std::uint64_t kPrime = 0x00000100000001B3U;
    std::uint64_t hash = kOffsetBasis;
    for (const std::byte byte : header)
    {
        hash = (hash ^ static_cast<std::uint64_t>(byte)) * kPrime;
    }
    return hash == 0 ? 1 : hash;
}

}  // namespace vsplit::wire
