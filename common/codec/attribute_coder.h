#pragma once

// The attributes of one level after another: wedges, groups, values, at the end normals. Encoder and
// decoder run this same code.

#include "codec/attribute_state.h"
#include "codec/bit_counter.h"
#include "codec/group_coder.h"
#include "codec/level_mesh.h"
#include "codec/normal_coder.h"
#include "codec/stream_info.h"
#include "codec/value_coder.h"
#include "codec/value_precision.h"
#include "codec/wedge_coder.h"
#include "core/result.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace vsplit::codec {

/// Most groups of a stream.
inline constexpr std::uint32_t kMaxGroups = 1U << 16;

/// What an encoder wants of a level.
struct AttributeSource
{
    WedgeSource wedges;
    std::vector<std::uint32_t> groups;  ///< By slot; empty: all 0.
    /// By attribute and wedge of the source the coded numbers.
    std::span<const std::vector<std::int32_t>> values;
    std::vector<std::uint8_t> lacks;  ///< By attribute the low bits that the level does without.
    std::uint32_t group_count = 1;
};

/// Codes the attributes of a stream, level by level. Not thread safe. Safe on untrusted input.
class AttributeCoder
{
public:
    /// `attributes`: those of the stream; must outlive this.
    AttributeCoder(std::span<const AttributeInfo> attributes, const WedgeCounts& counts)
        : attributes_(attributes), counts_(counts)
    {
        state_.shown.values.resize(attributes.size());
        state_.lacks.resize(attributes.size());
        for (const AttributeInfo& info : attributes)
        {
            state_.value_models.emplace_back(
                info.kind == AttributeKind::Normal ? 0 : info.components
            );
        }
    }

    /// Takes the memory for a level's wedges at once. `vertices`, `faces`: of the finest level to come.
    void reserve(std::uint32_t vertices, std::uint32_t faces)
    {
        faces_ = faces;
        const std::size_t wedges = most_wedges(counts_, vertices);
        state_.first_wedge.reserve(vertices);
        state_.next_wedge.reserve(wedges);
        state_.shown.wedge_vertices.reserve(wedges);
        for (std::size_t a = 0; a < attributes_.size(); ++a)
        {
            const bool later = attributes_[a].kind == AttributeKind::Normal;
            state_.shown.values[a].reserve(later ? 0 : wedges * attributes_[a].components);
        }
    }

    /// Attributes of the last level that was completed.
    [[nodiscard]] const LevelAttributes& shown() const { return state_.shown; }

    /// True from begin_level() until every value of the level was coded.
    [[nodiscard]] bool in_level() const { return values_ != nullptr; }

    /// True once a level was completed.
    [[nodiscard]] bool has_level() const { return levels_ > 0; }

    /// Values of the level that are left to code.
    [[nodiscard]] std::uint32_t left() const { return values_->left(); }

    /// Frees the copy of the level's mesh. Precondition: not in_level(); code_normals() is not called before
    /// the next begin_level().
    void forget_mesh() { mesh_ = {}; }

    /// Starts on a level: codes its wedges and groups. `mesh`: of the level; `replaced`: its triangles have
    /// nothing to do with those of the level before; `source`: encoder only.
    /// Errors: Internal (the source contradicts itself), BadChunk.
    template <typename Coder>
    [[nodiscard]] Result<void> begin_level(
        Coder& coder, LevelMesh mesh, bool replaced, AttributeSource* source
    )
    {
        mesh_ = std::move(mesh);
        const auto known = static_cast<std::uint32_t>(state_.shown.wedge_vertices.size());
        if (levels_ == 0)
        {
            groups_ = 1 + code_count(coder, Coder::kEncodes ? source->group_count - 1 : 0);
            if (groups_ > kMaxGroups)
            {
                return fail(ErrorCode::BadChunk, "the stream has too many groups of triangles");
            }
        }
        const std::size_t kept = replaced ? 0 : state_.shown.wedges.size();
        WedgeSource* const wedges = Coder::kEncodes ? &source->wedges : nullptr;
        const std::uint32_t most =
            most_wedges(counts_, static_cast<std::uint32_t>(mesh_.positions.size()));
        VSPLIT_TRY(WedgeCoder<Coder>(coder, mesh_, state_, replaced, most, wedges).run());
        if (groups_ > 1)
        {
            state_.shown.groups.reserve(faces_);
            std::span<const std::uint32_t> wanted;
            if constexpr (Coder::kEncodes)
            {
                wanted = source->groups;
            }
            code_groups(coder, mesh_, state_, kept, groups_, wanted);
        }
        std::span<const std::uint8_t> lacks;
        if constexpr (Coder::kEncodes)
        {
            lacks = source->lacks;
        }
        VSPLIT_TRY(code_precision(coder, attributes_, state_, known, levels_ == 0, lacks, wanted_));
        values_ = std::make_unique<ValueCoder>(attributes_, mesh_, state_, known);
        if constexpr (Coder::kEncodes)
        {
            collect_wanted(*source);
        }
        return {};
    }

    /// Codes `count` values of the level; the last ones complete it.
    /// Precondition: in_level(). Error: BadChunk.
    template <typename Coder>
    [[nodiscard]] Result<void> code_values(Coder& coder, std::uint32_t count)
    {
        if (count > values_->left())
        {
            return fail(ErrorCode::BadChunk, "a chunk holds more values than the level has");
        }
        VSPLIT_TRY(values_->run(coder, count, wanted_));
        if (values_->left() == 0)
        {
            values_.reset();
            ++levels_;
        }
        return {};
    }

    /// Wedges whose numbers lack bits. Precondition: not in_level().
    [[nodiscard]] std::uint32_t late_left() const
    {
        return late_bits() == 0 ? 0 : wedge_count() - completed_;
    }

    /// Bits that the numbers of one of them lack.
    [[nodiscard]] std::uint32_t late_bits() const { return lacking_bits(attributes_, state_); }

    /// Codes the bits that `count` wedges lack, in their order. Precondition: has_level(), not in_level(),
    /// the level is the last one. Error: BadChunk.
    template <typename Coder>
    [[nodiscard]] Result<void> code_late_bits(Coder& coder, std::uint32_t count)
    {
        if (count > late_left())
        {
            return fail(ErrorCode::BadChunk, "a chunk holds bits that no value lacks");
        }
        for (; count > 0; --count, ++completed_)
        {
            complete_wedge(coder, attributes_, state_, completed_, wanted_);
        }
        if (completed_ == wedge_count())
        {
            std::ranges::fill(state_.lacks, std::uint8_t{0});
            completed_ = 0;
        }
        return {};
    }

    /// Codes `count` normals of the complete mesh, beginning with the first attribute that has them.
    /// `styles`: encoder only, by attribute. Precondition: has_level(), not in_level(), the level is the
    /// last one. Error: BadChunk.
    template <typename Coder>
    [[nodiscard]] Result<void> code_normals(
        Coder& coder, std::uint32_t count, const NormalStyle& style
    )
    {
        if (!next_normals())
        {
            return fail(ErrorCode::BadChunk, "a chunk holds normals of no attribute");
        }
        auto& normals = *normals_;
        if (begins_normals_)
        {
            normals.begin(coder, style);
            begins_normals_ = false;
        }
        if (count > normals.left())
        {
            return fail(ErrorCode::BadChunk, "a chunk holds more normals than there are");
        }
        std::span<const std::int32_t> wanted;
        if constexpr (Coder::kEncodes)
        {
            wanted = wanted_[normal_attribute_];
        }
        VSPLIT_TRY(normals.run(coder, count, wanted));
        if (normals.left() == 0)
        {
            state_.shown.values[normal_attribute_] = std::move(normals.values());
            normals_.reset();
            ++normal_attribute_;
        }
        return {};
    }

    /// Starts on the next attribute with normals, unless one is begun. Result: false when there is none.
    [[nodiscard]] bool next_normals()
    {
        while (!normals_ && normal_attribute_ < attributes_.size())
        {
            const AttributeInfo& info = attributes_[normal_attribute_];
            if (info.kind == AttributeKind::Normal)
            {
                normals_.emplace(info, mesh_, state_.shown);
                begins_normals_ = true;
            }
            else
            {
                ++normal_attribute_;
            }
        }
        return normals_.has_value();
    }

    /// True unless normals of an attribute are begun and not complete.
    [[nodiscard]] bool normals_complete() const { return !normals_; }

    /// True when nothing is begun that is not complete.
    [[nodiscard]] bool settled() const
    {
        return !in_level() && normals_complete() && completed_ == 0;
    }

    /// Bytes that the first normals of the attribute begun take in a style. Precondition: next_normals().
    [[nodiscard]] Result<std::size_t> try_normals(std::uint32_t count, const NormalStyle& style)
        const
    {
        NormalCoder trial = *normals_;
        BitCounter bits;
        trial.begin(bits, style);
        VSPLIT_TRY(trial.run(bits, std::min(count, trial.left()), wanted_[normal_attribute_]));
        return bits.bytes();
    }

    /// Normals of the attribute begun that are left to code. Precondition: next_normals().
    [[nodiscard]] std::uint32_t normals_left() const { return normals_->left(); }

private:
    [[nodiscard]] std::uint32_t wedge_count() const
    {
        return static_cast<std::uint32_t>(state_.shown.wedge_vertices.size());
    }

    /// Puts what is wanted in the order of the stream's wedges.
    void collect_wanted(const AttributeSource& source)
    {
        const auto& labels = source.wedges.label_of;
        wanted_.resize(attributes_.size());
        for (std::size_t a = 0; a < attributes_.size(); ++a)
        {
            const std::size_t numbers = coded_components(attributes_[a]);
            wanted_[a].reserve(labels.size() * numbers);
            for (std::size_t w = wanted_[a].size() / numbers; w < labels.size(); ++w)
            {
                const auto value =
                    std::span(source.values[a]).subspan(labels[w] * numbers, numbers);
                wanted_[a].insert(wanted_[a].end(), value.begin(), value.end());
            }
        }
    }

    std::span<const AttributeInfo> attributes_;
    WedgeCounts counts_;
    AttributeState state_;
    LevelMesh mesh_;
    std::unique_ptr<ValueCoder> values_;
    std::optional<NormalCoder> normals_;
    bool begins_normals_ = false;
    std::size_t normal_attribute_ = 0;
    std::vector<std::vector<std::int32_t>> wanted_;  ///< Encoder only: by attribute and wedge.
    std::uint32_t completed_ = 0;  ///< Wedges that lack no bits any more, while others do.
    std::uint32_t levels_ = 0;
    std::uint32_t groups_ = 1;
    std::uint32_t faces_ = 0;  ///< For which memory is taken.
};

}  // namespace vsplit::codec
