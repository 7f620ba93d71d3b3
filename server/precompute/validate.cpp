#include "precompute/validate.h"

#include "precompute/half_edge_mesh.h"

namespace vsplit::precompute {

Result<void> check_manifold(const IndexedMesh& mesh)
{
    const auto linked = make_half_edge_mesh(mesh);
    VSPLIT_TRY(linked);
    return {};
}

}  // namespace vsplit::precompute
