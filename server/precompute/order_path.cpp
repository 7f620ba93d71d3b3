// Based on: Bellman, "Dynamic Programming", 1957; the mean of the quality over the logarithm of the bytes:
// Bjontegaard, "Calculation of Average PSNR Differences between RD-Curves", 2001.
#include "precompute/order_path.h"

#include "core/assert.h"
#include "core/portable_log.h"

#include <algorithm>
#include <limits>

namespace vsplit::precompute {
namespace {

/// An error that nobody sees, squared steps of 255: pictures do not get better than 51 decibels.
constexpr double kUnseen = 0.5;

class Lattice
{
public:
    explicit Lattice(const ErrorTable& table)
        : table_(table),
          width_(table.bytes[1].size()),
          costs_(table.errors.size(), std::numeric_limits<double>::infinity())
    {
        for (std::size_t i = table.bytes[0].size(); i-- > 0;)
        {
            for (std::size_t j = width_; j-- > 0;)
            {
                costs_[place(i, j)] = cost_from(i, j);
            }
        }
    }

    std::vector<std::size_t> path() const
    {
        std::vector<std::size_t> steps;
        for (std::size_t i = 0, j = 0; i + 1 < table_.bytes[0].size() || j + 1 < width_;)
        {
            const bool second = step_cost(i, j, i, j + 1) < step_cost(i, j, i + 1, j);
            steps.push_back(second ? 1 : 0);
            ++(second ? j : i);
        }
        return steps;
    }

private:
    [[nodiscard]] std::size_t place(std::size_t i, std::size_t j) const { return i * width_ + j; }

    [[nodiscard]] double bytes(std::size_t i, std::size_t j) const
    {
        return table_.bytes[0][i] + table_.bytes[1][j];
    }

    /// What is seen until a neighbour has come, and all that follows; infinite when there is none.
    [[nodiscard]] double step_cost(
        std::size_t i, std::size_t j, std::size_t next_i, std::size_t next_j
    ) const
    {
        if (next_i == table_.bytes[0].size() || next_j == width_)
        {
            return std::numeric_limits<double>::infinity();
        }
        const double seen = portable_log(table_.errors[place(i, j)] + kUnseen);
        const double wait = portable_log(bytes(next_i, next_j) / bytes(i, j));
        return seen * wait + costs_[place(next_i, next_j)];
    }

    [[nodiscard]] double cost_from(std::size_t i, std::size_t j) const
    {
        if (i + 1 == table_.bytes[0].size() && j + 1 == width_)
        {
            return 0.0;
        }
        return std::min(step_cost(i, j, i + 1, j), step_cost(i, j, i, j + 1));
    }

    const ErrorTable& table_;
    std::size_t width_;
    std::vector<double> costs_;  ///< Of the best way from here to the end.
};

}  // namespace

std::vector<std::size_t> best_path(const ErrorTable& table)
{
    VSPLIT_ASSERT(table.errors.size() == table.bytes[0].size() * table.bytes[1].size());
    VSPLIT_ASSERT(!table.errors.empty() && table.bytes[0][0] + table.bytes[1][0] > 0.0);
    return Lattice(table).path();
}

}  // namespace vsplit::precompute
