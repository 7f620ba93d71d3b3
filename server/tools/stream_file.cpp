#include "stream_file.h"

#include "report.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <span>
#include <string>
#include <system_error>
#include <utility>

namespace vsplit::tools {
namespace {

constexpr std::size_t kBufferBytes = 64U * 1024U;

Error named(const std::filesystem::path& path, const Error& error)
{
    return Error{error.code, path.string() + ": " + error.message, error.offset};
}

/// Feeds what one unit of the stream wants and does the work that it allows; returns the bytes taken.
Result<std::size_t> feed_and_step(
    codec::StreamDecoder& decoder,
    std::span<const std::byte> bytes,
    double& seconds,
    const StreamFile::StepSink& sink
)
{
    Stopwatch watch;
    const auto taken = decoder.feed(bytes);
    VSPLIT_TRY(taken);
    if (*taken == 0)
    {
        return fail(ErrorCode::TrailingBytes, "bytes follow the end of the stream");
    }
    auto step = decoder.step();
    seconds += watch.lap();
    while (step && step->kind != codec::StepKind::NeedBytes &&
           step->kind != codec::StepKind::Complete)
    {
        if (sink)
        {
            VSPLIT_TRY(sink(*step));
        }
        watch.lap();
        step = decoder.step();
        seconds += watch.lap();
    }
    VSPLIT_TRY(step);
    return *taken;
}

}  // namespace

Result<StreamFile> StreamFile::open(const std::filesystem::path& path)
{
    std::error_code ignored;
    const auto status = std::filesystem::status(path, ignored);
    if (status.type() == std::filesystem::file_type::not_found)
    {
        return fail(ErrorCode::NotFound, "there is no file " + path.string());
    }
    if (!std::filesystem::is_regular_file(status))
    {
        return fail(ErrorCode::IoError, path.string() + " is not a regular file");
    }
    StreamFile stream;
    stream.path_ = path;
    stream.file_.reset(std::fopen(path.c_str(), "rb"));
    if (!stream.file_)
    {
        return fail(
            ErrorCode::IoError, "cannot read " + path.string() + ": " + std::strerror(errno)
        );
    }
    stream.size_ = std::filesystem::file_size(path, ignored);
    stream.buffer_.resize(kBufferBytes);
    auto info = stream.read_info();
    if (!info)
    {
        return tl::unexpected<Error>(named(path, info.error()));
    }
    stream.info_ = std::move(*info);
    return stream;
}

Result<std::size_t> StreamFile::read(std::uint64_t offset, std::span<std::byte> out)
{
    const bool sought = ::fseeko(file_.get(), static_cast<off_t>(offset), SEEK_SET) == 0;
    const std::size_t count = sought ? std::fread(out.data(), 1, out.size(), file_.get()) : 0;
    if (!sought || std::ferror(file_.get()) != 0)
    {
        return fail(
            ErrorCode::IoError, "cannot read " + path_.string() + ": " + std::strerror(errno)
        );
    }
    return count;
}

Result<codec::StreamInfo> StreamFile::read_info()
{
    std::vector<std::byte> header(codec::header_probe_bytes());
    const auto probed = read(0, header);
    VSPLIT_TRY(probed);
    header.resize(*probed);
    const auto length = codec::parse_header_bytes(header);
    VSPLIT_TRY(length);
    // The length is within DecodeLimits, and no more than the file holds is allocated for.
    header.resize(static_cast<std::size_t>(std::min<std::uint64_t>(*length, size_)));
    const auto count = read(0, header);
    VSPLIT_TRY(count);
    header.resize(*count);
    return codec::parse_stream_info(header);
}

Result<std::uint64_t> StreamFile::complete_prefix() const
{
    const std::uint64_t base_end = info_.levels.front().cumulative_bytes;
    if (size_ < base_end)
    {
        return fail(
            ErrorCode::Truncated,
            path_.string() + " has " + std::to_string(size_) +
                " bytes, but its base mesh ends at " + std::to_string(base_end)
        );
    }
    return codec::stop_offset(info_, {.bytes = size_});
}

Result<void> StreamFile::decode(
    codec::StreamDecoder& decoder, std::uint64_t bytes, double& seconds, const StepSink& sink
)
{
    std::uint64_t offset = 0;
    while (offset < bytes)
    {
        const auto wanted =
            static_cast<std::size_t>(std::min<std::uint64_t>(buffer_.size(), bytes - offset));
        const auto count = read(offset, std::span(buffer_).first(wanted));
        VSPLIT_TRY(count);
        if (*count == 0)
        {
            return fail(ErrorCode::Truncated, path_.string() + " became shorter meanwhile", offset);
        }
        auto rest = std::span<const std::byte>(buffer_).first(*count);
        offset += rest.size();
        while (!rest.empty())
        {
            const auto taken = feed_and_step(decoder, rest, seconds, sink);
            if (!taken)
            {
                return tl::unexpected<Error>(named(path_, taken.error()));
            }
            rest = rest.subspan(*taken);
        }
    }
    return {};
}

}  // namespace vsplit::tools
