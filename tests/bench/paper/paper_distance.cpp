// Distances of mesh files to an original, one JSON row each: rms, Hausdorff, normals, a region.
#include "paper/region_distance.h"
#include "precompute/mesh_io.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <optional>
#include <string_view>

namespace {

constexpr std::size_t kSamples = 100000;

vsplit::Result<nlohmann::json> measure(
    const vsplit::IndexedMesh& original,
    const char* path,
    const std::optional<vsplit::precompute::KeepSphere>& ball
)
{
    const auto shown = vsplit::precompute::read_mesh(path);
    VSPLIT_TRY(shown);
    std::size_t vertices_inside = 0;
    if (ball)
    {
        std::vector<float> marks(shown->positions.size());
        vertices_inside = vsplit::precompute::mark_sphere(*shown, *ball, marks);
    }
    const auto distance = vsplit::bench::region_distance(original, *shown, kSamples, ball);
    const double percent = 100.0 / distance.bounds;
    return nlohmann::json{
        {"vertices", shown->positions.size()},
        {"faces", shown->triangles.size()},
        {"rms_pct", distance.rms * percent},
        {"haus_pct", distance.max * percent},
        {"normal_deg", distance.normals},
        {"inside_pct", distance.inside * percent},
        {"outside_pct", distance.outside * percent},
        {"vertices_inside", vertices_inside},
    };
}

vsplit::Result<void> run(int argc, char** argv)
{
    const std::string_view region = argv[1];
    std::optional<vsplit::precompute::KeepSphere> ball;
    if (region != "-")
    {
        const auto parsed = vsplit::precompute::parse_keep_sphere(region);
        VSPLIT_TRY(parsed);
        ball = *parsed;
    }
    const auto original = vsplit::precompute::read_mesh(argv[2]);
    VSPLIT_TRY(original);
    auto rows = nlohmann::json::array();
    for (int i = 3; i < argc; ++i)
    {
        const auto row = measure(*original, argv[i], ball);
        VSPLIT_TRY(row);
        rows.push_back(*row);
    }
    std::puts(rows.dump().c_str());
    return {};
}

}  // namespace

int main(int argc, char** argv)
{
    if (argc < 4)
    {
        std::fputs("usage: paper_distance X,Y,Z,R|- ORIGINAL SHOWN...\n", stderr);
        return 2;
    }
    if (const auto done = run(argc, argv); !done)
    {
        std::fprintf(stderr, "paper_distance: %s\n", vsplit::describe(done.error()).c_str());
        return vsplit::exit_status(done.error().code);
    }
    return 0;
}
