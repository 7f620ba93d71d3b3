#include "net/model_name.h"

#include "net/test_streams.h"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <string>
#include <sys/stat.h>

namespace vsplit::net {
namespace {

const std::array<std::byte, 1> kAnything{};

class LocateModel : public testing::Test
{
protected:
    LocateModel()
    {
        folder_.write("root/cow.vsplit", kAnything);
        folder_.write("root/scans/bunny.vsplit", kAnything);
        folder_.write("root/scans/bunny.ply", kAnything);
        folder_.write("root/horse.off", kAnything);
        folder_.write("root/goat.om", kAnything);
        folder_.write("root/duck.obj", kAnything);
        folder_.write("root/duck.glb", kAnything);
        folder_.write("root/duck.png", kAnything);
        folder_.write("root/lamp.gltf", kAnything);
        folder_.write("root/notes.txt", kAnything);
        folder_.write("secret.vsplit", kAnything);
    }

    /// The path below the root that a name leads to, or the name of the error.
    [[nodiscard]] std::string found(const std::string& name) const
    {
        const auto location = locate_model(root_, name);
        return location ? location->path.lexically_relative(root_).string()
                        : std::string(error_name(location.error().code));
    }

    test::TemporaryFolder folder_;
    std::filesystem::path root_ = folder_.path() / "root";
};

TEST_F(LocateModel, FindsStreamsWithAndWithoutExtension)
{
    EXPECT_EQ(found("cow"), "cow.vsplit");
    EXPECT_EQ(found("cow.vsplit"), "cow.vsplit");
    EXPECT_EQ(found("scans/bunny"), "scans/bunny.vsplit");
}

TEST_F(LocateModel, TellsSourceMeshesFromStreams)
{
    EXPECT_EQ(found("scans/bunny.ply"), "scans/bunny.ply");
    EXPECT_TRUE(locate_model(root_, "scans/bunny.ply")->is_source_mesh);
    EXPECT_FALSE(locate_model(root_, "scans/bunny")->is_source_mesh);
    EXPECT_EQ(found("horse"), "horse.off");
    EXPECT_TRUE(locate_model(root_, "horse")->is_source_mesh);
    EXPECT_EQ(found("goat"), "goat.om");
    EXPECT_EQ(found("lamp"), "lamp.gltf");
    EXPECT_EQ(found("duck"), "duck.glb");
    EXPECT_EQ(found("duck.obj"), "duck.obj");
    EXPECT_TRUE(locate_model(root_, "duck.glb")->is_source_mesh);
}

TEST_F(LocateModel, NamesNeverLeaveTheRoot)
{
    for (const std::string name :
         {"../secret",
          "../secret.vsplit",
          "scans/../../secret",
          "scans/../cow",
          "./cow",
          "scans//bunny",
          "scans/",
          "/cow",
          "..",
          ".",
          "",
          "..\\secret",
          "scans\\bunny"})
    {
        EXPECT_EQ(found(name), "not-found") << name;
    }
    EXPECT_EQ(found((folder_.path() / "secret.vsplit").string()), "not-found");
    EXPECT_EQ(found(std::string("cow\0.vsplit", 11)), "not-found");
    EXPECT_EQ(found("cow\n"), "not-found");
    EXPECT_EQ(found(std::string(300, 'x')), "not-found");
}

TEST_F(LocateModel, OnlyStreamsAndMeshesAreServed)
{
    EXPECT_EQ(found("notes.txt"), "not-found");
    EXPECT_EQ(found("notes"), "not-found");
    EXPECT_EQ(found("duck.png"), "not-found");
    EXPECT_EQ(found("scans"), "not-found");
    EXPECT_EQ(found("missing"), "not-found");
    std::filesystem::create_directory(root_ / "folder.vsplit");
    EXPECT_EQ(found("folder"), "not-found");
    ASSERT_EQ(::mkfifo((root_ / "pipe.vsplit").c_str(), 0600), 0);
    EXPECT_EQ(found("pipe"), "not-found");
}

TEST_F(LocateModel, LinksAreFollowedInsideTheRootOnly)
{
    namespace fs = std::filesystem;
    fs::create_symlink(root_ / "cow.vsplit", root_ / "alias.vsplit");
    fs::create_symlink(folder_.path() / "secret.vsplit", root_ / "leak.vsplit");
    fs::create_directory_symlink(folder_.path(), root_ / "out");
    fs::create_symlink(root_ / "notes.txt", root_ / "disguised.vsplit");
    fs::create_symlink(root_ / "loop.vsplit", root_ / "loop.vsplit");
    EXPECT_EQ(found("alias"), "cow.vsplit");
    EXPECT_EQ(found("leak"), "not-found");
    EXPECT_EQ(found("out/secret"), "not-found");
    EXPECT_EQ(found("disguised"), "not-found");
    EXPECT_EQ(found("loop"), "not-found");
}

TEST_F(LocateModel, AFolderWhoseNameBeginsLikeTheRootIsOutside)
{
    folder_.write("root-private/cow.vsplit", kAnything);
    std::filesystem::create_directory_symlink(folder_.path() / "root-private", root_ / "sub");
    EXPECT_EQ(found("sub/cow"), "not-found");
}

}  // namespace
}  // namespace vsplit::net
