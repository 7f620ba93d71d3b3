// Based on: Goldfeather, Interrante, "A Novel Cubic-Order Algorithm for Approximating Principal
// Direction Vectors", 2004, section 3: the quadratic height-field fit with linear terms.
// Departure: the points are the two-ring or the nearest 24 of it, all with equal weight.
#include "precompute/curvature.h"
#include "precompute/local_fit.h"
#include "precompute/parallel_ranges.h"
#include "precompute/vertex_neighbourhood.h"

namespace vsplit::precompute {

namespace {

constexpr std::size_t kMostFitted = 24;

}  // namespace

std::vector<float> quadric_curvature(const HalfEdgeMesh& mesh, unsigned threads)
{
    const auto vertex_count = static_cast<std::uint32_t>(mesh.n_vertices());
    std::vector<float> curvature(vertex_count, 0.0F);
    const auto normals = vertex_normals(mesh);
    parallel_ranges(vertex_count, threads, [&](std::uint32_t begin, std::uint32_t end) {
        NeighbourhoodSearch search(mesh);
        LocalPatch patch;
        for (std::uint32_t v = begin; v < end; ++v)
        {
            if (make_patch(mesh, normals, v, search.two_ring(v, kMostFitted), patch))
            {
                curvature[v] = to_curvature(quadric_fit(patch), patch.radius);
            }
        }
    });
    return curvature;
}

}  // namespace vsplit::precompute
