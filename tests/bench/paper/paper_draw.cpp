// Draws mesh files with the client's renderer: frame rates, measured in turns, and pictures.
#include "gpu_buffers.h"
#include "image.h"
#include "precompute/mesh_io.h"
#include "renderer.h"
#include "view.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

namespace {

using namespace vsplit;

constexpr double kTurnPerFrame = 2.0 * std::numbers::pi / 180.0;
constexpr double kPictureAngle = -0.7;
constexpr std::size_t kWarmFrames = 3;

struct Arguments
{
    std::string reference;
    std::vector<std::string> meshes;
    client::RenderOptions render;
    std::string pictures;
    std::size_t frames = 0;
};

/// A mesh with a renderer of its own.
struct Drawn
{
    std::string path;
    IndexedMesh mesh;
    std::unique_ptr<client::Renderer> renderer;
    std::vector<double> wall;       ///< Milliseconds a frame.
    std::vector<double> processor;  ///< The same in processor time of this program.
};

/// Fills the arrays that the client keeps on the GPU with a whole mesh at once.
void fill(client::GpuBuffers& buffers, const IndexedMesh& mesh)
{
    std::vector<codec::TriangleUpdate> updates;
    for (std::uint32_t slot = 0; slot < mesh.triangles.size(); ++slot)
    {
        updates.push_back({slot, mesh.triangles[slot]});
    }
    codec::Step step;
    step.kind = codec::StepKind::Chunk;
    step.vertices = static_cast<std::uint32_t>(mesh.positions.size());
    step.faces = static_cast<std::uint32_t>(mesh.triangles.size());
    step.triangles = updates;
    buffers.apply(step, [&](std::uint32_t first, std::uint32_t count, std::span<float> out) {
        for (std::size_t i = 0; i < 3 * std::size_t{count}; ++i)
        {
            out[i] = static_cast<float>(mesh.positions[first + i / 3][i % 3]);
        }
    });
}

/// The camera of all pictures: framed by the reference's bounding box.
client::Turntable make_camera(const IndexedMesh& reference, const client::RenderOptions& render)
{
    std::array<double, 3> low = reference.positions.front();
    std::array<double, 3> high = low;
    for (const auto& point : reference.positions)
    {
        for (std::size_t k = 0; k < 3; ++k)
        {
            low[k] = std::min(low[k], point[k]);
            high[k] = std::max(high[k], point[k]);
        }
    }
    return {low, high, static_cast<double>(render.width) / render.height};
}

double diagonal(const IndexedMesh& mesh)
{
    double square = 0.0;
    for (std::size_t k = 0; k < 3; ++k)
    {
        const auto [low, high] =
            std::ranges::minmax(mesh.positions, {}, [k](const auto& point) { return point[k]; });
        square += (high[k] - low[k]) * (high[k] - low[k]);
    }
    return std::sqrt(square);
}

Result<Drawn> prepare(
    const std::string& path, const IndexedMesh& reference, const Arguments& wanted
)
{
    auto mesh = precompute::read_mesh(path);
    VSPLIT_TRY(mesh);
    auto renderer = client::Renderer::create(wanted.render);
    VSPLIT_TRY(renderer);
    client::GpuBuffers buffers(diagonal(reference));
    fill(buffers, *mesh);
    VSPLIT_TRY((*renderer)->reserve(
        static_cast<std::uint32_t>(mesh->positions.size()),
        static_cast<std::uint32_t>(mesh->triangles.size())
    ));
    (*renderer)->upload(buffers);
    return Drawn{path, std::move(*mesh), std::move(*renderer), {}, {}};
}

double median(std::vector<double> values)
{
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

void time_frame(Drawn& drawn, const client::View& view, bool counts)
{
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t spent = std::clock();
    drawn.renderer->draw(view);
    const double processor = 1e3 * static_cast<double>(std::clock() - spent) / CLOCKS_PER_SEC;
    const std::chrono::duration<double, std::milli> wall = std::chrono::steady_clock::now() - start;
    if (counts)
    {
        drawn.wall.push_back(wall.count());
        drawn.processor.push_back(processor);
    }
}

nlohmann::json to_json(const Drawn& drawn)
{
    nlohmann::json row{
        {"path", drawn.path},
        {"vertices", drawn.mesh.positions.size()},
        {"faces", drawn.mesh.triangles.size()},
    };
    if (!drawn.wall.empty())
    {
        row["wall_ms"] = median(drawn.wall);
        row["processor_ms"] = median(drawn.processor);
    }
    return row;
}

Result<nlohmann::json> run(const Arguments& wanted)
{
    const auto reference = precompute::read_mesh(wanted.reference);
    VSPLIT_TRY(reference);
    const client::Turntable camera = make_camera(*reference, wanted.render);
    auto rows = nlohmann::json::array();
    for (const std::string& path : wanted.meshes)
    {
        // One context at a time is current, so each mesh gets all its frames in one go.
        auto drawn = prepare(path, *reference, wanted);
        VSPLIT_TRY(drawn);
        for (std::size_t frame = 0; frame < (wanted.frames > 0 ? wanted.frames + kWarmFrames : 0);
             ++frame)
        {
            const double angle = kPictureAngle + kTurnPerFrame * static_cast<double>(frame);
            time_frame(*drawn, camera.view(angle), frame >= kWarmFrames);
        }
        if (!wanted.pictures.empty())
        {
            const auto image = drawn->renderer->picture(camera.view(kPictureAngle));
            VSPLIT_TRY(image);
            const auto name = std::filesystem::path(path).stem().string() + ".png";
            VSPLIT_TRY(client::write_png(std::filesystem::path(wanted.pictures) / name, *image));
        }
        rows.push_back(to_json(*drawn));
    }
    return rows;
}

}  // namespace

int main(int argc, char** argv)
{
    CLI::App app("Draws meshes: frame rates and pictures");
    Arguments wanted;
    app.add_option("REFERENCE", wanted.reference, "Mesh whose bounding box frames them all")
        ->required();
    app.add_option("MESH", wanted.meshes)->required();
    app.add_option("--width", wanted.render.width)->check(CLI::Range(16, 4096));
    app.add_option("--height", wanted.render.height)->check(CLI::Range(16, 4096));
    app.add_flag("--wireframe", wanted.render.wireframe, "Draw the grid");
    app.add_option("--frames", wanted.frames, "Frames to time, 0 for none");
    app.add_option("--pictures", wanted.pictures, "Folder for one PNG each");
    CLI11_PARSE(app, argc, argv);
    const auto rows = run(wanted);
    if (!rows)
    {
        std::fprintf(stderr, "paper_draw: %s\n", describe(rows.error()).c_str());
        return exit_status(rows.error().code);
    }
    std::puts(rows->dump().c_str());
    return 0;
}
