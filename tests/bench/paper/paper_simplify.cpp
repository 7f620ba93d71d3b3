// Simplifies a mesh file to so many faces by a method that the paper compares or cites.
#include "paper/lindstrom_turk.h"
#include "paper/simplifiers.h"
#include "precompute/mesh_io.h"
#include "precompute/repair.h"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <exception>
#include <functional>
#include <map>
#include <meshoptimizer.h>
#include <string>
#include <vector>

namespace {

using namespace vsplit;

using Method = std::function<IndexedMesh(const IndexedMesh&, std::size_t)>;

/// What both of meshoptimizer's simplifiers take and give: indices into the vertices as they are.
template <typename Simplify>
IndexedMesh with_meshoptimizer(const IndexedMesh& mesh, std::size_t faces, const Simplify& simplify)
{
    std::vector<float> positions;
    std::vector<unsigned> indices;
    for (const auto& point : mesh.positions)
    {
        for (const double coordinate : point)
        {
            positions.push_back(static_cast<float>(coordinate));
        }
    }
    for (const Triangle& triangle : mesh.triangles)
    {
        indices.insert(indices.end(), triangle.begin(), triangle.end());
    }
    std::vector<unsigned> left(indices.size());
    left.resize(simplify(left, indices, positions, 3 * faces));
    IndexedMesh result{mesh.positions, {}};
    for (std::size_t i = 0; i < left.size(); i += 3)
    {
        result.triangles.push_back({left[i], left[i + 1], left[i + 2]});
    }
    return bench::without_unused_vertices(result);
}

constexpr float kAnyError = 1e10F;

IndexedMesh meshopt(const IndexedMesh& mesh, std::size_t faces)
{
    return with_meshoptimizer(
        mesh,
        faces,
        [](auto& out, auto& in, auto& points, std::size_t count) {
            return meshopt_simplify(
                out.data(),
                in.data(),
                in.size(),
                points.data(),
                points.size() / 3,
                12,
                count,
                kAnyError
            );
        }
    );
}

IndexedMesh meshopt_sloppy(const IndexedMesh& mesh, std::size_t faces)
{
    return with_meshoptimizer(
        mesh,
        faces,
        [](auto& out, auto& in, auto& points, std::size_t count) {
            return meshopt_simplifySloppy(
                out.data(),
                in.data(),
                in.size(),
                points.data(),
                points.size() / 3,
                12,
                count,
                kAnyError
            );
        }
    );
}

std::map<std::string, Method> methods()
{
    std::map<std::string, Method> result{
        {"grid-clustering",
         [](const IndexedMesh& mesh, std::size_t faces) {
             return bench::simplify_by_clustering(mesh, bench::Clustering::Grid, faces);
         }},
        {"floating-cells",
         [](const IndexedMesh& mesh, std::size_t faces) {
             return bench::simplify_by_clustering(mesh, bench::Clustering::FloatingCell, faces);
         }},
        {"energy", bench::simplify_by_energy},
        {"lindstrom-turk", bench::simplify_by_lindstrom_turk},
        {"openmesh", bench::simplify_by_open_mesh},
        {"meshopt", meshopt},
        {"meshopt-sloppy", meshopt_sloppy},
    };
    for (const auto& [metric, name] : precompute::kMetricNames)
    {
        result["vsplit-" + std::string(name)] = [metric =
                                                     metric](const auto& mesh, std::size_t faces) {
            return bench::simplify_by_metric(mesh, metric, faces);
        };
    }
    return result;
}

Result<void> run(
    const std::string& method,
    const std::string& input,
    const std::string& output,
    std::size_t faces
)
{
    const auto mesh = precompute::read_mesh(input);
    VSPLIT_TRY(mesh);
    const auto repaired = precompute::repair_mesh(*mesh);
    VSPLIT_TRY(repaired);
    return precompute::write_mesh(output, methods().at(method)(repaired->mesh, faces));
}

}  // namespace

int main(int argc, char** argv)
{
    CLI::App app("Simplifies a mesh by a named method");
    std::string method;
    std::string input;
    std::string output;
    std::size_t faces = 0;
    std::vector<std::string> names;
    for (const auto& [name, function] : methods())
    {
        names.push_back(name);
    }
    app.add_option("METHOD", method)->required()->check(CLI::IsMember(names));
    app.add_option("IN", input)->required();
    app.add_option("OUT", output)->required();
    app.add_option("FACES", faces, "At most so many faces stay")->required();
    CLI11_PARSE(app, argc, argv);
    try
    {
        const auto done = run(method, input, output, faces);
        if (!done)
        {
            std::fprintf(stderr, "paper_simplify: %s\n", describe(done.error()).c_str());
            return exit_status(done.error().code);
        }
        return 0;
    }
    catch (const std::exception& error)
    {
        std::fprintf(stderr, "paper_simplify: %s\n", error.what());
        return 1;
    }
}
