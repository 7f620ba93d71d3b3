#include "integration/model_folder.h"

#include "core/file_io.h"
#include "integration/child_process.h"

#include <chrono>
#include <fstream>
#include <random>
#include <stdexcept>
#include <unistd.h>

namespace vsplit::test {

namespace fs = std::filesystem;

namespace {

void write_terrain(const fs::path& path, int side)
{
    std::mt19937 random(9);
    std::ofstream file(path);
    file << "OFF\n" << side * side << " " << 2 * (side - 1) * (side - 1) << " 0\n";
    for (int i = 0; i < side * side; ++i)
    {
        const double height = static_cast<double>(random() % 1000) / 500.0;
        file << i % side << " " << i / side << " " << height << "\n";
    }
    for (int y = 0; y + 1 < side; ++y)
    {
        for (int x = 0; x + 1 < side; ++x)
        {
            const int corner = y * side + x;
            file << "3 " << corner << " " << corner + 1 << " " << corner + side << "\n";
            file << "3 " << corner + 1 << " " << corner + side + 1 << " " << corner + side << "\n";
        }
    }
}

}  // namespace

void ModelFolderTest::SetUp()
{
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / ("vsplit-" + std::string(test->test_suite_name()) + "-" +
                                           test->name() + "-" + std::to_string(::getpid()));
    root_ = folder_ / "root";
    logs_ = folder_ / "logs";
    fs::create_directories(root_);
    fs::create_directories(logs_);
}

void ModelFolderTest::TearDown()
{
    fs::remove_all(folder_);
}

fs::path ModelFolderTest::asset(const std::string& file)
{
    return fs::path(VSPLIT_SOURCE_DIR) / "assets" / file;
}

EncodedModel ModelFolderTest::encode(const std::string& file, const std::string& name) const
{
    return encode_file(asset(file), name);
}

EncodedModel ModelFolderTest::encode_large(const std::string& name) const
{
    write_terrain(folder_ / "terrain.off", 150);
    return encode_file(folder_ / "terrain.off", name, {"--position-bits", "20"});
}

EncodedModel ModelFolderTest::encode_file(
    const fs::path& mesh, const std::string& name, const std::vector<std::string>& options
) const
{
    EncodedModel model;
    model.path = root_ / (name + ".vsplit");
    std::vector<std::string> arguments{
        program("vsplit"), "encode", mesh.string(), "-o", model.path.string()};
    arguments.insert(arguments.end(), options.begin(), options.end());
    // Large textures take a while with sanitizers on a machine that has other work.
    const auto encoder = run(arguments, logs_, std::chrono::minutes(5));
    if (encoder.status != 0)
    {
        throw std::runtime_error("vsplit encode " + mesh.string() + ": " + encoder.errors);
    }
    model.bytes = read_file(model.path).value();
    model.info = codec::parse_stream_info(model.bytes).value();
    return model;
}

}  // namespace vsplit::test
