#include "codec/error_scale.h"
#include "codec/golden_streams.h"
#include "codec/stream_header_writer.h"
#include "codec/stream_parts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace vsplit::test {
namespace {

using codec::LevelErrors;
using codec::replace_errors;

std::vector<LevelErrors> some_errors(const codec::StreamInfo& info)
{
    std::vector<LevelErrors> errors;
    for (std::size_t level = 0; level < info.levels.size(); ++level)
    {
        const double share = 0.07 / static_cast<double>(1 + level * level);
        errors.push_back({share * info.diagonal(), 5.0 * share * info.diagonal()});
    }
    return errors;
}

TEST(ReplaceErrors, ChangesTheErrorsAndNothingElse)
{
    const double step = std::exp2(1.0 / codec::kErrorStepsPerOctave) * (1.0 + 1e-9);
    for (const GoldenStream& stream : golden_streams())
    {
        SCOPED_TRACE(stream.name);
        const Bytes file = read_source_file(stream.path(".vsplit"));
        const auto before = codec::parse_stream_info(file).value();
        const auto errors = some_errors(before);
        const Bytes changed = replace_errors(file, errors).value();
        const auto after = codec::parse_stream_info(changed).value();
        ASSERT_EQ(after.levels.size(), errors.size());
        for (std::size_t level = 0; level < errors.size(); ++level)
        {
            // Rounded up by at most a step.
            ASSERT_GE(after.levels[level].rms_error, errors[level].rms * (1.0 - 1e-9));
            ASSERT_LE(after.levels[level].rms_error, errors[level].rms * step);
            ASSERT_GE(after.levels[level].max_error, errors[level].max * (1.0 - 1e-9));
            ASSERT_LE(after.levels[level].max_error, errors[level].max * step);
        }
        EXPECT_EQ(after.box_max, before.box_max);
        EXPECT_EQ(after.content_checksum, before.content_checksum);
        EXPECT_EQ(decode(changed).last, decode(file).last);
    }
}

TEST(ReplaceErrors, RefusesAnotherNumberOfLevels)
{
    const Bytes file = read_source_file(golden_streams().front().path(".vsplit"));
    auto errors = some_errors(codec::parse_stream_info(file).value());
    errors.emplace_back();
    EXPECT_EQ(replace_errors(file, errors).error().code, ErrorCode::Internal);
    errors.resize(errors.size() - 2);
    EXPECT_EQ(replace_errors(file, errors).error().code, ErrorCode::Internal);
}

TEST(ReplaceErrors, RefusesWhatIsNoStream)
{
    EXPECT_FALSE(replace_errors(Bytes(40), {}).has_value());
    EXPECT_FALSE(replace_errors({}, {}).has_value());
}

}  // namespace
}  // namespace vsplit::test
