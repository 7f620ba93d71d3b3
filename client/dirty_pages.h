#pragma once

#include <cstdint>
#include <vector>

namespace vsplit::client {

/// A run of elements of an array.
struct ElementRange
{
    std::uint32_t first = 0;
    std::uint32_t count = 0;

    /// Memberwise equality.
    friend bool operator==(const ElementRange&, const ElementRange&) = default;
};

/// Remembers which parts of an array changed, in pages, so that a few larger uploads replace many
/// small ones. Not thread safe.
class DirtyPages
{
public:
    /// `page_elements`: elements a page holds, > 0.
    explicit DirtyPages(std::uint32_t page_elements) : page_elements_(page_elements) {}

    /// Prepares for an array of `elements`, so that mark() need not allocate below that.
    void reserve(std::uint32_t elements);

    /// Notes that one element changed. Cost: constant.
    void mark(std::uint32_t element);

    /// Notes that every element from `first` to before `end` changed. Cost: linear in pages.
    void mark_range(std::uint32_t first, std::uint32_t end);

    /// Returns the changed pages as ascending, non-touching runs, cut at `elements` (the array's
    /// length), and forgets them. Cost: n log n in the pages that changed.
    [[nodiscard]] std::vector<ElementRange> take(std::uint32_t elements);

private:
    std::uint32_t page_elements_;
    std::vector<bool> dirty_;
    std::vector<std::uint32_t> pages_;
};

}  // namespace vsplit::client
