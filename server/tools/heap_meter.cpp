// Replaces the global operator new and delete of this program by ones that can count.
#include "heap_meter.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <malloc.h>
#include <new>

namespace {

std::atomic<bool> counting{false};
std::atomic<std::int64_t> bytes_in_use{0};
std::atomic<std::int64_t> peak_bytes{0};

void count_new(void* block)
{
    if (!counting.load(std::memory_order_relaxed))
    {
        return;
    }
    const auto size = static_cast<std::int64_t>(::malloc_usable_size(block));
    const std::int64_t now = bytes_in_use.fetch_add(size, std::memory_order_relaxed) + size;
    std::int64_t peak = peak_bytes.load(std::memory_order_relaxed);
    while (now > peak && !peak_bytes.compare_exchange_weak(peak, now, std::memory_order_relaxed))
    {
    }
}

void count_delete(void* block)
{
    if (block != nullptr && counting.load(std::memory_order_relaxed))
    {
        const auto size = static_cast<std::int64_t>(::malloc_usable_size(block));
        bytes_in_use.fetch_sub(size, std::memory_order_relaxed);
    }
}

void* allocate(std::size_t size) noexcept
{
    void* const block = std::malloc(std::max<std::size_t>(size, 1));
    if (block != nullptr)
    {
        count_new(block);
    }
    return block;
}

void* allocate_aligned(std::size_t size, std::align_val_t alignment) noexcept
{
    const auto step = static_cast<std::size_t>(alignment);
    void* const block =
        std::aligned_alloc(step, (std::max<std::size_t>(size, 1) + step - 1) / step * step);
    if (block != nullptr)
    {
        count_new(block);
    }
    return block;
}

void* or_throw(void* block)
{
    if (block == nullptr)
    {
        throw std::bad_alloc();
    }
    return block;
}

void release(void* block) noexcept
{
    count_delete(block);
    std::free(block);
}

}  // namespace

namespace vsplit::tools {

void start_heap_meter()
{
    bytes_in_use = 0;
    peak_bytes = 0;
    counting = true;
}

std::uint64_t stop_heap_meter()
{
    counting = false;
    return static_cast<std::uint64_t>(peak_bytes.load());
}

}  // namespace vsplit::tools

void* operator new(std::size_t size)
{
    return or_throw(allocate(size));
}

void* operator new[](std::size_t size)
{
    return or_throw(allocate(size));
}

void* operator new(std::size_t size, const std::nothrow_t& /*tag*/) noexcept
{
    return allocate(size);
}

void* operator new[](std::size_t size, const std::nothrow_t& /*tag*/) noexcept
{
    return allocate(size);
}

void* operator new(std::size_t size, std::align_val_t alignment)
{
    return or_throw(allocate_aligned(size, alignment));
}

void* operator new[](std::size_t size, std::align_val_t alignment)
{
    return or_throw(allocate_aligned(size, alignment));
}

void operator delete(void* block) noexcept
{
    release(block);
}

void operator delete[](void* block) noexcept
{
    release(block);
}

void operator delete(void* block, std::size_t /*size*/) noexcept
{
    release(block);
}

void operator delete[](void* block, std::size_t /*size*/) noexcept
{
    release(block);
}

void operator delete(void* block, std::align_val_t /*alignment*/) noexcept
{
    release(block);
}

void operator delete[](void* block, std::align_val_t /*alignment*/) noexcept
{
    release(block);
}

void operator delete(void* block, std::size_t /*size*/, std::align_val_t /*alignment*/) noexcept
{
    release(block);
}

void operator delete[](void* block, std::size_t /*size*/, std::align_val_t /*alignment*/) noexcept
{
    release(block);
}
