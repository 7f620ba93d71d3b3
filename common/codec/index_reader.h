#pragma once

#include "codec/entropy_coder.h"
#include "codec/error_scale.h"
#include "codec/index_coder.h"
#include "codec/stream_info.h"
#include "core/byte_reader.h"
#include "core/crc32c.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

namespace vsplit::codec {

/// Reads the rows of the index one after another into the table of chunks.
class IndexReader
{
public:
    /// Reads from `bits` into `info`, whose grid and box are known; all must outlive this.
    IndexReader(BitDecoder& bits, StreamInfo& info, const DecodeLimits& limits)
        : bits_(bits), index_(bits), info_(info), limits_(limits), diagonal_(info.diagonal())
    {
    }

    /// Reads all rows. Errors: BadHeader, UnknownRequiredChunk, LimitExceeded. Safe on untrusted input.
    Result<void> run()
    {
        const std::uint32_t count = index_.code_number(0);
        if (count < 1 || count > proto::kMaxChunks)
        {
            return fail(ErrorCode::BadHeader, "the header's chunk count is out of range");
        }
        info_.file_bytes = info_.header_bytes;
        // Rows can take less than a bit, so the table grows as rows are really there.
        while (info_.chunks.size() < count)
        {
            VSPLIT_TRY(read_row());
            if (bits_.exhausted())
            {
                return fail(ErrorCode::BadHeader, "the index ends too early");
            }
        }
        return index_.level_complete()
                   ? Result<void>{}
                   : fail(ErrorCode::BadHeader, "the last level is never completed");
    }

private:
    Result<void> read_row()
    {
        IndexRow row;
        const bool base = info_.chunks.empty();
        if (!base)
        {
            index_.code_kind(row);
        }
        VSPLIT_TRY(check_kind(row));
        const bool optional = is_optional(row.kind);
        if (optional ? !index_.code_optional(row) : !code_required(row, base))
        {
            return fail(ErrorCode::BadHeader, "a row of the index is out of range");
        }
        if (base && row.codec > proto::kSmallBaseCodec)
        {
            return unknown_chunk(row);
        }
        if (row.bytes > limits_.max_chunk_bytes)
        {
            return fail(ErrorCode::LimitExceeded, "a chunk is longer than the limit allows");
        }
        if (row.kind == proto::ChunkKind::Growth)
        {
            VSPLIT_TRY(take_growth(row));
        }
        else if (!optional)
        {
            VSPLIT_TRY(take(row));
        }
        add_chunk(row);
        return {};
    }

    bool code_required(IndexRow& row, bool base)
    {
        if (base)
        {
            return index_.code_base(row);
        }
        switch (row.kind)
        {
            case proto::ChunkKind::Growth:
                return index_.code_growth(row);
            case proto::ChunkKind::Parts:
                return index_.code_parts(row);
            default:
                return index_.code_batch(row);
        }
    }

    static tl::unexpected<Error> unknown_chunk(const IndexRow& row)
    {
        return fail(
            ErrorCode::UnknownRequiredChunk,
            "the stream needs chunk kind " + std::to_string(static_cast<int>(row.kind)) +
                " codec " + std::to_string(row.codec) + ", which this version does not know"
        );
    }

    /// Checks the kind of any row but the base's.
    static Result<void> check_kind(const IndexRow& row)
    {
        const bool known = row.kind == proto::ChunkKind::Batch ||
                           row.kind == proto::ChunkKind::Growth ||
                           row.kind == proto::ChunkKind::Parts;
        if (is_optional(row.kind) || (known && row.codec == 0))
        {
            return {};
        }
        if (row.kind == proto::ChunkKind::Base)
        {
            return fail(
                ErrorCode::BadHeader, "the base mesh must be the first chunk and only there"
            );
        }
        return unknown_chunk(row);
    }

    /// Adds up vertices and faces.
    Result<void> take(const IndexRow& row)
    {
        const bool base = info_.chunks.empty();
        if (base && row.shift >= info_.grid.bits)
        {
            return fail(ErrorCode::BadHeader, "the base mesh has no precision");
        }
        const std::uint64_t faces = row.kind == proto::ChunkKind::Batch
                                        ? last_.faces + 2ULL * row.vertices - row.boundary
                                        : std::uint64_t{last_.faces} + row.faces;
        last_.vertices += row.vertices;
        if (faces > proto::kMaxFaces)
        {
            return fail(ErrorCode::BadHeader, "the index adds up to too many faces");
        }
        if (last_.vertices > limits_.max_vertices || faces > limits_.max_faces)
        {
            return fail(ErrorCode::LimitExceeded, "the mesh is larger than the limit allows");
        }
        last_.faces = static_cast<std::uint32_t>(faces);
        last_.ends_level = index_.level_complete();
        if (base || row.level_chunks != 0)
        {
            last_.shift = row.shift;
        }
        if (last_.ends_level)
        {
            last_.rms_error = error_from_code(row.rms_code) * diagonal_;
            last_.max_error = error_from_code(row.max_code) * diagonal_;
        }
        return {};
    }

    /// Takes note of a chunk of the growth: the coarse mesh stays until the complete one is there.
    Result<void> take_growth(const IndexRow& row)
    {
        if (row.level_chunks != 0)
        {
            growth_ = row;
        }
        if (growth_.vertices > limits_.max_vertices || growth_.faces > limits_.max_faces)
        {
            return fail(ErrorCode::LimitExceeded, "the mesh is larger than the limit allows");
        }
        last_.ends_level = index_.level_complete();
        if (last_.ends_level)
        {
            last_.vertices = growth_.vertices;
            last_.faces = growth_.faces;
            last_.shift = 0;
            last_.rms_error = error_from_code(growth_.rms_code) * diagonal_;
            last_.max_error = error_from_code(growth_.max_code) * diagonal_;
        }
        return {};
    }

    void add_chunk(const IndexRow& row)
    {
        // An optional chunk leaves a level as open or complete as it was.
        ChunkInfo chunk = last_;
        chunk.kind = row.kind;
        chunk.codec = row.codec;
        chunk.bytes = row.bytes;
        chunk.tag = row.tag;
        chunk.offset = info_.file_bytes;
        info_.file_bytes += chunk.bytes;
        info_.vertex_count = chunk.vertices;
        info_.face_count = chunk.faces;
        info_.chunks.push_back(chunk);
    }

    BitDecoder& bits_;
    IndexCoder<BitDecoder> index_;
    StreamInfo& info_;
    const DecodeLimits& limits_;
    double diagonal_;
    ChunkInfo last_;   ///< The last required chunk.
    IndexRow growth_;  ///< The first row of the growth.
};

}  // namespace vsplit::codec
