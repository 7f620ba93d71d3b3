#include "core/error.h"

#include <array>
#include <utility>

namespace vsplit {

namespace {

constexpr std::array<std::pair<ErrorCode, std::string_view>, 29> kNames{{
    {ErrorCode::Ok, "ok"},
    {ErrorCode::Truncated, "truncated"},
    {ErrorCode::BadMagic, "bad-magic"},
    {ErrorCode::UnsupportedVersion, "unsupported-version"},
    {ErrorCode::UnknownRequiredChunk, "unknown-required-chunk"},
    {ErrorCode::BadHeader, "bad-header"},
    {ErrorCode::BadChecksum, "bad-checksum"},
    {ErrorCode::BadChunk, "bad-chunk"},
    {ErrorCode::LimitExceeded, "limit-exceeded"},
    {ErrorCode::TrailingBytes, "trailing-bytes"},
    {ErrorCode::NotAMesh, "not-a-mesh"},
    {ErrorCode::UnsupportedInput, "unsupported-input"},
    {ErrorCode::EmptyMesh, "empty-mesh"},
    {ErrorCode::BadCoordinate, "bad-coordinate"},
    {ErrorCode::BadIndex, "bad-index"},
    {ErrorCode::InputTooLarge, "input-too-large"},
    {ErrorCode::NotFound, "not-found"},
    {ErrorCode::IoError, "io-error"},
    {ErrorCode::AlreadyExists, "already-exists"},
    {ErrorCode::BadRequest, "bad-request"},
    {ErrorCode::BadFrame, "bad-frame"},
    {ErrorCode::Timeout, "timeout"},
    {ErrorCode::Overloaded, "overloaded"},
    {ErrorCode::Cancelled, "cancelled"},
    {ErrorCode::ConnectionLost, "connection-lost"},
    {ErrorCode::EncodeFailed, "encode-failed"},
    {ErrorCode::ContentChanged, "content-changed"},
    {ErrorCode::Mismatch, "mismatch"},
    {ErrorCode::Internal, "internal"},
}};

}  // namespace

std::string_view error_name(ErrorCode code)
{
    for (const auto& [known, name] : kNames)
    {
        if (known == code)
        {
            return name;
        }
    }
    return "unknown";
}

int exit_status(ErrorCode code)
{
    const auto number = static_cast<int>(code);
    if (number == 0)
    {
        return 0;
    }
    if (number < 20)
    {
        return 4;
    }
    if (number < 40)
    {
        return 3;
    }
    if (number < 60)
    {
        return 5;
    }
    if (number < 80)
    {
        return 6;
    }
    return code == ErrorCode::Mismatch ? 7 : 1;
}

std::string describe(const Error& error)
{
    std::string line = std::string(error_name(error.code)) + ": " + error.message;
    if (error.offset > 0)
    {
        line += " (at byte " + std::to_string(error.offset) + ")";
    }
    return line;
}

}  // namespace vsplit
