// Based on: Lindstrom, Turk, "Fast and Memory Efficient Polygonal Simplification", 1998 (coarse vertices
// where the surface is followed best, not on it); Hoppe, DeRose, Duchamp, McDonald, Stuetzle, "Mesh
// Optimization", 1993. Departure: a vertex keeps its identity and comes home as the grid gets finer,
// so that it may go no further than pays for what that costs.
#include "precompute/level_placement.h"

#include "mesh/quantization_grid.h"
#include "precompute/surface_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace vsplit::precompute {
namespace {

using Cell = std::array<std::int32_t, 3>;

/// On finer grids the way home costs more than better places bring.
constexpr int kLeastShift = 2;

/// Share of the source's vertices up to which a level is placed.
constexpr double kLargestShare = 0.2;

/// How strongly vertices are drawn home, in samples of weight one; keeps them from sliding along the
/// surface for nothing.
constexpr double kHomePull = 0.1;

/// Samples that a vertex nobody samples counts for.
constexpr double kLeastWeight = 0.3;

/// What a coordinate pays for lying one cell further away than it need, in squared cells of error.
/// Measured: between 0.1 and 0.5 what is lost at low rates is won in the size of the file.
constexpr double kCellPrice = 0.2;

/// Passes over all vertices; after three hardly one moves.
constexpr int kPasses = 3;

constexpr std::uint32_t kNone = 0xFFFFFFFF;

/// Cells per axis that a vertex may be away from its own: what refinement can carry it home from.
constexpr std::int32_t kFarthest = 4;

/// The grid of one level, in units of the full one.
class LevelGrid
{
public:
    LevelGrid(int shift, int bits) : unit_{.origin = {}, .cell = 1.0, .bits = bits}, shift_(shift)
    {
    }

    [[nodiscard]] int shift() const { return shift_; }

    /// Edge of a cell.
    [[nodiscard]] double size() const { return static_cast<double>(std::int32_t{1} << shift_); }

    /// Where a vertex in a cell is shown.
    [[nodiscard]] Vector3 shown(const Cell& cell) const { return dequantize(unit_, cell, shift_); }

    /// Of the cells between whose centres a point lies, the one with the least indices; near `own`.
    [[nodiscard]] Cell below(const Vector3& point, const Cell& own) const
    {
        const Vector3 off = (point - shown(own)) * (1.0 / size());
        Cell cell = own;
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const double far = static_cast<double>(kFarthest);
            cell[axis] +=
                static_cast<std::int32_t>(std::floor(std::clamp(off[axis], -far, far - 1.0)));
        }
        return cell;
    }

    /// The cell itself or its next ones along some axes, the bits of `corner`; inside of the grid.
    [[nodiscard]] Cell neighbour(const Cell& cell, std::int32_t corner) const
    {
        const std::int32_t last = unit_.max_index() >> shift_;
        return {
            std::clamp(cell[0] + (corner & 1), 0, last),
            std::clamp(cell[1] + ((corner >> 1) & 1), 0, last),
            std::clamp(cell[2] + (corner >> 2), 0, last),
        };
    }

private:
    QuantizationGrid unit_;
    int shift_;
};

Cell coarser(const Cell& cell, int steps)
{
    return {cell[0] >> steps, cell[1] >> steps, cell[2] >> steps};
}

/// How far apart two cells of one grid are, summed over the axes.
std::int32_t cells_apart(const Cell& a, const Cell& b)
{
    return std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]);
}

/// How far `fine` lies outside of `coarse`, whose cells are larger by `steps` > 0, summed over the axes,
/// in halves of a coarse cell.
std::int32_t halves_outside(const Cell& coarse, const Cell& fine, int steps)
{
    std::int32_t sum = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const std::int32_t half =
            (fine[axis] - coarse[axis] * (std::int32_t{1} << steps)) >> (steps - 1);
        sum += half > 0 ? half - 1 : -half;
    }
    return sum;
}

/// One level while its vertices are placed.
class Placement
{
public:
    /// `cells`: by vertex of the source where it is shown before, on a grid that is coarser by `steps`.
    Placement(
        const PlacementSource& source,
        const PlacedLevel& level,
        const FitSource& fit_source,
        std::span<const Cell> cells,
        int steps,
        unsigned threads
    )
        : source_(source),
          cells_(cells),
          steps_(steps),
          grid_(level.shift, source.bits),
          local_(source.exact.size(), kNone),
          fit_(make_fit(level, fit_source, threads))
    {
    }

    /// Chooses cells for the free vertices.
    std::vector<codec::Displacement> run()
    {
        std::vector<Cell> chosen(free_.size());
        for (int pass = 0; pass < kPasses; ++pass)
        {
            for (std::size_t i = 0; i < free_.size(); ++i)
            {
                chosen[i] = choose(free_[i]);
                fit_.move(free_[i], grid_.shown(chosen[i]) - fit_.place(free_[i]));
            }
        }
        std::vector<codec::Displacement> displaced;
        for (std::size_t i = 0; i < free_.size(); ++i)
        {
            if (chosen[i] != home(free_[i]))
            {
                displaced.push_back({vertices_[free_[i]], chosen[i]});
            }
        }
        return displaced;
    }

private:
    SurfaceFit make_fit(const PlacedLevel& level, const FitSource& fit_source, unsigned threads)
    {
        const bool all = level.free.empty();
        std::vector<Triangle> triangles = level.triangles;
        std::vector<Vector3> places;
        for (Triangle& triangle : triangles)
        {
            for (std::uint32_t& v : triangle)
            {
                if (local_[v] == kNone)
                {
                    local_[v] = static_cast<std::uint32_t>(vertices_.size());
                    vertices_.push_back(v);
                    places.push_back(all ? source_.exact[v] : grid_.shown(cells_[v]));
                    if (all)
                    {
                        free_.push_back(local_[v]);
                    }
                }
                v = local_[v];
            }
        }
        for (const std::uint32_t v : level.free)
        {
            free_.push_back(local_[v]);
            places[local_[v]] = source_.exact[v];
        }
        return {fit_source, std::move(places), triangles, all, threads};
    }

    [[nodiscard]] Cell home(std::uint32_t v) const
    {
        return coarser(source_.mesh->positions[vertices_[v]], grid_.shift());
    }

    [[nodiscard]] Cell choose(std::uint32_t v) const
    {
        const Cell own = home(v);
        if (!source_.locked.empty() && source_.locked[vertices_[v]] != 0)
        {
            return own;
        }
        QuadraticForm form = fit_.form(v);
        const double price = kCellPrice * grid_.size() * grid_.size() * form.weight;
        form.attract(
            source_.exact[vertices_[v]] - fit_.place(v), kHomePull * (form.weight + kLeastWeight)
        );
        const Cell below = grid_.below(fit_.place(v) + form.minimum(), own);
        double least = std::numeric_limits<double>::infinity();
        Cell best = own;
        for (std::int32_t corner = 0; corner < 8; ++corner)
        {
            const Cell cell = grid_.neighbour(below, corner);
            const double value = form.evaluate(grid_.shown(cell) - fit_.place(v)) +
                                 price * static_cast<double>(way_home(v, cell, own));
            if (value < least)
            {
                least = value;
                best = cell;
            }
        }
        return best;
    }

    /// What a cell costs: coming to it from the grid before, and going home from it.
    [[nodiscard]] std::int32_t way_home(std::uint32_t v, const Cell& cell, const Cell& own) const
    {
        const std::int32_t coming =
            steps_ > 0 ? halves_outside(cells_[vertices_[v]], cell, steps_) : 0;
        return 2 * coming + cells_apart(cell, own);
    }

    const PlacementSource& source_;
    std::span<const Cell> cells_;
    int steps_;
    LevelGrid grid_;
    std::vector<std::uint32_t> local_;     ///< By vertex of the source its number in the level.
    std::vector<std::uint32_t> vertices_;  ///< By vertex of the level its number in the source.
    std::vector<std::uint32_t> free_;      ///< In vertices of the level.
    SurfaceFit fit_;
};

FitSource make_fit_source(const PlacementSource& source, std::span<const PlacedLevel> levels)
{
    FitSource fit;
    fit.positions.resize(source.exact.size());
    std::ranges::transform(source.exact, fit.positions.begin(), [](const Vector3& p) {
        return std::array<float, 3>{
            static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
    });
    fit.triangles = source.mesh->triangles;
    fit.tree = source.tree;
    std::size_t most = 0;
    for (const PlacedLevel& level : levels)
    {
        most = std::max(most, level.free.empty() ? level.triangles.size() : 0);
    }
    // A closed surface has half as many vertices as faces.
    fit.samples = sample_surface(fit.positions, fit.triangles, SurfaceFit::sample_count(most / 2));
    return fit;
}

/// By vertex its own cell on the grid of a level.
std::vector<Cell> home_cells(const GridMesh& mesh, int shift)
{
    std::vector<Cell> cells(mesh.positions.size());
    std::ranges::transform(mesh.positions, cells.begin(), [shift](const Cell& cell) {
        return coarser(cell, shift);
    });
    return cells;
}

}  // namespace

bool is_worth_placing(std::size_t vertices, std::size_t all, int shift)
{
    return shift >= kLeastShift &&
           static_cast<double>(vertices) <= kLargestShare * static_cast<double>(all);
}

std::vector<std::vector<codec::Displacement>> place_levels(
    const PlacementSource& source, std::span<const PlacedLevel> levels, unsigned threads
)
{
    const FitSource fit_source = make_fit_source(source, levels);
    std::vector<std::vector<codec::Displacement>> placed;
    std::vector<Cell> cells;
    int shift = 0;
    for (const PlacedLevel& level : levels)
    {
        const int steps = cells.empty() ? 0 : shift - level.shift;
        shift = level.shift;
        if (cells.empty())
        {
            cells = home_cells(*source.mesh, shift);
        }
        placed.push_back(Placement(source, level, fit_source, cells, steps, threads).run());
        if (steps > 0)
        {
            cells = home_cells(*source.mesh, shift);
        }
        for (const codec::Displacement& displacement : placed.back())
        {
            cells[displacement.vertex] = displacement.position;
        }
    }
    return placed;
}

}  // namespace vsplit::precompute
