// A sheet that moves by at most some distance still covers every point of its picture that lies farther
// inside: the test needs no threshold but the level's error. Edges at which a sheet ends for the eye are
// those with all their triangles on one side, as in Hertzmann, "Introduction to 3D Non-Photorealistic
// Rendering: Silhouettes and Outlines", 1999.
#include "picture/cracks.h"

#include "core/assert.h"
#include "picture/projected.h"
#include "picture/surface_edges.h"

#include <algorithm>
#include <cmath>

namespace vsplit::picture {
namespace {

/// Pixels beside the displacement that drawing at pixel centres may add.
constexpr double kSlack = 1.5;
/// Share of the depth by which a visible edge may lie behind what is drawn around it.
constexpr double kBehind = 1e-3;

/// On which side of an edge a vertex is seen: -1, 0, 1.
int side_of(const ScreenVertex& from, const ScreenVertex& to, const ScreenVertex& vertex)
{
    const std::int64_t area =
        (to.x - from.x) * (vertex.y - from.y) - (to.y - from.y) * (vertex.x - from.x);
    return area > 0 ? 1 : area < 0 ? -1 : 0;
}

/// Replaces every number by the largest one within `radius` along rows (stride 1) or columns (stride
/// `size`).
template <typename Number>
void spread_largest(
    std::vector<Number>& numbers, std::uint32_t size, bool rows, std::int64_t radius
)
{
    const std::size_t step = rows ? 1 : size;
    const std::size_t next_line = rows ? size : 1;
    std::vector<Number> line(size);
    for (std::size_t start = 0, i = 0; i < size; ++i, start += next_line)
    {
        for (std::size_t k = 0; k < size; ++k)
        {
            line[k] = numbers[start + k * step];
        }
        for (std::int64_t k = 0; k < size; ++k)
        {
            const auto first = line.begin() + std::max<std::int64_t>(k - radius, 0);
            const auto last = line.begin() + std::min<std::int64_t>(k + radius + 1, size);
            numbers[start + static_cast<std::size_t>(k) * step] = *std::max_element(first, last);
        }
    }
}

template <typename Number>
std::vector<Number> largest_around(
    std::vector<Number> numbers, std::uint32_t size, std::int64_t radius
)
{
    spread_largest(numbers, size, true, radius);
    spread_largest(numbers, size, false, radius);
    return numbers;
}

/// Marks the pixels along an edge where it is not hidden.
/// `behind`: by pixel the largest depth around it.
void mark_edge(
    const ScreenVertex& from,
    const ScreenVertex& to,
    std::uint32_t size,
    const std::vector<float>& behind,
    std::vector<std::uint8_t>& marks
)
{
    constexpr std::int64_t kStep = kSubpixels / 2;
    const std::int64_t across = to.x - from.x;
    const std::int64_t down = to.y - from.y;
    const std::int64_t steps = std::max(std::abs(across), std::abs(down)) / kStep + 1;
    for (std::int64_t i = 0; i <= steps; ++i)
    {
        const std::int64_t x = from.x + across * i / steps;
        const std::int64_t y = from.y + down * i / steps;
        const std::int64_t limit = size * kSubpixels;
        if (x < 0 || y < 0 || x >= limit || y >= limit)
        {
            continue;
        }
        const auto pixel = static_cast<std::size_t>(y / kSubpixels * size + x / kSubpixels);
        const double share = static_cast<double>(i) / static_cast<double>(steps);
        // Depths are not linear on the screen; between the two ends' linear and harmonic means.
        const double depth = std::min(
            from.depth + share * (to.depth - from.depth),
            1.0 / (1.0 / from.depth + share * (1.0 / to.depth - 1.0 / from.depth))
        );
        if (depth <= behind[pixel] * (1.0 + kBehind))
        {
            marks[pixel] = 1;
        }
    }
}

/// Marks where the sheet of a surface ends for the eye, see CrackDetector.
std::vector<std::uint8_t> mark_ends(
    const std::vector<TriangleSide>& sides,
    const std::vector<ScreenVertex>& vertices,
    const Picture& picture
)
{
    std::vector<std::uint8_t> marks(picture.depths.size(), 0);
    for (std::size_t pixel = 0; pixel < marks.size(); ++pixel)
    {
        marks[pixel] = picture.covered(pixel) ? 0 : 1;
    }
    const auto behind = largest_around(picture.depths, picture.size, 1);
    for (std::size_t first = 0, last = 0; first < sides.size(); first = last)
    {
        const ScreenVertex& from = vertices[sides[first].ends[0]];
        const ScreenVertex& to = vertices[sides[first].ends[1]];
        bool left = false;
        bool right = false;
        while (last < sides.size() && sides[last].ends == sides[first].ends)
        {
            const int side = side_of(from, to, vertices[sides[last].opposite]);
            left = left || side < 0;
            right = right || side > 0;
            ++last;
        }
        if (!left || !right)
        {
            mark_edge(from, to, picture.size, behind, marks);
        }
    }
    return marks;
}

}  // namespace

CrackDetector::CrackDetector(
    const Surface& original, std::span<const View> views, std::uint32_t size
)
    : views_(views.begin(), views.end()), size_(size)
{
    const auto sides = sorted_sides(original.mesh);
    for (const View& view : views_)
    {
        const Scene scene{.surface = &original};
        const Picture picture = draw(scene, view, {.size = size, .color = false});
        Reference reference;
        reference.ends = mark_ends(sides, project(original.mesh.positions, view, size), picture);
        reference.nearest_depth = *std::ranges::min_element(picture.depths);
        reference.depths = picture.depths;
        references_.push_back(std::move(reference));
    }
}

std::vector<std::uint8_t> CrackDetector::mark(
    std::size_t view, const Picture& picture, double max_error
) const
{
    VSPLIT_ASSERT(view < views_.size() && picture.size == size_);
    const Reference& reference = references_[view];
    std::vector<std::uint8_t> marks(picture.depths.size(), 3);
    if (reference.nearest_depth == Picture::kNothing)
    {
        return marks;
    }
    const double shown =
        views_[view].shown_length(max_error, reference.nearest_depth) * size_ + kSlack;
    const auto radius = static_cast<std::int64_t>(std::ceil(std::min<double>(shown, size_)));
    const auto ends = largest_around(reference.ends, size_, radius);
    const auto deepest = largest_around(reference.depths, size_, radius);
    const double deeper = max_error + kBehind * reference.nearest_depth;
    for (std::size_t pixel = 0; pixel < marks.size(); ++pixel)
    {
        if (ends[pixel] == 0)
        {
            const bool behind = picture.depths[pixel] > deepest[pixel] + deeper;
            marks[pixel] = !picture.covered(pixel) ? 1 : behind ? 2 : 0;
        }
    }
    return marks;
}

CrackCount CrackDetector::count(const Surface& level, double max_error) const
{
    CrackCount result;
    const Scene scene{.surface = &level};
    for (std::size_t view = 0; view < views_.size(); ++view)
    {
        const Picture picture = draw(scene, views_[view], {.size = size_, .color = false});
        const auto marks = mark(view, picture, max_error);
        result.background += static_cast<std::size_t>(std::ranges::count(marks, 1));
        result.see_through += static_cast<std::size_t>(std::ranges::count(marks, 2));
        result.judged += marks.size() - static_cast<std::size_t>(std::ranges::count(marks, 3));
    }
    return result;
}

}  // namespace vsplit::picture
