#include "integration/model_folder.h"

#include "core/file_io.h"
#include "integration/child_process.h"

#include <stdexcept>
#include <unistd.h>

namespace vsplit::test {

namespace fs = std::filesystem;

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
    EncodedModel model;
    model.path = root_ / (name + ".vsplit");
    const auto encoder =
        run({program("vsplit"), "encode", asset(file).string(), "-o", model.path.string()}, logs_);
    if (encoder.status != 0)
    {
        throw std::runtime_error("vsplit encode " + file + ": " + encoder.errors);
    }
    model.bytes = read_file(model.path).value();
    model.info = codec::parse_stream_info(model.bytes).value();
    return model;
}

}  // namespace vsplit::test
