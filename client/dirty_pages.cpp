#include "dirty_pages.h"

#include <algorithm>

namespace vsplit::client {

void DirtyPages::reserve(std::uint32_t elements)
{
    const std::size_t page_count = elements / page_elements_ + 1;
    dirty_.reserve(page_count);
    pages_.reserve(page_count);
}

void DirtyPages::mark(std::uint32_t element)
{
    const std::uint32_t page = element / page_elements_;
    if (page >= dirty_.size())
    {
        dirty_.resize(std::size_t{page} + 1, false);
    }
    if (!dirty_[page])
    {
        dirty_[page] = true;
        pages_.push_back(page);
    }
}

void DirtyPages::mark_range(std::uint32_t first, std::uint32_t end)
{
    if (first >= end)
    {
        return;
    }
    const std::uint32_t last_page = (end - 1) / page_elements_;
    for (std::uint32_t page = first / page_elements_; page <= last_page; ++page)
    {
        mark(page * page_elements_);
    }
}

std::vector<ElementRange> DirtyPages::take(std::uint32_t elements)
{
    std::sort(pages_.begin(), pages_.end());
    std::vector<ElementRange> ranges;
    for (const std::uint32_t page : pages_)
    {
        dirty_[page] = false;
        const std::uint32_t first = page * page_elements_;
        const std::uint32_t end = std::min(elements, first + page_elements_);
        if (first >= end)
        {
            continue;
        }
        if (!ranges.empty() && ranges.back().first + ranges.back().count == first)
        {
            ranges.back().count += end - first;
        }
        else
        {
            ranges.push_back({first, end - first});
        }
    }
    pages_.clear();
    return ranges;
}

}  // namespace vsplit::client
