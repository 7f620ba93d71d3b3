#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <span>
#include <vector>

namespace vsplit::client {

/// A bounded ring of bytes between the thread that receives and the thread that decodes. When the
/// reader stops, the queue fills, and the receiver stops taking bytes from the socket.
/// Thread safe for one writer and one reader.
class ByteQueue
{
public:
    /// `capacity`: the most bytes that wait in the queue, > 0. `on_space`: called from the reader's
    /// thread after bytes were taken out; may be empty.
    explicit ByteQueue(std::size_t capacity, std::function<void()> on_space = {});

    /// Bytes that may be pushed now.
    [[nodiscard]] std::size_t space() const;

    /// Appends bytes. Precondition: bytes.size() <= space().
    void push(std::span<const std::byte> bytes);

    /// Marks the end: wait() no longer waits. What was pushed can still be taken.
    void close();

    /// Waits until a byte is there, the queue is closed, or `timeout` has passed.
    /// Returns true when at least one byte can be taken.
    bool wait(std::chrono::milliseconds timeout);

    /// Takes up to out.size() bytes without waiting. Returns how many; 0 when the queue is empty.
    std::size_t pop(std::span<std::byte> out);

    /// True once close() was called and every byte was taken.
    [[nodiscard]] bool drained() const;

private:
    mutable std::mutex mutex_;
    std::condition_variable filled_;
    std::function<void()> on_space_;
    std::vector<std::byte> ring_;
    std::size_t first_ = 0;
    std::size_t size_ = 0;
    bool closed_ = false;
};

}  // namespace vsplit::client
