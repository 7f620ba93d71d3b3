#include "byte_queue.h"

#include "core/assert.h"

#include <algorithm>
#include <utility>

namespace vsplit::client {

ByteQueue::ByteQueue(std::size_t capacity, std::function<void()> on_space)
    : on_space_(std::move(on_space)), ring_(capacity)
{
}

std::size_t ByteQueue::space() const
{
    const std::lock_guard lock(mutex_);
    return ring_.size() - size_;
}

void ByteQueue::push(std::span<const std::byte> bytes)
{
    {
        const std::lock_guard lock(mutex_);
        VSPLIT_ASSERT(bytes.size() <= ring_.size() - size_);
        const std::size_t end = (first_ + size_) % ring_.size();
        const std::size_t until_wrap = std::min(bytes.size(), ring_.size() - end);
        std::copy_n(bytes.begin(), until_wrap, ring_.begin() + static_cast<std::ptrdiff_t>(end));
        std::copy(
            bytes.begin() + static_cast<std::ptrdiff_t>(until_wrap), bytes.end(), ring_.begin()
        );
        size_ += bytes.size();
    }
    filled_.notify_one();
}

void ByteQueue::close()
{
    {
        const std::lock_guard lock(mutex_);
        closed_ = true;
    }
    filled_.notify_one();
}

bool ByteQueue::wait(std::chrono::milliseconds timeout)
{
    std::unique_lock lock(mutex_);
    filled_.wait_for(lock, timeout, [this] { return size_ > 0 || closed_; });
    return size_ > 0;
}

std::size_t ByteQueue::pop(std::span<std::byte> out)
{
    std::size_t count = 0;
    {
        const std::lock_guard lock(mutex_);
        count = std::min(out.size(), size_);
        const std::size_t until_wrap = std::min(count, ring_.size() - first_);
        const auto first = ring_.begin() + static_cast<std::ptrdiff_t>(first_);
        std::copy_n(first, until_wrap, out.begin());
        std::copy_n(
            ring_.begin(), count - until_wrap, out.begin() + static_cast<std::ptrdiff_t>(until_wrap)
        );
        first_ = (first_ + count) % ring_.size();
        size_ -= count;
    }
    if (count > 0 && on_space_)
    {
        on_space_();
    }
    return count;
}

bool ByteQueue::drained() const
{
    const std::lock_guard lock(mutex_);
    return closed_ && size_ == 0;
}

}  // namespace vsplit::client
