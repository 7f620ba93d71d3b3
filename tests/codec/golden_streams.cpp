#include "codec/golden_streams.h"

#include <fstream>
#include <ostream>
#include <sstream>
#include <stdexcept>

namespace vsplit::test {
namespace {

constexpr const char* kFolder = VSPLIT_SOURCE_DIR "/tests/golden/";

}  // namespace

std::string GoldenStream::path(const std::string& extension) const
{
    return kFolder + name + extension;
}

std::ostream& operator<<(std::ostream& out, const GoldenStream& stream)
{
    return out << stream.name;
}

std::vector<GoldenStream> golden_streams()
{
    std::ifstream list(std::string(kFolder) + "streams.txt");
    std::vector<GoldenStream> streams;
    for (std::string line; std::getline(list, line);)
    {
        if (line.empty() || line.front() == '#')
        {
            continue;
        }
        std::istringstream words(line);
        GoldenStream stream;
        words >> stream.name >> stream.input;
        for (std::string word; words >> word;)
        {
            stream.options.push_back(word);
        }
        streams.push_back(std::move(stream));
    }
    if (streams.empty())
    {
        throw std::runtime_error("tests/golden/streams.txt lists no stream");
    }
    return streams;
}

}  // namespace vsplit::test
