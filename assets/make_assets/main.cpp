#include "core/error.h"
#include "core/file_io.h"
#include "make_assets/models.h"
#include "make_assets/vase.h"
#include "make_assets/write_ply.h"

#include <cstdio>
#include <filesystem>
#include <span>
#include <string>

namespace {

/// Writes the model that needs more than one file.
vsplit::Result<void> write_vase(const std::filesystem::path& folder)
{
    using namespace vsplit;
    const Surface vase = assets::make_vase();
    const std::string text = assets::obj_text(vase, "vase.mtl", {"clay", "glaze"});
    const std::string materials = assets::vase_mtl();
    VSPLIT_TRY(write_file_atomically(folder / "vase.obj", std::as_bytes(std::span(text))));
    VSPLIT_TRY(write_file_atomically(folder / "vase.mtl", std::as_bytes(std::span(materials))));
    VSPLIT_TRY(write_file_atomically(folder / "vase.png", assets::vase_png()));
    std::printf(
        "%-12s %6zu vertices %6zu faces\n",
        "vase.obj",
        vase.mesh.positions.size(),
        vase.mesh.triangles.size()
    );
    return {};
}

}  // namespace

int main(int argc, char** argv)
{
    if (argc != 2 || argv[1][0] == '-')
    {
        std::fprintf(stderr, "usage: make_assets FOLDER\nWrites vsplit's own models there.\n");
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
    const auto written = write_vase(argv[1]);
    if (!written)
    {
        std::fprintf(stderr, "%s\n", vsplit::describe(written.error()).c_str());
    }
    return written ? 0 : vsplit::exit_status(written.error().code);
}
