// Symmetric surface distance of two mesh files by vsplit's own code, for where meshdist is not at hand.
#include "mesh/surface_distance.h"
#include "mesh_metrics.h"
#include "precompute/mesh_io.h"

#include <cstdio>
#include <cstdlib>

namespace {

vsplit::Result<void> run(const char* original_path, const char* shown_path, std::size_t samples)
{
    const auto original = vsplit::precompute::read_mesh(original_path);
    VSPLIT_TRY(original);
    const auto shown = vsplit::precompute::read_mesh(shown_path);
    VSPLIT_TRY(shown);
    const vsplit::DistanceReference reference(
        vsplit::bench::to_floats(*original), original->triangles, samples
    );
    const auto distance = reference.measure(vsplit::bench::to_floats(*shown), shown->triangles);
    const double percent = 100.0 / vsplit::bench::diagonal(*original);
    std::printf(
        "{\"rms_pct\": %.6f, \"haus_pct\": %.6f}\n", distance.rms * percent, distance.max * percent
    );
    return {};
}

}  // namespace

int main(int argc, char** argv)
{
    const unsigned long samples = argc == 4 ? std::strtoul(argv[3], nullptr, 10) : 0;
    if (samples == 0)
    {
        std::fprintf(stderr, "usage: bench_distance ORIGINAL SHOWN SAMPLES\n");
        return 2;
    }
    if (const auto done = run(argv[1], argv[2], samples); !done)
    {
        std::fprintf(stderr, "bench_distance: %s\n", vsplit::describe(done.error()).c_str());
        return vsplit::exit_status(done.error().code);
    }
    return 0;
}
