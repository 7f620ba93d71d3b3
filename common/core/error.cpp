#include "core/error.h"

namespace vsplit {

std::string_view error_name(ErrorCode code)
{
    switch (code)
    {
        case ErrorCode::Ok:
            return "ok";
        case ErrorCode::Truncated:
            return "truncated";
        case ErrorCode::BadMagic:
            return "bad-magic";
        case ErrorCode::UnsupportedVersion:
            return "unsupported-version";
        case ErrorCode::UnknownRequiredChunk:
            return "unknown-required-chunk";
        case ErrorCode::BadHeader:
            return "bad-header";
        case ErrorCode::BadChecksum:
            return "bad-checksum";
        case ErrorCode::BadChunk:
            return "bad-chunk";
        case ErrorCode::LimitExceeded:
            return "limit-exceeded";
        case ErrorCode::TrailingBytes:
            return "trailing-bytes";
        case ErrorCode::NotAMesh:
            return "not-a-mesh";
        case ErrorCode::UnsupportedInput:
            return "unsupported-input";
        case ErrorCode::EmptyMesh:
            return "empty-mesh";
        case ErrorCode::BadCoordinate:
            return "bad-coordinate";
        case ErrorCode::BadIndex:
            return "bad-index";
        case ErrorCode::InputTooLarge:
            return "input-too-large";
        case ErrorCode::NotFound:
            return "not-found";
        case ErrorCode::IoError:
            return "io-error";
        case ErrorCode::AlreadyExists:
            return "already-exists";
        case ErrorCode::BadRequest:
            return "bad-request";
        case ErrorCode::BadFrame:
            return "bad-frame";
        case ErrorCode::Timeout:
            return "timeout";
        case ErrorCode::Overloaded:
            return "overloaded";
        case ErrorCode::Cancelled:
            return "cancelled";
        case ErrorCode::ConnectionLost:
            return "connection-lost";
        case ErrorCode::EncodeFailed:
            return "encode-failed";
        case ErrorCode::ContentChanged:
            return "content-changed";
        case ErrorCode::Mismatch:
            return "mismatch";
        case ErrorCode::Internal:
            return "internal";
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
