#pragma once

// The rows of the index, coded against what the rows before them promise. Reader and writer of the
// header run this same code; only the bit coder differs.

#include "codec/context_model.h"
#include "codec/error_scale.h"
#include "codec/float_log.h"
#include "codec/index_model.h"
#include "codec/small_base_limits.h"
#include "codec/split_cost.h"
#include "format.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

namespace vsplit::codec {

/// What one row of the index says.
struct IndexRow
{
    proto::ChunkKind kind = proto::ChunkKind::Batch;
    std::uint8_t codec = 0;
    std::uint32_t bytes = 0;  ///< Length of the chunk, checksum included.
    /// Base: of the mesh; Batch, Parts: that the chunk adds; first Growth chunk: of the complete mesh.
    std::uint32_t vertices = 0;
    std::uint32_t boundary = 0;  ///< Batch: how many of them split a boundary.
    std::uint32_t faces = 0;     ///< Base; Parts: that the chunk adds; Growth as below.
    int shift = 0;               ///< Base and first chunk of a level: the level's shift.
    std::uint32_t rms_code = 0;  ///< Base and last chunk of a level: its errors.
    std::uint32_t max_code = 0;
    std::uint32_t level_chunks = 0;    ///< First chunk of a level: chunks of the level.
    std::uint32_t level_vertices = 0;  ///< First chunk of a level: what the level adds.
    std::uint32_t tag = 0;             ///< Of optional kinds, see ChunkInfo.
    bool ends_parts = false;           ///< Parts: the last chunk of its level.
};

/// Codes row after row. `Coder`: BitEncoder or BitDecoder. Not thread safe. Safe on untrusted input.
template <typename Coder>
class IndexCoder
{
public:
    /// Starts before the first row; `coder` must outlive this.
    explicit IndexCoder(Coder& coder) : coder_(coder) {}

    /// Codes the first row, which is that of the base. Result: false when a value is out of range.
    [[nodiscard]] bool code_base(IndexRow& row)
    {
        row.kind = proto::ChunkKind::Base;
        row.codec = static_cast<std::uint8_t>(coder_.raw(row.codec, 2));
        row.vertices = code_number(row.vertices);
        const bool closed = row.faces + 4ULL == 2ULL * row.vertices;
        row.faces =
            coder_.raw(closed ? 1 : 0, 1) != 0 ? 2 * row.vertices - 4 : code_number(row.faces);
        row.bytes = code_number(row.bytes);
        row.shift = static_cast<int>(coder_.raw(static_cast<std::uint32_t>(row.shift), 5));
        row.rms_code = code_first_error(row.rms_code);
        row.max_code = code_first_error(row.max_code);
        vertices_ = row.vertices;
        level_start_ = row.vertices;
        level_vertices_ = row.vertices / 2;
        shift_ = row.shift;
        rms_code_ = row.rms_code;
        max_code_ = row.max_code;
        return row.vertices >= 3 && row.vertices <= proto::kMaxVertices && row.faces >= 1 &&
               row.faces <= proto::kMaxFaces && row.rms_code <= kZeroErrorCode &&
               row.max_code <= kZeroErrorCode;
    }

    /// Codes kind and codec of the next row: what followed the kind before the last time, or another.
    void code_kind(IndexRow& row)
    {
        const auto wanted =
            static_cast<std::uint32_t>(row.kind) << 8 | static_cast<std::uint32_t>(row.codec);
        std::uint32_t& expected = following_[last_kind_ >> 8];
        if (code_bit(coder_, model_.other_kind, wanted != expected))
        {
            expected = coder_.raw(wanted, 16);
        }
        last_kind_ = expected;
        row.kind = static_cast<proto::ChunkKind>(expected >> 8);
        row.codec = static_cast<std::uint8_t>(expected);
    }

    /// Codes the rest of the row of an optional chunk. Result: false when it is too long.
    [[nodiscard]] bool code_optional(IndexRow& row)
    {
        row.bytes = code_number(row.bytes);
        row.tag = code_number(row.tag);
        return row.bytes <= kMostBytes;
    }

    /// Codes the rest of the row of a Batch chunk. Result: false when a value is out of range.
    [[nodiscard]] bool code_batch(IndexRow& row)
    {
        if (grown_ || parts_open_ || (chunks_left_ == 0 && !code_level(row)))
        {
            return false;
        }
        const std::uint32_t refined =
            unrefined_ == 0 ? 0 : std::min(unrefined_, refined_per_chunk(drop_));
        unrefined_ -= refined;
        const std::uint64_t refinement = refinement_bits(refined, shift_ + drop_, drop_);
        if (unrefined_ > 0)
        {
            row.vertices = 0;
            row.boundary = 0;
        }
        if (unrefined_ > 0 ? chunks_left_ == 1 : !code_splits(row, refinement))
        {
            return false;
        }
        const std::uint32_t expected = cost_.chunk_bytes(row.vertices, refinement);
        if (!code_near(model_.bytes, row.bytes, expected, 4, kMostBytes))
        {
            return false;
        }
        cost_.observe(row.vertices, row.bytes, refinement);
        vertices_ += row.vertices;
        vertices_left_ -= row.vertices;
        --chunks_left_;
        return chunks_left_ > 0 || code_errors(row, level_start_, drop_);
    }

    /// Codes the rest of the row of a Parts chunk. Result: false when a value is out of range, a level of
    /// splits is open or the mesh has grown.
    [[nodiscard]] bool code_parts(IndexRow& row)
    {
        if (grown_ || chunks_left_ != 0)
        {
            return false;
        }
        parts_start_ = parts_open_ ? parts_start_ : vertices_;
        row.vertices = code_number(row.vertices);
        row.faces = code_number(row.faces);
        row.bytes = code_number(row.bytes);
        row.ends_parts = coder_.raw(row.ends_parts ? 1 : 0, 1) != 0;
        parts_open_ = !row.ends_parts;
        if (row.vertices < 3 || row.vertices > kMaxSmallBaseVertices || row.faces < 1 ||
            row.faces > kMaxSmallBaseFaces * row.vertices || row.bytes > kMostBytes ||
            row.vertices > proto::kMaxVertices - vertices_)
        {
            return false;
        }
        vertices_ += row.vertices;
        return parts_open_ || code_errors(row, parts_start_, 0);
    }

    /// Codes the rest of the row of a Growth chunk; the first one tells of the whole level.
    /// Result: false when a value is out of range, a level is open or the mesh has grown before.
    [[nodiscard]] bool code_growth(IndexRow& row)
    {
        const bool starts = chunks_left_ == 0;
        if (starts == grown_ || parts_open_)
        {
            return false;
        }
        if (starts)
        {
            grown_ = true;
            row.level_chunks = code_number(row.level_chunks);
            row.vertices = code_number(row.vertices);
            row.faces = code_number(row.faces);
            if (row.level_chunks < 1 || row.level_chunks > proto::kMaxChunks ||
                row.vertices < vertices_ || row.vertices > proto::kMaxVertices || row.faces < 1 ||
                row.faces > proto::kMaxFaces)
            {
                return false;
            }
            chunks_left_ = row.level_chunks;
            level_start_ = vertices_;
            vertices_ = row.vertices;
            if (!code_errors(row, level_start_, drop_))
            {
                return false;
            }
        }
        row.bytes = code_number(row.bytes);
        --chunks_left_;
        return row.bytes <= kMostBytes;
    }

    /// Tells whether the last row ended a level.
    [[nodiscard]] bool level_complete() const { return chunks_left_ == 0 && !parts_open_; }

    /// Codes a number below 2^31 of which nothing is known.
    [[nodiscard]] std::uint32_t code_number(std::uint32_t number)
    {
        const auto width =
            static_cast<int>(coder_.raw(static_cast<std::uint32_t>(std::bit_width(number)), 5));
        return width < 2 ? static_cast<std::uint32_t>(width)
                         : coder_.raw(number, width - 1) | 1U << (width - 1);
    }

private:
    /// Codes an error of the base: six bits hold all but those below 1/256 of the diagonal.
    std::uint32_t code_first_error(std::uint32_t code)
    {
        constexpr std::uint32_t kSmall = 63;
        const std::uint32_t low = coder_.raw(std::min(code, kSmall), 6);
        return low < kSmall ? low : coder_.raw(code, 9);
    }

    static constexpr std::uint32_t kMostBytes = 1U << 28;

    /// Codes a number near to what is expected of it, in steps of 2^-`fineness` of that; the rest raw.
    [[nodiscard]] bool code_near(
        IntegerModel& model,
        std::uint32_t& number,
        std::uint32_t expected,
        int fineness,
        std::uint32_t most
    )
    {
        const int raw = std::max(0, static_cast<int>(std::bit_width(expected)) - fineness);
        const auto difference =
            static_cast<std::int32_t>(number >> raw) - static_cast<std::int32_t>(expected >> raw);
        const std::int64_t steps =
            std::int64_t{expected >> raw} + code_integer(coder_, model, difference, 0);
        const std::int64_t value = steps * (std::int64_t{1} << raw) + coder_.raw(number, raw);
        number = static_cast<std::uint32_t>(std::clamp<std::int64_t>(value, 0, most));
        return value == number;
    }

    /// Codes what is said at the start of a level.
    [[nodiscard]] bool code_level(IndexRow& row)
    {
        const auto chunks = static_cast<std::int32_t>(row.level_chunks) - level_chunks_;
        level_chunks_ += code_integer(coder_, model_.level_chunks, chunks, 0);
        if (level_chunks_ < 1 || level_chunks_ > static_cast<std::int32_t>(proto::kMaxChunks))
        {
            return false;
        }
        const std::uint64_t expected =
            std::uint64_t{level_vertices_} * vertices_ / std::max(1U, level_start_);
        const std::uint32_t most = proto::kMaxVertices - vertices_;
        const auto guess = static_cast<std::uint32_t>(std::min<std::uint64_t>(expected, most));
        if (!code_near(model_.level_vertices, row.level_vertices, guess, 16, most))
        {
            return false;
        }
        const std::int32_t drop = code_integer(coder_, model_.drop, shift_ - row.shift, 2);
        if (drop < 0 || drop > shift_)
        {
            return false;
        }
        cost_.expect_drop(drop);
        shift_ -= drop;
        drop_ = drop;
        unrefined_ = drop > 0 ? vertices_ : 0;
        level_start_ = vertices_;
        level_vertices_ = row.level_vertices;
        chunks_left_ = static_cast<std::uint32_t>(level_chunks_);
        vertices_left_ = level_vertices_;
        row.shift = shift_;
        row.level_chunks = chunks_left_;
        return true;
    }

    [[nodiscard]] bool code_splits(IndexRow& row, std::uint64_t refinement)
    {
        if (chunks_left_ == 1)
        {
            row.vertices = vertices_left_;
        }
        else if (!code_near(
                     model_.vertices,
                     row.vertices,
                     cost_.next_share(vertices_left_, chunks_left_, refinement),
                     16,
                     vertices_left_
                 ))
        {
            return false;
        }
        if (!code_bit(coder_, model_.has_boundary, row.boundary != 0))
        {
            row.boundary = 0;
            return true;
        }
        const std::uint64_t expected = std::uint64_t{row.vertices} * boundary_ / boundary_of_;
        boundary_of_ = std::max(1U, row.vertices);
        const bool good = code_near(
            model_.boundary,
            row.boundary,
            static_cast<std::uint32_t>(std::min<std::uint64_t>(expected, row.vertices)),
            3,
            row.vertices
        );
        boundary_ = row.boundary;
        return good;
    }

    /// Codes an error code near to what is expected of it.
    [[nodiscard]] bool code_error(
        IntegerModel& model, std::uint32_t& code, std::int32_t expected, std::size_t context
    )
    {
        expected = clamp_int(expected, 0, static_cast<std::int32_t>(kZeroErrorCode));
        const std::int32_t value =
            expected +
            code_integer(coder_, model, static_cast<std::int32_t>(code) - expected, context);
        code = static_cast<std::uint32_t>(value);
        return value >= 0 && value <= static_cast<std::int32_t>(kZeroErrorCode);
    }

    /// Codes the errors of a level that started with `start` vertices and `drop` bits of precision more.
    [[nodiscard]] bool code_errors(IndexRow& row, std::uint32_t start, int drop)
    {
        const auto log = [](std::uint32_t count) {
            return steps_log2<3>(static_cast<float>(count));
        };
        const auto before = static_cast<std::int32_t>(rms_code_);
        const std::int32_t expected = before + log(vertices_) - log(start);
        if (!code_error(model_.rms, row.rms_code, expected, drop > 0 ? 1 : 0))
        {
            return false;
        }
        rms_code_ = row.rms_code;
        const std::int32_t step = static_cast<std::int32_t>(rms_code_) - before;
        if (!code_error(
                model_.maximum, row.max_code, static_cast<std::int32_t>(max_code_) + step, 0
            ))
        {
            return false;
        }
        max_code_ = row.max_code;
        return true;
    }

    Coder& coder_;
    IndexModel model_;
    SplitCost cost_;
    std::uint32_t last_kind_ = 0;  ///< Of the row before, 256 * kind + codec; the base has 0.
    std::array<std::uint32_t, 256> following_ = first_followers();  ///< By kind, the last time.
    std::uint32_t vertices_ = 0;                                    ///< After the last row.
    std::uint32_t level_start_ = 0;     ///< Vertices when the level started.
    std::uint32_t level_vertices_ = 0;  ///< Splits of the level.
    std::uint32_t vertices_left_ = 0;   ///< Of them to come.
    std::uint32_t chunks_left_ = 0;     ///< Of the level.
    std::int32_t level_chunks_ = 1;
    std::uint32_t boundary_ = 1;     ///< Of the last chunk that had any
    std::uint32_t boundary_of_ = 4;  ///< and its splits.
    int shift_ = 0;
    int drop_ = 0;                 ///< Bits of precision that the level's start adds.
    std::uint32_t unrefined_ = 0;  ///< Vertices that lack them.
    bool grown_ = false;
    bool parts_open_ = false;        ///< More Parts chunks of the level are to come.
    std::uint32_t parts_start_ = 0;  ///< Vertices when a level of parts started.
    std::uint32_t rms_code_ = 0;
    std::uint32_t max_code_ = 0;
};

}  // namespace vsplit::codec
