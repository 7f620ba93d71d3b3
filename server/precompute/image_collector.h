#pragma once

#include "core/result.h"
#include "precompute/source_model.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace vsplit::precompute {

/// Gives the contents of a file that a model refers to, by the name that it uses.
using ReadCompanion = std::function<Result<std::vector<std::byte>>(std::string_view name)>;

/// Reads companions from the folder of a model and below it, and nowhere else: absolute names, names
/// with "..", and links that lead outside are refused.
/// `folder`: where the model is. Result: a function whose errors are NotFound, IoError, InputTooLarge
/// and UnsupportedInput (the name leads outside). Safe on untrusted names.
[[nodiscard]] ReadCompanion companions_in(std::filesystem::path folder);

/// Gathers the images of a model, each of them once. Not thread safe. Safe on untrusted input.
class ImageCollector
{
public:
    /// `read`: gives the files; `dropped`: gets a note for every image that cannot be used. Both must
    /// outlive the collector.
    ImageCollector(const ReadCompanion& read, DroppedNotes& dropped)
        : read_(read), dropped_(dropped)
    {
    }

    /// Adds the image in a file. Result: its index, -1 when it cannot be used.
    std::int32_t add_file(std::string_view name);

    /// Adds an image by its bytes. `name`: for messages and for files made of it later. Result: its
    /// index, -1 when it is neither PNG nor JPEG.
    std::int32_t add_bytes(std::string name, std::vector<std::byte> bytes);

    /// What is known of an image. Precondition: `image` came from add_file() or add_bytes(), is not -1.
    [[nodiscard]] const ImageInfo& info(std::int32_t image) const
    {
        return infos_[static_cast<std::size_t>(image)];
    }

    /// Hands everything over to a model.
    void finish(SourceModel& model);

private:
    const ReadCompanion& read_;
    DroppedNotes& dropped_;
    std::vector<ImageInfo> infos_;
    std::vector<SourceImage> images_;
    std::map<std::string, std::int32_t, std::less<>> by_name_;
};

}  // namespace vsplit::precompute
