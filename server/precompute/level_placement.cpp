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
#include <optional>

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

/// The source without the samples of components that a level lacks, which would draw its surface away
/// from its own. `triangles`: of the level, in vertices of the source.
FitSource present(
    const PlacementSource& source, std::span<const Triangle> triangles, const FitSource& all
)
{
    FitSource fit = all;
    std::vector<std::uint8_t> is_there(source.components.size(), 0);
    for (const Triangle& triangle : triangles)
    {
        is_there[source.components[triangle[0]]] = 1;
    }
    std::erase_if(fit.samples, [&](const SurfaceSample& sample) {
        return is_there[source.components[source.mesh->triangles[sample.triangle][0]]] == 0;
    });
    return fit;
}

/// Levels of one shift while their vertices are placed. A vertex stays where it is until the grid gets finer,
/// so that it has to suit the coarsest of them and the finest.
class Placement
{
public:
    /// `cells`: by vertex of the source where it is shown before, on a grid that is coarser by `steps`.
    Placement(
        const PlacementSource& source,
        const PlacedLevels& levels,
        const FitSource& fit_source,
        std::span<const Cell> cells,
        int steps,
        unsigned threads
    )
        : source_(source),
          cells_(cells),
          steps_(steps),
          grid_(levels.shift, source.bits),
          local_(source.exact.size(), kNone),
          is_new_(source.exact.size(), 0)
    {
        if (!levels.coarsest.empty())
        {
            coarsest_.emplace(make_fit(levels.coarsest, fit_source, threads));
        }
        in_coarsest_ = vertices_.size();
        finest_.emplace(make_fit(levels.finest, fit_source, threads));
        for (const std::uint32_t v : levels.born)
        {
            is_new_[v] = 1;
        }
    }

    /// Chooses cells for the vertices.
    std::vector<codec::Displacement> run()
    {
        const auto count = static_cast<std::uint32_t>(vertices_.size());
        std::vector<Cell> chosen(count);
        for (int pass = 0; pass < kPasses; ++pass)
        {
            for (std::uint32_t v = 0; v < count; ++v)
            {
                chosen[v] = choose(v);
                move(v, grid_.shown(chosen[v]) - finest_->place(v));
            }
        }
        std::vector<codec::Displacement> displaced;
        for (std::uint32_t v = 0; v < count; ++v)
        {
            if (chosen[v] != home(v))
            {
                displaced.push_back({vertices_[v], chosen[v]});
            }
        }
        return displaced;
    }

private:
    /// Vertices that have no number yet get the next ones.
    SurfaceFit make_fit(
        std::vector<Triangle> triangles, const FitSource& fit_source, unsigned threads
    )
    {
        std::optional<FitSource> part;
        if (!source_.components.empty())
        {
            part = present(source_, triangles, fit_source);
        }
        for (Triangle& triangle : triangles)
        {
            for (std::uint32_t& v : triangle)
            {
                if (local_[v] == kNone)
                {
                    local_[v] = static_cast<std::uint32_t>(vertices_.size());
                    vertices_.push_back(v);
                }
                v = local_[v];
            }
        }
        std::vector<Vector3> places(vertices_.size());
        std::ranges::transform(vertices_, places.begin(), [this](std::uint32_t v) {
            return source_.exact[v];
        });
        return {part ? *part : fit_source, std::move(places), triangles, threads};
    }

    void move(std::uint32_t v, const Vector3& step)
    {
        finest_->move(v, step);
        if (v < in_coarsest_)
        {
            coarsest_->move(v, step);
        }
    }

    /// The squared distances of both levels as a function of a step of a vertex, half of each.
    [[nodiscard]] QuadraticForm form(std::uint32_t v) const
    {
        QuadraticForm form = finest_->form(v);
        if (v < in_coarsest_)
        {
            form.average(coarsest_->form(v));
        }
        return form;
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
        QuadraticForm form = this->form(v);
        const Vector3& place = finest_->place(v);
        const double price = kCellPrice * grid_.size() * grid_.size() * form.weight;
        form.attract(source_.exact[vertices_[v]] - place, kHomePull * (form.weight + kLeastWeight));
        const Cell below = grid_.below(place + form.minimum(), own);
        double least = std::numeric_limits<double>::infinity();
        Cell best = own;
        for (std::int32_t corner = 0; corner < 8; ++corner)
        {
            const Cell cell = grid_.neighbour(below, corner);
            const double value = form.evaluate(grid_.shown(cell) - place) +
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
        const std::uint32_t vertex = vertices_[v];
        const bool comes = steps_ > 0 && is_new_[vertex] == 0;
        const std::int32_t coming = comes ? halves_outside(cells_[vertex], cell, steps_) : 0;
        return 2 * coming + cells_apart(cell, own);
    }

    const PlacementSource& source_;
    std::span<const Cell> cells_;
    int steps_;
    LevelGrid grid_;
    std::vector<std::uint32_t> local_;     ///< By vertex of the source its number here.
    std::vector<std::uint32_t> vertices_;  ///< By number the vertex of the source.
    std::vector<std::uint8_t> is_new_;     ///< By vertex of the source: no coarser level has it.
    std::optional<SurfaceFit> coarsest_;   ///< Unless it is the finest.
    std::size_t in_coarsest_ = 0;          ///< Vertices that it has, the first ones.
    std::optional<SurfaceFit> finest_;
};

FitSource make_fit_source(const PlacementSource& source, std::span<const PlacedLevels> levels)
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
    for (const PlacedLevels& level : levels)
    {
        most = std::max(most, level.finest.size());
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
    const PlacementSource& source, std::span<const PlacedLevels> levels, unsigned threads
)
{
    const FitSource fit_source = make_fit_source(source, levels);
    std::vector<std::vector<codec::Displacement>> placed;
    std::vector<Cell> cells;
    int shift = 0;
    for (const PlacedLevels& level : levels)
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
