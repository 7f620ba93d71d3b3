// A model with parts, materials, colours and a texture on its way from the encoder to the screen.
#include "core/file_io.h"
#include "image/image_file.h"
#include "image/texture_layout.h"
#include "integration/cutting_proxy.h"
#include "integration/model_folder.h"
#include "integration/painted_model.h"
#include "integration/server_process.h"
#include "precompute/surface_io.h"
#include "surface_picture.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <fstream>
#include <future>
#include <optional>

namespace vsplit::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr std::uint32_t kSide = 520;  // Three groups: up to 256, 512 and 1024 pixels.
constexpr milliseconds kLong{180000};

class Painted : public ModelFolderTest
{
protected:
    /// Encodes the painted model; every test takes the same one.
    [[nodiscard]] EncodedModel encode_painted() const
    {
        write_painted_model(folder_, "rings", kSide);
        return encode_file(folder_ / "rings.obj", "rings");
    }

    /// Arguments of a vsplit-pda with memory for everything, which draws little.
    [[nodiscard]] std::vector<std::string> command(
        std::uint16_t port, const std::string& model, const std::vector<std::string>& options = {}
    ) const
    {
        const fs::path device = folder_ / "device.json";
        std::ofstream(device) << R"({"name": "test", "width": 256, "height": 256,)"
                              << R"("memory_bytes": 100000000, "frame_budget_ms": 100,)"
                              << R"("texture_limit": 1024})";
        std::vector<std::string> arguments{
            program("vsplit-pda"), ServerProcess::url(port, model), "--frames", "1", "--json", "-"};
        const bool own = std::ranges::find(options, "--device") != options.end();
        if (!own)
        {
            arguments.insert(arguments.end(), {"--device", device.string()});
        }
        arguments.insert(arguments.end(), options.begin(), options.end());
        return arguments;
    }

    /// Runs it to its end and returns its report.
    [[nodiscard]] json show(
        std::uint16_t port, const std::string& model, const std::vector<std::string>& options = {}
    ) const
    {
        const auto pda = run(command(port, model, options), logs_, kLong);
        EXPECT_EQ(pda.status, 0) << pda.errors;
        return json::parse(pda.output, nullptr, false);
    }

    [[nodiscard]] static fs::path last_picture(const fs::path& folder, const EncodedModel& model)
    {
        return folder / ("level-00" + std::to_string(model.info.levels.back().level) + ".png");
    }
};

/// Bytes of chunks of a kind; of textures only those that a limit asks for.
std::uint64_t bytes_of(
    const codec::StreamInfo& info, proto::ChunkKind kind, std::uint32_t texture_limit = 1U << 20U
)
{
    std::uint64_t sum = 0;
    for (const codec::ChunkInfo& chunk : info.chunks)
    {
        const bool wanted = kind != proto::ChunkKind::Texture ||
                            image::texture_chunk_wanted(chunk.tag, texture_limit);
        sum += chunk.kind == kind && wanted ? chunk.bytes : 0;
    }
    return sum;
}

Raster load(const fs::path& path)
{
    return image::read_image(read_file(path).value()).value();
}

/// The mean difference of two pictures' channels, 0 .. 255.
double difference(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b)
{
    double sum = a.size() == b.size() ? 0.0 : 1e9;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    {
        sum += std::abs(static_cast<double>(a[i]) - static_cast<double>(b[i]));
    }
    return sum / static_cast<double>(std::max<std::size_t>(a.size(), 1));
}

/// Draws a model file as vsplit-pda draws the last level of a stream.
Raster picture_of(const fs::path& path, const codec::StreamInfo& info)
{
    const auto model = precompute::read_surface(path).value();
    std::vector<Raster> images;
    for (const SourceImage& image : model.images)
    {
        images.push_back(image::read_image(image.bytes).value());
    }
    const client::Turntable table(info.box_min, info.box_max, 1.0);
    auto picture = client::surface_picture(
                       client::make_surface_arrays(model.surface, &model.appearance),
                       &model.appearance,
                       images,
                       table.view(-0.7),
                       {256, 256}
    )
                       .value();
    return {picture.width, picture.height, 3, std::move(picture.pixels)};
}

TEST_F(Painted, CountsShapeAttributesAndTexturesApart)
{
    const auto model = encode_painted();
    const ServerProcess server(root_, logs_);
    const auto report = show(server.port(), "rings");
    ASSERT_EQ(report.at("levels").size(), model.info.levels.size());
    std::uint64_t attributes = 0;
    std::uint64_t textures = 0;
    for (const auto& level : report.at("levels"))
    {
        attributes += level.at("attribute_bytes").get<std::uint64_t>();
        textures += level.at("texture_bytes").get<std::uint64_t>();
        EXPECT_EQ(
            level.at("chunk_bytes").get<std::uint64_t>(),
            level.at("geometry_bytes").get<std::uint64_t>() +
                level.at("attribute_bytes").get<std::uint64_t>() +
                level.at("texture_bytes").get<std::uint64_t>()
        );
    }
    EXPECT_EQ(attributes, bytes_of(model.info, proto::ChunkKind::Attributes));
    EXPECT_EQ(
        textures,
        bytes_of(model.info, proto::ChunkKind::Texture) +
            bytes_of(model.info, proto::ChunkKind::Appearance)
    );
    EXPECT_GT(report.at("levels")[0].at("attribute_bytes"), 0) << "the first image has colours";
    const auto& totals = report.at("totals");
    EXPECT_EQ(totals.at("payload_bytes"), model.bytes.size());
    EXPECT_EQ(totals.at("complete"), true);
    EXPECT_GE(totals.at("images"), 1);
}

TEST_F(Painted, ShowsTheLastLevelAsTheDecodedModelLooks)
{
    const auto model = encode_painted();
    const ServerProcess server(root_, logs_);
    const fs::path shots = folder_ / "shots";
    ASSERT_EQ(
        show(server.port(), "rings", {"--screenshots", shots.string()}).at("totals").at("complete"),
        true
    );
    const Raster shown = load(last_picture(shots, model));
    ASSERT_EQ(shown.channels, 3);
    const Raster empty = load(shots / "level-000.png");
    EXPECT_GT(difference(shown.pixels, empty.pixels), 1.0) << "levels look different";
    for (const std::string extension : {"glb", "obj"})
    {
        const fs::path decoded = folder_ / ("decoded." + extension);
        const auto tool = run(
            {program("vsplit"), "decode", model.path.string(), "-o", decoded.string()}, logs_, kLong
        );
        ASSERT_EQ(tool.status, 0) << tool.errors;
        const Raster expected = picture_of(decoded, model.info);
        EXPECT_LT(difference(shown.pixels, expected.pixels), 0.5) << extension;
    }
}

TEST_F(Painted, KeepsTexturesWithinThePlanOfTheDevice)
{
    const auto model = encode_painted();
    const ServerProcess server(root_, logs_);
    for (const std::uint64_t memory : {50'000'000, 6'000'000, 4'000'000})
    {
        SCOPED_TRACE(memory);
        const fs::path device = folder_ / "small.json";
        std::ofstream(device) << R"({"width": 256, "height": 256, "frame_budget_ms": 100,)"
                              << R"("texture_limit": 1024, "memory_bytes": )" << memory << "}";
        const auto report = show(server.port(), "rings", {"--device", device.string()});
        const auto& plan = report.at("memory");
        EXPECT_LE(plan.at("planned_bytes"), memory);
        EXPECT_EQ(plan.at("texture_limit").get<std::uint32_t>() < 1024, memory < 50'000'000);
        for (const auto& level : report.at("levels"))
        {
            EXPECT_LE(level.at("texture_memory_bytes"), plan.at("texture_planned_bytes"));
        }
        EXPECT_EQ(
            report.at("levels").back().at("texture_memory_bytes") > 0, plan.at("texture_limit") > 0
        );
    }
}

TEST_F(Painted, LeavesOutTexturesThatAreTooLargeAndAttributesThatAreUnwanted)
{
    const auto model = encode_painted();
    const ServerProcess server(root_, logs_);
    const std::uint64_t all = bytes_of(model.info, proto::ChunkKind::Texture);
    const std::uint64_t small = bytes_of(model.info, proto::ChunkKind::Texture, 256);
    // What is on its way when the header has come: in the kernels and in the client's queue.
    constexpr std::uint64_t kOnItsWay = 110'000;
    ASSERT_GT(all - small, kOnItsWay + kOnItsWay / 2) << "the texture is large enough to tell";
    const std::vector<std::string> slow{"--link", "160:5"};
    auto options = slow;
    options.insert(options.end(), {"--texture-limit", "256"});
    const auto limited = show(server.port(), "rings", options);
    EXPECT_EQ(limited.at("totals").at("complete"), true);
    EXPECT_EQ(limited.at("memory").at("texture_limit"), 256);
    EXPECT_LE(
        limited.at("totals").at("payload_bytes"), model.bytes.size() - (all - small) + kOnItsWay
    );

    options = slow;
    options.insert(options.end(), {"--no-attributes"});
    const auto bare = show(server.port(), "rings", options);
    EXPECT_EQ(bare.at("totals").at("complete"), true);
    EXPECT_LE(bare.at("totals").at("payload_bytes"), model.bytes.size() - all + kOnItsWay);
    EXPECT_EQ(bare.at("totals").at("images"), 0);
}

TEST_F(Painted, GoesOnInTheMiddleOfATextureWhenTheServerIsKilled)
{
    const auto model = encode_painted();
    const auto longest =
        std::ranges::max_element(model.info.chunks, {}, [](const codec::ChunkInfo& chunk) {
            return chunk.kind == proto::ChunkKind::Texture ? chunk.bytes : 0;
        });
    ASSERT_EQ(longest->kind, proto::ChunkKind::Texture);
    std::optional<ServerProcess> server(std::in_place, root_, logs_);
    const auto port = server->port();
    const fs::path whole = folder_ / "whole";
    ASSERT_FALSE(show(port, "rings", {"--screenshots", whole.string()}).is_discarded());

    std::promise<void> killed;
    const CuttingProxy proxy(port, {longest->offset + longest->bytes / 2}, [&] {
        server->process().signal(SIGKILL);
        static_cast<void>(server->process().wait(seconds(60)));
        killed.set_value();
    });
    const fs::path cut = folder_ / "cut";
    ChildProcess pda(command(proxy.port(), "rings", {"--screenshots", cut.string()}), logs_);
    ASSERT_EQ(killed.get_future().wait_for(seconds(120)), std::future_status::ready);
    server.emplace(root_, logs_, std::vector<std::string>{}, port);
    ASSERT_EQ(pda.wait(kLong), 0) << pda.errors();
    const auto totals = json::parse(pda.output()).at("totals");
    EXPECT_GE(totals.at("reconnects"), 1);
    EXPECT_EQ(totals.at("complete"), true);
    EXPECT_EQ(totals.at("payload_bytes"), model.bytes.size());
    for (const auto& level : model.info.levels)
    {
        const std::string name = "level-00" + std::to_string(level.level) + ".png";
        EXPECT_EQ(load(whole / name), load(cut / name)) << name;
    }
}

TEST_F(Painted, StopsWhereItIsToldTo)
{
    const auto model = encode_painted();
    const ServerProcess server(root_, logs_);
    const auto first = show(server.port(), "rings", {"--level", "0"});
    EXPECT_EQ(first.at("levels").size(), 1U);
    EXPECT_EQ(first.at("levels")[0].at("vertices"), model.info.levels[0].vertices);
    EXPECT_GT(first.at("totals").at("attribute_bytes"), 0);
    EXPECT_EQ(first.at("totals").at("complete"), false);

    // The base comes however little is asked for, then without its attributes.
    const auto base = show(server.port(), "rings", {"--bytes", "1"});
    EXPECT_EQ(base.at("levels").size(), 1U);
    EXPECT_EQ(
        base.at("totals").at("payload_bytes"),
        model.info.chunks[0].offset + model.info.chunks[0].bytes
    );
    EXPECT_EQ(base.at("totals").at("attribute_bytes"), 0);
    const auto faces = show(server.port(), "rings", {"--faces", "1"});
    EXPECT_EQ(faces.at("levels").size(), 1U);
    EXPECT_GT(faces.at("totals").at("attribute_bytes"), 0);

    const std::uint64_t most = model.bytes.size() / 2;
    const auto half = show(server.port(), "rings", {"--bytes", std::to_string(most)});
    EXPECT_LE(half.at("totals").at("payload_bytes"), most);
    EXPECT_GT(half.at("totals").at("texture_bytes"), 0);
    EXPECT_EQ(half.at("totals").at("complete"), false);
}

TEST_F(Painted, IsEncodedByTheDaemonWithTheFilesBesideItAndAgainWhenTheyChange)
{
    write_painted_model(root_, "rings", 64);
    const fs::path cache = folder_ / "cache";
    const ServerProcess server(root_, logs_, {"--cache", cache.string()});
    const auto before = show(server.port(), "rings.obj", {"--no-render"}).at("totals");
    EXPECT_GT(before.at("texture_bytes"), 500);
    EXPECT_EQ(
        show(server.port(), "rings.obj", {"--no-render"}).at("totals").at("payload_bytes"),
        before.at("payload_bytes")
    );
    write_noise(root_ / "rings.png", 128, 2);
    const auto after = show(server.port(), "rings.obj", {"--no-render"}).at("totals");
    EXPECT_GT(after.at("texture_bytes"), before.at("texture_bytes"));
    EXPECT_EQ(after.at("geometry_bytes"), before.at("geometry_bytes"));
}

TEST_F(Painted, IsServedAsGlb)
{
    write_painted_model(folder_, "rings", 64);
    const auto model = encode_file(folder_ / "rings.obj", "rings");
    const auto tool = run(
        {program("vsplit"), "decode", model.path.string(), "-o", (root_ / "again.glb").string()},
        logs_
    );
    ASSERT_EQ(tool.status, 0) << tool.errors;
    const fs::path cache = folder_ / "cache";
    const ServerProcess server(root_, logs_, {"--cache", cache.string()});
    const auto totals = show(server.port(), "again.glb", {"--no-render"}).at("totals");
    EXPECT_EQ(totals.at("complete"), true);
    EXPECT_GT(totals.at("attribute_bytes"), 0);
    EXPECT_GT(totals.at("texture_bytes"), 500);
}

TEST_F(Painted, WithABrokenImageIsRefusedWithItsNameAndTheDaemonGoesOn)
{
    write_painted_model(root_, "rings", 64);
    auto png = read_file(root_ / "rings.png").value();
    png.resize(png.size() / 2);
    ASSERT_TRUE(write_file_atomically(root_ / "rings.png", png).has_value());
    const fs::path cache = folder_ / "cache";
    const ServerProcess server(root_, logs_, {"--cache", cache.string()});
    const auto refused = run(command(server.port(), "rings", {"--no-render"}), logs_, kLong);
    EXPECT_NE(refused.status, 0);
    EXPECT_NE(refused.errors.find("rings.png"), std::string::npos) << refused.errors;
    EXPECT_EQ(refused.errors.find(root_.string()), std::string::npos) << refused.errors;
    write_noise(root_ / "rings.png", 64, 1);
    EXPECT_EQ(show(server.port(), "rings", {"--no-render"}).at("totals").at("complete"), true);
}

}  // namespace
}  // namespace vsplit::test
