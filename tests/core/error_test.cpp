#include "core/error.h"

#include <gtest/gtest.h>

#include <set>
#include <string_view>

namespace vsplit {
namespace {

TEST(Error, EveryCodeHasANameOfItsOwn)
{
    std::set<std::string_view> names;
    int named = 0;
    for (unsigned code = 0; code < 200; ++code)
    {
        const auto name = error_name(static_cast<ErrorCode>(code));
        if (name != "unknown")
        {
            names.insert(name);
            ++named;
        }
    }
    EXPECT_GE(named, 29);
    EXPECT_EQ(static_cast<int>(names.size()), named);
}

TEST(Error, ExitStatusTellsTheKindOfFailure)
{
    EXPECT_EQ(exit_status(ErrorCode::Ok), 0);
    EXPECT_EQ(exit_status(ErrorCode::NotAMesh), 3);
    EXPECT_EQ(exit_status(ErrorCode::BadChecksum), 4);
    EXPECT_EQ(exit_status(ErrorCode::NotFound), 5);
    EXPECT_EQ(exit_status(ErrorCode::ConnectionLost), 6);
    EXPECT_EQ(exit_status(ErrorCode::Mismatch), 7);
    EXPECT_EQ(exit_status(ErrorCode::Internal), 1);
}

TEST(Error, DescriptionNamesTheOffsetOnlyWhenThereIsOne)
{
    EXPECT_EQ(describe({ErrorCode::BadChunk, "too long", 17}), "bad-chunk: too long (at byte 17)");
    EXPECT_EQ(describe({ErrorCode::NotFound, "no file"}), "not-found: no file");
}

}  // namespace
}  // namespace vsplit
