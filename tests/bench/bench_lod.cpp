// Finds the best single level of detail by a peer's simplifier and Draco at several rates.
#include "lod_ladder.h"
#include "lod_search.h"
#include "mesh_metrics.h"
#include "precompute/mesh_io.h"
#include "precompute/repair.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

namespace vsplit::bench {
namespace {

/// Ratio of neighbouring levels' sizes: the best file that fits wastes 1.5 % of its budget at most.
constexpr double kLadderRatio = 0.985;

struct Arguments
{
    std::string peer;
    std::string mesh;
    std::string folder;
    std::vector<double> rates;
    LodSearchOptions search;
};

/// Writes the meshes that the files of one rate show; returns their rows.
Result<nlohmann::json> write_files(
    const Arguments& arguments, const std::vector<LodFile>& files, double percent, std::size_t bytes
)
{
    auto rows = nlohmann::json::array();
    for (std::size_t i = 0; i < files.size(); ++i)
    {
        const LodFile& file = files[i];
        const std::string name = std::to_string(bytes) + "-" + std::to_string(i) + ".ply";
        VSPLIT_TRY(
            precompute::write_mesh(std::filesystem::path(arguments.folder) / name, file.shown)
        );
        rows.push_back(
            {{"file", name},
             {"bytes", file.bytes},
             {"bits", file.bits},
             {"vertices", file.shown.positions.size()},
             {"faces", file.shown.triangles.size()},
             {"own_rms_percent", file.rms * percent},
             {"own_max_percent", file.max * percent}}
        );
    }
    return rows;
}

Result<void> run(const Arguments& arguments)
{
    const auto mesh = precompute::read_mesh(arguments.mesh);
    VSPLIT_TRY(mesh);
    const auto repaired = precompute::repair_mesh(*mesh);
    VSPLIT_TRY(repaired);
    const auto ladder = arguments.peer == "meshopt"
                            ? make_meshopt_ladder(repaired->mesh, kLadderRatio)
                            : make_lindstrom_turk_ladder(repaired->mesh, kLadderRatio);
    LodSearch search(repaired->mesh, *ladder, arguments.search);
    const auto vertices = static_cast<double>(repaired->mesh.positions.size());
    auto rows = nlohmann::json::array();
    for (const double rate : arguments.rates)
    {
        const auto bytes = static_cast<std::size_t>(rate * vertices / 8.0);
        const auto files = search.best_files(bytes);
        VSPLIT_TRY(files);
        const auto listed = write_files(arguments, *files, 100.0 / diagonal(*mesh), bytes);
        VSPLIT_TRY(listed);
        rows.push_back({{"rate", rate}, {"bytes", bytes}, {"files", *listed}});
    }
    const nlohmann::json report{{"vertices", repaired->mesh.positions.size()}, {"rates", rows}};
    std::printf("%s\n", report.dump(2).c_str());
    return {};
}

}  // namespace
}  // namespace vsplit::bench

int main(int argc, char** argv)
{
    vsplit::bench::Arguments arguments;
    CLI::App app("Finds the best single level of detail at several rates; prints JSON");
    app.add_option("PEER", arguments.peer, "Simplifier")
        ->required()
        ->check(CLI::IsMember({"meshopt", "lindstrom-turk"}));
    app.add_option("MESH", arguments.mesh, "The original")->required();
    app.add_option("FOLDER", arguments.folder, "Where to put the decoded meshes")->required();
    app.add_option("--rates", arguments.rates, "Bits per vertex of the original")
        ->required()
        ->delimiter(',');
    app.add_option("--keep-by-rms", arguments.search.keep_by_rms, "Files to keep at each rate");
    app.add_option("--keep-by-max", arguments.search.keep_by_max, "Files to keep at each rate");
    CLI11_PARSE(app, argc, argv);
    const auto done = vsplit::bench::run(arguments);
    if (!done)
    {
        std::fprintf(stderr, "bench_lod: %s\n", vsplit::describe(done.error()).c_str());
        return vsplit::exit_status(done.error().code);
    }
    return 0;
}
