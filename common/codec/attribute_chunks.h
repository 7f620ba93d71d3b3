#pragma once

#include "codec/attribute_coder.h"
#include "codec/entropy_coder.h"
#include "codec/level_mesh.h"
#include "codec/stream_info.h"
#include "codec/take_memory.h"
#include "core/result.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>

namespace vsplit::codec {

/// A level that attributes stand behind.
struct AttributedLevel
{
    std::uint32_t level = 0;
    bool last = false;                  ///< No finer one comes.
    bool replaced = false;              ///< Its triangles have nothing to do with earlier levels'.
    std::function<LevelMesh()> copy{};  ///< Makes a copy of its mesh.
};

/// Decodes chunks of attributes, in their order. Not thread safe. Safe on untrusted input.
class AttributeChunks
{
public:
    /// Decodes one chunk. `info`: of the stream, must outlive this; `max_level`: as DecodeLimits'.
    /// Errors: BadChunk, LimitExceeded (there is not enough memory).
    [[nodiscard]] Result<void> decode(
        const StreamInfo& info,
        std::uint32_t max_level,
        std::uint8_t codec,
        std::span<const std::byte> bytes,
        const AttributedLevel& at
    )
    {
        Result<void> done;
        VSPLIT_TRY(take_memory([&] { start(info, max_level); }));
        BitDecoder bits;
        VSPLIT_TRY(bits.start(bytes));
        VSPLIT_TRY(take_memory([&] {
            done = codec == proto::kValuesCodec ? decode_values(bits, at)
                                                : decode_last(bits, codec, at);
        }));
        VSPLIT_TRY(done);
        return bits.finish();
    }

    /// True when nothing is begun that is not complete.
    [[nodiscard]] bool settled() const { return !coder_ || coder_->settled(); }

    /// Attributes of the last level that was completed; nullptr as long as there are none, or those of another
    /// level have begun.
    [[nodiscard]] const LevelAttributes* shown() const
    {
        return coder_ && coder_->has_level() && !coder_->in_level() ? &coder_->shown() : nullptr;
    }

private:
    void start(const StreamInfo& info, std::uint32_t max_level)
    {
        if (!coder_)
        {
            coder_ = std::make_unique<AttributeCoder>(
                info.attributes, WedgeCounts{info.wedge_count, info.vertex_count}
            );
            const StreamInfo last = prefix_info(info, max_level);
            coder_->reserve(last.vertex_count, last.face_count);
        }
    }

    Result<void> decode_values(BitDecoder& bits, const AttributedLevel& at)
    {
        if (!coder_->in_level())
        {
            if (level_ == at.level + 1ULL)
            {
                return fail(ErrorCode::BadChunk, "the attributes of a level come twice");
            }
            coder_->forget_mesh();
            VSPLIT_TRY(coder_->begin_level(bits, at.copy(), at.replaced, nullptr));
            level_ = at.level + 1ULL;
        }
        return coder_->code_values(bits, code_count(bits, 0));
    }

    /// Decodes what comes behind the values of the last level.
    Result<void> decode_last(BitDecoder& bits, std::uint8_t codec, const AttributedLevel& at)
    {
        if (!at.last || coder_->in_level() || level_ != at.level + 1ULL)
        {
            return fail(
                ErrorCode::BadChunk, "normals or bits come before the last level is complete"
            );
        }
        const std::uint32_t count = code_count(bits, 0);
        return codec == proto::kNormalsCodec ? coder_->code_normals(bits, count, {})
                                             : coder_->code_late_bits(bits, count);
    }

    std::unique_ptr<AttributeCoder> coder_;  ///< Once the first chunk came.
    std::uint64_t level_ = 0;                ///< One more than the one that attributes belong to.
};

}  // namespace vsplit::codec
