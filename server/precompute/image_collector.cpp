#include "precompute/image_collector.h"

#include "core/file_io.h"
#include "precompute/image_header.h"

#include <algorithm>
#include <system_error>
#include <utility>

namespace vsplit::precompute {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxCompanionBytes = std::uint64_t{1} << 30;

tl::unexpected<Error> outside(std::string_view name)
{
    return fail(
        ErrorCode::UnsupportedInput, "'" + std::string(name) + "' is not in the folder of the model"
    );
}

/// True when `path` is `folder` or lies below it; both without links and dots.
bool is_below(const fs::path& folder, const fs::path& path)
{
    const auto [end, unused] =
        std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
    return end == folder.end();
}

Result<std::vector<std::byte>> read_below(const fs::path& folder, std::string_view name)
{
    std::string portable(name);
    std::replace(portable.begin(), portable.end(), '\\', '/');
    const fs::path relative(portable);
    const bool climbs = std::find(relative.begin(), relative.end(), "..") != relative.end();
    if (portable.empty() || portable.find('\0') != portable.npos || relative.is_absolute() ||
        climbs)
    {
        return outside(name);
    }
    std::error_code error;
    const fs::path root = fs::canonical(folder.empty() ? fs::path(".") : folder, error);
    const fs::path found = error ? fs::path() : fs::canonical(root / relative, error);
    if (error)
    {
        return fail(ErrorCode::NotFound, "there is no file '" + std::string(name) + "'");
    }
    return is_below(root, found) ? read_file(found, kMaxCompanionBytes) : outside(name);
}

}  // namespace

ReadCompanion companions_in(std::filesystem::path folder)
{
    return [folder = std::move(folder)](std::string_view name) { return read_below(folder, name); };
}

std::int32_t ImageCollector::add_file(std::string_view name)
{
    if (const auto known = by_name_.find(name); known != by_name_.end())
    {
        return known->second;
    }
    auto bytes = read_(name);
    std::int32_t index = -1;
    if (bytes)
    {
        index = add_bytes(std::string(name), std::move(*bytes));
    }
    else
    {
        dropped_.add("image '" + std::string(name) + "': " + bytes.error().message);
    }
    by_name_.emplace(name, index);
    return index;
}

std::int32_t ImageCollector::add_bytes(std::string name, std::vector<std::byte> bytes)
{
    const auto header = read_image_header(bytes);
    if (!header)
    {
        dropped_.add(
            "image '" + name + "': it is no PNG or JPEG file of up to 32768 pixels a side"
        );
        return -1;
    }
    infos_.push_back({name, header->width, header->height, header->channels});
    images_.push_back({std::move(name), std::move(bytes)});
    return static_cast<std::int32_t>(images_.size() - 1);
}

void ImageCollector::finish(SourceModel& model)
{
    model.appearance.images = std::move(infos_);
    model.images = std::move(images_);
}

}  // namespace vsplit::precompute
