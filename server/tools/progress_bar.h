#pragma once

#include <chrono>
#include <string_view>

namespace vsplit::tools {

/// Shows on standard error how far a stage is, only when that is a terminal. Not thread safe.
class ProgressBar
{
public:
    /// Prepares a bar; `wanted` false never shows it.
    explicit ProgressBar(bool wanted);
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    /// Wipes the bar away.
    ~ProgressBar();

    /// Draws the bar, at most ten times a second. `share`: 0 .. 1.
    void show(std::string_view stage, double share);

private:
    bool visible_;
    bool drawn_ = false;
    std::chrono::steady_clock::time_point next_{};
};

}  // namespace vsplit::tools
