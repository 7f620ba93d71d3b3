// Based on: Duda, "Asymmetric numeral systems", 2013, in Draco's implementation (rABS).
#include "codec/entropy_coder.h"

#include <limits>

namespace vsplit::codec {
std::uint32_t BitEncoder::raw(std::uint32_t value, int count)
{
    const std::uint32_t kept = value & static_cast<std::uint32_t>((1ULL << count) - 1ULL);
    pending_ |= std::uint64_t{kept} << pending_bits_;
    pending_bits_ += count;
    while (pending_bits_ >= 8)
    {
        raw_.push_back(static_cast<std::byte>(pending_ & 0xFFU));
        pending_ >>= 8;
        pending_bits_ -= 8;
    }
    return kept;
}

void BitEncoder::append(const BitEncoder& other)
{
    modelled_.insert(modelled_.end(), other.modelled_.begin(), other.modelled_.end());
    for (const std::byte byte : other.raw_)
    {
        raw(static_cast<std::uint32_t>(byte), 8);
    }
    raw(static_cast<std::uint32_t>(other.pending_), other.pending_bits_);
}

void BitEncoder::finish(ByteWriter& out)
{
    if (pending_bits_ > 0)
    {
        raw_.push_back(static_cast<std::byte>(pending_ & 0xFFU));
    }
    // A modelled bit costs at most eight bits; the state adds at most three bytes.
    std::vector<std::uint8_t> buffer(modelled_.size() + 8);
    draco::AnsCoder coder;
    draco::ans_write_init(&coder, buffer.data());
    for (auto symbol = modelled_.rbegin(); symbol != modelled_.rend(); ++symbol)
    {
        draco::rabs_desc_write(&coder, *symbol & 1, static_cast<draco::AnsP8>(*symbol >> 1));
    }
    const auto length = static_cast<std::size_t>(draco::ans_write_end(&coder));
    out.write_bytes(raw_);
    out.write_bytes(std::as_bytes(std::span(buffer).first(length)));
    modelled_.clear();
    raw_.clear();
    pending_ = 0;
    pending_bits_ = 0;
}

Result<void> BitDecoder::start(std::span<const std::byte> bytes)
{
    raw_ = bytes;
    raw_position_ = 0;
    pending_ = 0;
    pending_bits_ = 0;
    constexpr auto kMost = static_cast<std::size_t>(std::numeric_limits<int>::max());
    if (bytes.empty() || bytes.size() > kMost ||
        draco::ans_read_init(
            &ans_,
            reinterpret_cast<const std::uint8_t*>(bytes.data()),
            static_cast<int>(bytes.size())
        ) != 0)
    {
        return fail(ErrorCode::BadChunk, "the modelled bits do not start");
    }
    return {};
}

Result<void> BitDecoder::finish() const
{
    draco::AnsDecoder ans = ans_;
    // A byte is taken in only when the next bit asks for it; after a bit of the least probability the
    // last byte is still there.
    if (ans.state < kLeastAnsState && ans.buf_offset > 0)
    {
        ans.state = ans.state << 8 | ans.buf[--ans.buf_offset];
    }
    if (raw_position_ != static_cast<std::size_t>(ans.buf_offset) || pending_ != 0 ||
        draco::ans_read_end(&ans) == 0)
    {
        return fail(ErrorCode::BadChunk, "a chunk does not end where its contents do");
    }
    return {};
}

}  // namespace vsplit::codec
