#include "net/model_name.h"

#include "wire/message.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

namespace vsplit::net {
namespace {

constexpr std::string_view kStreamExtension = ".vsplit";
/// Models with everything in one file come first: that is what a name without extension means.
constexpr std::array<std::string_view, 7> kSourceExtensions = {
    ".glb", ".gltf", ".ply", ".obj", ".off", ".stl", ".om"};

bool is_source_name(const std::filesystem::path& path)
{
    const std::string extension = path.extension().string();
    return std::find(kSourceExtensions.begin(), kSourceExtensions.end(), extension) !=
           kSourceExtensions.end();
}

bool is_below(const std::filesystem::path& root, const std::filesystem::path& path)
{
    const auto parts = std::mismatch(root.begin(), root.end(), path.begin(), path.end());
    return parts.first == root.end() && parts.second != path.end();
}

std::vector<std::string> candidates(std::string_view name)
{
    const std::string given(name);
    std::vector<std::string> names;
    if (given.ends_with(kStreamExtension) || is_source_name(given))
    {
        names.push_back(given);
    }
    names.push_back(given + std::string(kStreamExtension));
    for (const std::string_view extension : kSourceExtensions)
    {
        names.push_back(given + std::string(extension));
    }
    return names;
}

std::optional<ModelLocation> locate(const std::filesystem::path& root, const std::string& name)
{
    std::error_code error;
    const auto path = std::filesystem::weakly_canonical(root / name, error);
    if (error || !is_below(root, path) || !std::filesystem::is_regular_file(path, error))
    {
        return std::nullopt;
    }
    // What a link leads to decides, so that no name can make another kind of file look like a stream.
    const bool source = is_source_name(path);
    if (!source && path.extension() != kStreamExtension)
    {
        return std::nullopt;
    }
    return ModelLocation{path, source};
}

}  // namespace

bool is_valid_model_name(std::string_view name)
{
    if (name.empty() || !wire::is_valid_text(name) || name.find('\\') != std::string_view::npos)
    {
        return false;
    }
    while (true)
    {
        const std::size_t slash = name.find('/');
        const std::string_view part = name.substr(0, slash);
        if (part.empty() || part == "." || part == "..")
        {
            return false;
        }
        if (slash == std::string_view::npos)
        {
            return true;
        }
        name.remove_prefix(slash + 1);
    }
}

Result<ModelLocation> locate_model(const std::filesystem::path& root, std::string_view name)
{
    if (is_valid_model_name(name))
    {
        for (const std::string& candidate : candidates(name))
        {
            if (auto location = locate(root, candidate))
            {
                return std::move(*location);
            }
        }
    }
    return fail(
        ErrorCode::NotFound, "there is no model '" + std::string(name) + "' on this server"
    );
}

}  // namespace vsplit::net
