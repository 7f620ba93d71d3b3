#include "core/error.h"
#include "make_assets/models.h"
#include "make_assets/write_ply.h"

#include <cstdio>
#include <filesystem>
#include <string>

int main(int argc, char** argv)
{
    if (argc != 2 || argv[1][0] == '-')
    {
        std::fprintf(
            stderr, "usage: make_assets FOLDER\nWrites vsplit's own models there as PLY.\n"
        );
        return 2;
    }
    for (const auto& [name, make] : vsplit::assets::kModels)
    {
        const auto path = std::filesystem::path(argv[1]) / (std::string(name) + ".ply");
        const vsplit::IndexedMesh mesh = make();
        if (const auto written = vsplit::assets::write_ply(path, mesh); !written)
        {
            std::fprintf(stderr, "%s\n", vsplit::describe(written.error()).c_str());
            return vsplit::exit_status(written.error().code);
        }
        std::printf(
            "%-12s %6zu vertices %6zu faces\n",
            path.filename().c_str(),
            mesh.positions.size(),
            mesh.triangles.size()
        );
    }
    return 0;
}
