#pragma once

#include "codec/context_model.h"
#include "format.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace vsplit::codec {

/// Builds the model of an integer that typically is below 2^`size`. `nonzero`: probability, 1/65536, that
/// it is not 0. A sign in context 2 is hardly ever negative.
[[nodiscard]] inline IntegerModel make_index_integer(std::uint16_t nonzero, int size)
{
    constexpr std::uint16_t kCount = 5;
    constexpr std::uint16_t kSettled = 24;
    IntegerModel model;
    model.nonzero = {nonzero, kCount};
    model.sign = {{{32768, kCount}, {32768, kCount}, {2048, kCount}}};
    for (int e = 0; e < 24; ++e)
    {
        const int probability = e < size - 1 ? 52000 : e < size ? 32768 : 16384;
        model.prefix[static_cast<std::size_t>(e)] = {
            static_cast<std::uint16_t>(probability), kCount};
    }
    for (auto& mantissa : model.mantissa)
    {
        mantissa.fill({32768, kSettled});
    }
    return model;
}

/// What is learned while an index is coded.
struct IndexModel
{
    AdaptiveBit other_kind{2048, 4};
    AdaptiveBit has_boundary{8192, 2};
    IntegerModel level_chunks = make_index_integer(28000, 0);
    IntegerModel level_vertices = make_index_integer(60000, 4);
    IntegerModel drop = make_index_integer(20000, 0);
    IntegerModel vertices = make_index_integer(2000, 0);
    IntegerModel boundary = make_index_integer(56000, 2);
    IntegerModel bytes = make_index_integer(40000, 1);
    IntegerModel rms = make_index_integer(44000, 1);
    IntegerModel maximum = make_index_integer(56000, 2);
};

/// By kind the kind and codec, 256 * kind + codec, that are expected to follow at first.
[[nodiscard]] constexpr std::array<std::uint32_t, 256> first_followers()
{
    constexpr auto kBatch = static_cast<std::uint32_t>(proto::ChunkKind::Batch);
    constexpr auto kGrowth = static_cast<std::uint32_t>(proto::ChunkKind::Growth);
    std::array<std::uint32_t, 256> result{};
    result.fill(kBatch << 8);
    result[kGrowth] = kGrowth << 8;
    return result;
}

}  // namespace vsplit::codec
