#include "precompute/keep_region.h"

#include "core/file_io.h"
#include "precompute/text_scan.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

namespace vsplit::precompute {
namespace {

/// A number takes at most so many bytes of a mask: more is not a mask for this mesh.
constexpr std::uint64_t kMostBytesPerVertex = 64;

tl::unexpected<Error> bad_mask(const std::filesystem::path& path, const std::string& why)
{
    return fail(ErrorCode::UnsupportedInput, "the mask " + path.string() + " " + why);
}

std::string shortened(std::string_view word)
{
    constexpr std::size_t kMost = 20;
    return std::string(word.substr(0, kMost)) + (word.size() > kMost ? "..." : "");
}

}  // namespace

Result<KeepSphere> parse_keep_sphere(std::string_view text)
{
    const auto bad = [whole = text] {
        return fail(
            ErrorCode::BadRequest, shortened(whole) + " is not x,y,z,r with a positive radius r"
        );
    };
    std::array<double, 4> numbers{};
    for (std::size_t i = 0; i < numbers.size(); ++i)
    {
        const std::size_t comma = text.find(',');
        const bool last = i + 1 == numbers.size();
        const auto number = parse_real(text.substr(0, comma));
        if (!number || !std::isfinite(*number) || last != (comma == std::string_view::npos))
        {
            return bad();
        }
        numbers[i] = *number;
        text.remove_prefix(last ? text.size() : comma + 1);
    }
    if (!(numbers[3] > 0.0))
    {
        return bad();
    }
    return KeepSphere{{numbers[0], numbers[1], numbers[2]}, numbers[3]};
}

std::size_t mark_sphere(
    const IndexedMesh& mesh, const KeepSphere& sphere, std::span<float> importance
)
{
    std::size_t inside = 0;
    for (std::size_t vertex = 0; vertex < mesh.positions.size(); ++vertex)
    {
        const auto& [x, y, z] = mesh.positions[vertex];
        const double dx = x - sphere.centre[0];
        const double dy = y - sphere.centre[1];
        const double dz = z - sphere.centre[2];
        if (std::sqrt(dx * dx + dy * dy + dz * dz) <= sphere.radius)
        {
            importance[vertex] = 1.0F;
            ++inside;
        }
    }
    return inside;
}

Result<std::vector<float>> read_keep_mask(
    const std::filesystem::path& path, std::size_t vertex_count
)
{
    const auto bytes = read_file(path, kMostBytesPerVertex * (vertex_count + 1));
    VSPLIT_TRY(bytes);
    LineReader lines({reinterpret_cast<const char*>(bytes->data()), bytes->size()});
    std::vector<float> importance;
    importance.reserve(vertex_count);
    while (auto line = lines.next())
    {
        for (auto word = take_token(*line); !word.empty(); word = take_token(*line))
        {
            const auto number = parse_real(word);
            if (!number || !(*number >= 0.0 && *number <= 1.0))
            {
                return bad_mask(
                    path,
                    "has \"" + shortened(word) + "\" in line " +
                        std::to_string(lines.line_number()) + ", which is no number from 0 to 1"
                );
            }
            if (importance.size() == vertex_count)
            {
                return bad_mask(
                    path,
                    "has more numbers than the mesh's " + std::to_string(vertex_count) + " vertices"
                );
            }
            importance.push_back(static_cast<float>(*number));
        }
    }
    if (importance.size() != vertex_count)
    {
        return bad_mask(
            path,
            "has " + std::to_string(importance.size()) + " numbers for " +
                std::to_string(vertex_count) + " vertices"
        );
    }
    return importance;
}

}  // namespace vsplit::precompute
