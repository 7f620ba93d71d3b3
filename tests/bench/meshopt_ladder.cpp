#include "lod_ladder.h"

#include <algorithm>
#include <limits>
#include <meshoptimizer.h>
#include <optional>

namespace vsplit::bench {
namespace {

class MeshoptLadder : public LodLadder
{
public:
    MeshoptLadder(const IndexedMesh& mesh, double ratio)
        : targets_(ladder_targets(mesh.triangles.size(), ratio)), levels_(targets_.size())
    {
        for (const auto& position : mesh.positions)
        {
            for (const double coordinate : position)
            {
                positions_.push_back(static_cast<float>(coordinate));
            }
        }
        for (const Triangle& triangle : mesh.triangles)
        {
            indices_.insert(indices_.end(), triangle.begin(), triangle.end());
        }
        levels_.front() = mesh;
    }

    std::size_t size() const override { return targets_.size(); }

    const IndexedMesh& level(std::size_t index) override
    {
        if (!levels_[index])
        {
            levels_[index] = simplify(targets_[index]);
        }
        return *levels_[index];
    }

private:
    IndexedMesh simplify(std::size_t triangles) const
    {
        constexpr float kNoErrorLimit = std::numeric_limits<float>::max();
        std::vector<std::uint32_t> indices(indices_.size());
        indices.resize(meshopt_simplify(
            indices.data(),
            indices_.data(),
            indices_.size(),
            positions_.data(),
            positions_.size() / 3,
            3 * sizeof(float),
            3 * triangles,
            kNoErrorLimit,
            0,
            nullptr
        ));
        return compact(indices);
    }

    /// The mesh of some triangles with only the vertices that they use.
    IndexedMesh compact(const std::vector<std::uint32_t>& indices) const
    {
        constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
        std::vector<std::uint32_t> place(positions_.size() / 3, kUnused);
        IndexedMesh mesh;
        mesh.triangles.resize(indices.size() / 3);
        for (std::size_t i = 0; i < indices.size(); ++i)
        {
            std::uint32_t& vertex = place[indices[i]];
            if (vertex == kUnused)
            {
                vertex = static_cast<std::uint32_t>(mesh.positions.size());
                const float* const position = &positions_[3 * indices[i]];
                mesh.positions.push_back({position[0], position[1], position[2]});
            }
            mesh.triangles[i / 3][i % 3] = vertex;
        }
        return mesh;
    }

    std::vector<std::size_t> targets_;
    std::vector<std::optional<IndexedMesh>> levels_;
    std::vector<float> positions_;
    std::vector<std::uint32_t> indices_;
};

}  // namespace

std::vector<std::size_t> ladder_targets(std::size_t triangles, double ratio)
{
    constexpr double kFewestTriangles = 8.0;
    std::vector<std::size_t> targets{triangles};
    for (auto next = static_cast<double>(triangles) * ratio; next >= kFewestTriangles;
         next *= ratio)
    {
        const auto target = static_cast<std::size_t>(next);
        if (target < targets.back())
        {
            targets.push_back(target);
        }
    }
    return targets;
}

std::unique_ptr<LodLadder> make_meshopt_ladder(const IndexedMesh& mesh, double ratio)
{
    return std::make_unique<MeshoptLadder>(mesh, ratio);
}

}  // namespace vsplit::bench
