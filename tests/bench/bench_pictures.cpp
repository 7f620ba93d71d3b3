// What the first bytes of a stream look like, and what the best level of detail by meshopt_simplify, Draco
// and JPEG of those bytes looks like.
#include "core/file_io.h"
#include "image/image_file.h"
#include "picture_judge.h"
#include "picture_lod.h"
#include "precompute/repair_surface.h"
#include "precompute/surface_io.h"
#include "shown_prefix.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <string>
#include <vector>

namespace vsplit::bench {
namespace {

struct Arguments
{
    std::string model;
    std::string stream;
    std::vector<std::size_t> bytes;
    PictureLodBits most;
    std::string folder;
};

/// The original and its first image.
struct Original
{
    ShownModel shown;
    Raster image;
};

Result<Original> read_original(const std::string& path)
{
    auto source = precompute::read_surface(path);
    VSPLIT_TRY(source);
    auto repaired = precompute::repair_surface(source->surface);
    VSPLIT_TRY(repaired);
    Original original;
    original.shown.surface.mesh = std::move(repaired->repaired.mesh);
    original.shown.surface.attributes = std::move(repaired->attributes);
    original.shown.surface.groups = std::move(repaired->groups);
    original.shown.appearance = source->appearance;
    for (const SourceImage& file : source->images)
    {
        auto raster = image::read_image(file.bytes);
        VSPLIT_TRY(raster);
        original.shown.textures.emplace_back(*raster);
        if (original.image.pixels.empty())
        {
            original.image = std::move(*raster);
        }
    }
    return original;
}

Result<void> save(const Arguments& arguments, const std::string& name, const Raster& picture)
{
    if (arguments.folder.empty())
    {
        return {};
    }
    const auto file = image::write_png(picture);
    VSPLIT_TRY(file);
    return write_file_atomically(arguments.folder + "/" + name + ".png", *file);
}

Result<nlohmann::json> peer_rows(
    const Arguments& arguments, const Original& original, const PictureJudge& judge
)
{
    PictureLodSearch search(original.shown, original.image, arguments.most);
    auto rows = nlohmann::json::array();
    for (const std::size_t bytes : arguments.bytes)
    {
        const auto lod = search.best(bytes, judge);
        VSPLIT_TRY(lod);
        rows.push_back(
            {{"budget", bytes},
             {"geometry_bytes", lod->geometry_bytes},
             {"image_bytes", lod->image_bytes},
             {"faces", lod->faces},
             {"position_bits", lod->position_bits},
             {"tex_coord_bits", lod->tex_coord_bits},
             {"normal_bits", lod->normal_bits},
             {"side", lod->side},
             {"quality", lod->quality},
             {"psnr", lod->figures.psnr},
             {"ssim", lod->figures.ssim}}
        );
        VSPLIT_TRY(save(arguments, "lod-" + std::to_string(bytes), judge.first_view(lod->shown)));
    }
    return rows;
}

Result<nlohmann::json> prefix_rows(const Arguments& arguments, const PictureJudge& judge)
{
    const auto stream = read_file(arguments.stream);
    VSPLIT_TRY(stream);
    auto rows = nlohmann::json::array();
    for (const std::size_t bytes : arguments.bytes)
    {
        const std::span<const std::byte> all(*stream);
        const auto shown = show_prefix(all.first(std::min(bytes, all.size())));
        VSPLIT_TRY(shown);
        const PictureFigures figures = judge.judge(shown->model);
        rows.push_back(
            {{"budget", bytes},
             {"bytes", shown->bytes},
             {"faces", shown->model.surface.mesh.triangles.size()},
             {"psnr", figures.psnr},
             {"ssim", figures.ssim}}
        );
        VSPLIT_TRY(
            save(arguments, "prefix-" + std::to_string(bytes), judge.first_view(shown->model))
        );
    }
    return rows;
}

Result<void> run(const Arguments& arguments)
{
    const auto original = read_original(arguments.model);
    VSPLIT_TRY(original);
    const PictureJudge judge(original->shown, 8, 512);
    VSPLIT_TRY(save(arguments, "original", judge.first_view(original->shown)));
    const auto rows = arguments.stream.empty() ? peer_rows(arguments, *original, judge)
                                               : prefix_rows(arguments, judge);
    VSPLIT_TRY(rows);
    std::printf("%s\n", rows->dump(1).c_str());
    return {};
}

}  // namespace
}  // namespace vsplit::bench

int main(int argc, char** argv)
{
    vsplit::bench::Arguments arguments;
    CLI::App app("Measures what files of several lengths look like; prints JSON");
    app.add_option("MODEL", arguments.model, "The original")->required();
    app.add_option(
        "--stream", arguments.stream, "Judge the prefixes of this stream instead of peers"
    );
    app.add_option("--bytes", arguments.bytes, "Lengths")->required()->delimiter(',');
    app.add_option("--position-bits", arguments.most.position, "Most that peers may have")
        ->check(CLI::Range(8, 20));
    app.add_option("--uv-bits", arguments.most.tex_coord, "The same")->check(CLI::Range(8, 16));
    app.add_option("--normal-bits", arguments.most.normal, "The same")->check(CLI::Range(7, 16));
    app.add_option("--pictures", arguments.folder, "Folder for the first view of everything");
    CLI11_PARSE(app, argc, argv);
    const auto done = vsplit::bench::run(arguments);
    if (!done)
    {
        std::fprintf(stderr, "bench_pictures: %s\n", vsplit::describe(done.error()).c_str());
        return vsplit::exit_status(done.error().code);
    }
    return 0;
}
