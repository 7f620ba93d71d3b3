#include "codec/initial_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

namespace vsplit::codec {
namespace {

/// Units of a weight, 1/65536 nat, in one unit of a packed weight, 1/32 nat.
constexpr std::int32_t kWeightUnit = 2048;

/// Observations that a packed probability counts for: few, so that a mesh's own soon outweigh it.
constexpr std::uint16_t kTrust = 24;

constexpr std::size_t kWeightCount = sizeof(ConnectivityModel) / sizeof(std::int32_t);
constexpr std::size_t kBitCount = sizeof(GeometryModel) / sizeof(AdaptiveBit);

// Both models are nothing but arrays of one type each, which the packing walks in memory order.
static_assert(std::is_standard_layout_v<ConnectivityModel> && std::is_standard_layout_v<GeometryModel>);
static_assert(kWeightCount * sizeof(std::int32_t) == sizeof(ConnectivityModel));
static_assert(kBitCount * sizeof(AdaptiveBit) == sizeof(GeometryModel));

constexpr std::array<std::uint8_t, kWeightCount + kBitCount> kPacked{
#include "initial_model.inc"
};

const std::int32_t* weights_of(const LearnedModel& model)
{
    return reinterpret_cast<const std::int32_t*>(&model.connectivity);
}

const AdaptiveBit* bits_of(const LearnedModel& model)
{
    return reinterpret_cast<const AdaptiveBit*>(&model.geometry);
}

std::uint8_t pack_weight(std::span<const LearnedModel> models, std::size_t index)
{
    double sum = 0.0;
    for (const LearnedModel& model : models)
    {
        sum += weights_of(model)[index];
    }
    const double mean = sum / static_cast<double>(models.size()) / kWeightUnit;
    return static_cast<std::uint8_t>(
        static_cast<std::int8_t>(std::clamp(std::round(mean), -127.0, 127.0))
    );
}

std::uint8_t pack_bit(std::span<const LearnedModel> models, std::size_t index)
{
    double sum = 0.0;
    double count = 0.0;
    for (const LearnedModel& model : models)
    {
        const AdaptiveBit& bit = bits_of(model)[index];
        const double probability = (bit.probability + 0.5) / 65536.0;
        sum += bit.count * std::log(probability / (1.0 - probability));
        count += bit.count;
    }
    if (!(count > 0.0))
    {
        return 0;
    }
    const double probability = 1.0 / (1.0 + std::exp(-sum / count));
    return static_cast<std::uint8_t>(std::clamp(std::floor(probability * 256.0), 1.0, 255.0));
}

}  // namespace

LearnedModel initial_model()
{
    LearnedModel model;
    auto* const weights = reinterpret_cast<std::int32_t*>(&model.connectivity);
    for (std::size_t i = 0; i < kWeightCount; ++i)
    {
        weights[i] = static_cast<std::int8_t>(kPacked[i]) * kWeightUnit;
    }
    auto* const bits = reinterpret_cast<AdaptiveBit*>(&model.geometry);
    for (std::size_t i = 0; i < kBitCount; ++i)
    {
        const std::uint8_t packed = kPacked[kWeightCount + i];
        if (packed != 0)
        {
            bits[i] = {static_cast<std::uint16_t>(packed * 256 + 128), kTrust};
        }
    }
    return model;
}

std::vector<std::uint8_t> pack_model(std::span<const LearnedModel> models)
{
    std::vector<std::uint8_t> packed;
    for (std::size_t i = 0; i < kWeightCount; ++i)
    {
        packed.push_back(pack_weight(models, i));
    }
    for (std::size_t i = 0; i < kBitCount; ++i)
    {
        packed.push_back(pack_bit(models, i));
    }
    return packed;
}

}  // namespace vsplit::codec
