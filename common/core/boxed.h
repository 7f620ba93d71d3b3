#pragma once

#include <memory>
#include <utility>

namespace vsplit {

/// A large value that is kept on the heap, copied with its owner, and may be given up before it.
template <typename T>
class Boxed
{
public:
    /// Keeps a value.
    explicit Boxed(T value) : value_(std::make_unique<T>(std::move(value))) {}

    /// Copies the value, if there is one.
    Boxed(const Boxed& other) : value_(other.value_ ? std::make_unique<T>(*other.value_) : nullptr)
    {
    }

    /// Leaves the other without a value.
    Boxed(Boxed&& other) noexcept = default;

    /// Copies or takes the value, if there is one.
    Boxed& operator=(Boxed other) noexcept
    {
        value_ = std::move(other.value_);
        return *this;
    }

    ~Boxed() = default;

    /// The value. Precondition: it was not given up.
    [[nodiscard]] T& operator*() { return *value_; }

    /// The same, read only.
    [[nodiscard]] const T& operator*() const { return *value_; }

    /// A part of the value. Precondition: it was not given up.
    [[nodiscard]] T* operator->() { return value_.get(); }

    /// Gives the value up and its memory back.
    void release() { value_.reset(); }

private:
    std::unique_ptr<T> value_;
};

}  // namespace vsplit
