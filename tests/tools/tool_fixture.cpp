#include "tools/tool_fixture.h"

#include "precompute/mesh_io.h"

#include <algorithm>
#include <cmath>
#include <fcntl.h>
#include <fstream>
#include <iterator>
#include <numbers>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace vsplit::test {
namespace {

std::string read_all(const std::filesystem::path& file)
{
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

[[noreturn]] void execute(
    const std::vector<std::string>& arguments, const std::string& out, const std::string& err
)
{
    std::vector<char*> argv;
    for (const std::string& argument : arguments)
    {
        argv.push_back(const_cast<char*>(argument.c_str()));
    }
    argv.push_back(nullptr);
    constexpr int kMode = 0600;
    ::dup2(::open("/dev/null", O_RDONLY), STDIN_FILENO);
    ::dup2(::open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, kMode), STDOUT_FILENO);
    ::dup2(::open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, kMode), STDERR_FILENO);
    ::execv(argv.front(), argv.data());
    ::_exit(127);
}

}  // namespace

IndexedMesh bumpy_torus(std::uint32_t around, std::uint32_t across)
{
    IndexedMesh mesh;
    constexpr double kTurn = 2.0 * std::numbers::pi;
    for (std::uint32_t i = 0; i < around; ++i)
    {
        for (std::uint32_t j = 0; j < across; ++j)
        {
            const double u = kTurn * i / around;
            const double v = kTurn * j / across;
            const double radius = 1.0 + 0.1 * std::sin(5.0 * u) * std::cos(3.0 * v);
            const double ring = 3.0 + radius * std::cos(v);
            mesh.positions.push_back({ring * std::cos(u), ring * std::sin(u), radius * std::sin(v)}
            );
            const std::uint32_t next_i = (i + 1) % around;
            const std::uint32_t next_j = (j + 1) % across;
            const std::uint32_t a = i * across + j;
            const std::uint32_t b = next_i * across + j;
            const std::uint32_t c = next_i * across + next_j;
            const std::uint32_t d = i * across + next_j;
            mesh.triangles.push_back({a, b, c});
            mesh.triangles.push_back({a, c, d});
        }
    }
    return mesh;
}

void VsplitTool::SetUp()
{
    const auto* const info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() /
              ("vsplit-" + std::to_string(::getpid()) + "-" + info->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
}

void VsplitTool::TearDown()
{
    std::filesystem::remove_all(folder_);
    std::filesystem::remove(folder_.string() + ".out");
    std::filesystem::remove(folder_.string() + ".err");
}

Finished VsplitTool::run(const std::vector<std::string>& arguments) const
{
    std::vector<std::string> all{VSPLIT_BIN_DIR "/vsplit"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const std::string out = folder_.string() + ".out";
    const std::string err = folder_.string() + ".err";
    const pid_t child = ::fork();
    if (child == 0)
    {
        execute(all, out, err);
    }
    int status = 0;
    rusage usage{};
    ::wait4(child, &status, 0, &usage);
    Finished finished;
    finished.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    finished.out = read_all(out);
    finished.err = read_all(err);
    finished.peak_bytes = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024U;
    return finished;
}

std::string VsplitTool::save(std::string_view name, std::string_view contents) const
{
    std::ofstream(path(name), std::ios::binary) << contents;
    return path(name);
}

std::string VsplitTool::load(std::string_view name) const
{
    return read_all(path(name));
}

nlohmann::json VsplitTool::encode_torus() const
{
    EXPECT_TRUE(precompute::write_mesh(path("torus.ply"), bumpy_torus()));
    const Finished encoded =
        run({"encode", path("torus.ply"), "-o", path("torus.vsplit"), "--json", "-"});
    EXPECT_EQ(encoded.status, 0) << encoded.err;
    return encoded.json();
}

std::vector<std::string> VsplitTool::files() const
{
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_))
    {
        names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

void VsplitTool::expect_one_line_error(const Finished& finished, int status)
{
    EXPECT_EQ(finished.status, status) << finished.err;
    EXPECT_THAT(finished.err, ::testing::MatchesRegex("vsplit: [^\n]+\n"));
    EXPECT_EQ(finished.out, "");
}

}  // namespace vsplit::test
