#pragma once

#include <iosfwd>
#include <string>
#include <vector>

namespace vsplit::test {

/// A line of tests/golden/streams.txt.
struct GoldenStream
{
    std::string name;
    std::string input;                 ///< From the root of the repository.
    std::vector<std::string> options;  ///< Of `vsplit encode`.

    /// Path of the file with the stream's name and an extension.
    [[nodiscard]] std::string path(const std::string& extension) const;
};

/// Prints the name.
std::ostream& operator<<(std::ostream& out, const GoldenStream& stream);

/// Reads the list; throws std::runtime_error when there is none.
[[nodiscard]] std::vector<GoldenStream> golden_streams();

}  // namespace vsplit::test
