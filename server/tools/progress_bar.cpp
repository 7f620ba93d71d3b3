#include "progress_bar.h"

#include <algorithm>
#include <cstdio>
#include <string>
#include <unistd.h>

namespace vsplit::tools {
namespace {

constexpr auto kInterval = std::chrono::milliseconds(100);
constexpr int kWidth = 40;

}  // namespace

ProgressBar::ProgressBar(bool wanted) : visible_(wanted && ::isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar()
{
    if (drawn_)
    {
        std::fputs("\r\033[K", stderr);
    }
}

void ProgressBar::show(std::string_view stage, double share)
{
    const auto now = std::chrono::steady_clock::now();
    if (!visible_ || now < next_)
    {
        return;
    }
    next_ = now + kInterval;
    drawn_ = true;
    const double part = std::clamp(share, 0.0, 1.0);
    const auto filled = static_cast<std::size_t>(part * kWidth);
    const std::string bar = std::string(filled, '#') + std::string(kWidth - filled, '.');
    std::fprintf(
        stderr,
        "\r\033[K[%s] %3d %% %.*s",
        bar.c_str(),
        static_cast<int>(part * 100.0),
        static_cast<int>(stage.size()),
        stage.data()
    );
    std::fflush(stderr);
}

}  // namespace vsplit::tools
