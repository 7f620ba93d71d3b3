#include "codec/encoded_samples.h"

#include "codec/shapes.h"
#include "precompute/repair.h"

#include <ostream>
#include <stdexcept>

namespace vsplit::test {

EncodedSample encode(const IndexedMesh& mesh, const precompute::EncodeOptions& options)
{
    auto repaired = precompute::repair_mesh(mesh);
    if (!repaired)
    {
        throw std::runtime_error(describe(repaired.error()));
    }
    auto encoded = precompute::encode_mesh(repaired->mesh, repaired->stitches, options);
    if (!encoded)
    {
        throw std::runtime_error(describe(encoded.error()));
    }
    EncodedSample sample;
    sample.mesh = std::move(repaired->mesh);
    sample.stitches = std::move(repaired->stitches);
    sample.source = quantize(encoded->info.grid, sample.mesh);
    sample.file = std::move(encoded->file);
    sample.info = std::move(encoded->info);
    return sample;
}

std::ostream& operator<<(std::ostream& out, const NamedMesh& mesh)
{
    return out << mesh.name;
}

const std::vector<NamedMesh>& small_meshes()
{
    static const std::vector<NamedMesh> kMeshes{
        {"triangle", [] { return triangle(); }},
        {"tetrahedron", [] { return tetrahedron(); }},
        {"octahedron", [] { return octahedron(); }},
        {"strip", [] { return strip(40); }},
        {"fan", [] { return fan(400); }},
        {"double_cone", [] { return double_cone(300); }},
        {"two_components", [] { return joined(tetrahedron(), sphere(12, 14, 0.1, 1), 3.0); }},
        {"sphere", [] { return sphere(14, 16, 0.05, 2); }},
        {"torus", [] { return torus(24, 14, 0.05, 3); }},
        {"sheet", [] { return height_field(18, 15, 0.5, 4); }},
        {"holes", [] { return with_holes(height_field(22, 16, 0.5, 5), 0.05, 6); }},
        {"debris", [] { return with_holes(torus(24, 16, 0.1, 7), 0.4, 8); }},
        {"book", [] { return book(9); }},
    };
    return kMeshes;
}

}  // namespace vsplit::test
