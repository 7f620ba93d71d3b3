#pragma once

#include "mesh/indexed_mesh.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>
#include <vector>

namespace vsplit::codec {

/// A triangle that is new or has changed; `slot` is its place in the triangle list, for ever.
struct TriangleUpdate
{
    std::uint32_t slot = 0;
    Triangle vertices{};
};

/// Tells the updates of a step one after another without having stored them.
class UpdateSource
{
public:
    /// How far a reader came; zero to begin with, its meaning is the source's.
    struct Cursor
    {
        std::size_t item = 0;
        std::uint32_t added = 0;
    };

    /// Fewest updates that read() wants room for.
    static constexpr std::size_t kLeastRoom = 8;

    UpdateSource() = default;
    UpdateSource(const UpdateSource&) = delete;
    UpdateSource& operator=(const UpdateSource&) = delete;
    virtual ~UpdateSource() = default;

    /// Writes the next updates into `out` and moves `cursor` past them; returns how many, 0 at the
    /// end. Precondition: out.size() >= kLeastRoom.
    virtual std::size_t read(Cursor& cursor, std::span<TriangleUpdate> out) const = 0;
};

/// The triangles that a step changed, for a range-based for loop. A triangle may come more than once, as
/// it is after the step. Refers to the list or the source it was made of.
class TriangleUpdates
{
public:
    /// Goes over the updates once.
    class Iterator
    {
    public:
        /// Stands at the first update.
        explicit Iterator(const TriangleUpdates& updates)
            : source_(updates.source_), end_(updates.list_.size()), current_(updates.list_.data())
        {
            refill();
        }

        Iterator(const Iterator&) = delete;
        Iterator& operator=(const Iterator&) = delete;

        /// The update that it stands at.
        [[nodiscard]] const TriangleUpdate& operator*() const { return current_[place_]; }

        /// Goes on to the next one.
        Iterator& operator++()
        {
            ++place_;
            refill();
            return *this;
        }

        /// Tells whether no update is left.
        [[nodiscard]] bool operator==(std::default_sentinel_t /*end*/) const
        {
            return place_ == end_;
        }

    private:
        void refill()
        {
            if (place_ == end_ && source_ != nullptr)
            {
                place_ = 0;
                end_ = source_->read(cursor_, buffer_);
                current_ = buffer_.data();
            }
        }

        const UpdateSource* source_;
        std::size_t place_ = 0;
        std::size_t end_;
        const TriangleUpdate* current_;
        UpdateSource::Cursor cursor_;
        std::array<TriangleUpdate, 64> buffer_;
    };

    /// No updates.
    TriangleUpdates() = default;

    /// Those of a list, which must outlive this.
    TriangleUpdates(std::span<const TriangleUpdate> list) : list_(list) {}

    /// Those of a list, which must outlive this.
    TriangleUpdates(const std::vector<TriangleUpdate>& list) : list_(list) {}

    /// Those of a source, which must outlive this.
    explicit TriangleUpdates(const UpdateSource& source) : source_(&source) {}

    /// The first update.
    [[nodiscard]] Iterator begin() const { return Iterator(*this); }

    /// Behind the last one.
    [[nodiscard]] std::default_sentinel_t end() const { return {}; }

private:
    std::span<const TriangleUpdate> list_;
    const UpdateSource* source_ = nullptr;
};

}  // namespace vsplit::codec
