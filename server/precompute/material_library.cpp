// Based on: Wavefront, "MTL material format", 1995; Exocortex, "Physically-Based Rendering extension
// for MTL", 2015; Karis, "Specular BRDF Reference", 2013 (roughness of an exponent).
#include "precompute/material_library.h"

#include "precompute/text_scan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <utility>

namespace vsplit::precompute {
namespace {

/// What a map statement says.
struct MapStatement
{
    std::string_view file;
    bool clamp = false;
    float strength = 1.0F;
    bool moved = false;  ///< The image is scaled or shifted.
};

std::optional<float> take_number(std::string_view& rest)
{
    const auto value = parse_real(take_token(rest));
    return value && std::abs(*value) < 1e30 ? std::optional(static_cast<float>(*value))
                                            : std::nullopt;
}

std::optional<float> take_unit(std::string_view& rest)
{
    const auto value = take_number(rest);
    return value ? std::optional(std::clamp(*value, 0.0F, 1.0F)) : std::nullopt;
}

/// Takes up to three numbers off the front.
void skip_numbers(std::string_view& rest, std::size_t most)
{
    for (std::size_t i = 0; i < most; ++i)
    {
        std::string_view probe = rest;
        if (!parse_real(take_token(probe)))
        {
            return;
        }
        rest = probe;
    }
}

/// Reads one option behind its name; false when there is no such option.
bool take_option(std::string_view option, std::string_view& rest, MapStatement& map)
{
    constexpr std::array<std::string_view, 7> kOneWord{
        "-blendu", "-blendv", "-cc", "-boost", "-texres", "-imfchan", "-type"};
    if (option == "-clamp")
    {
        map.clamp = take_token(rest) == "on";
        return true;
    }
    if (option == "-bm")
    {
        map.strength = take_number(rest).value_or(1.0F);
        return true;
    }
    if (option == "-o" || option == "-s" || option == "-t")
    {
        skip_numbers(rest, 3);
        map.moved = true;
        return true;
    }
    if (option == "-mm")
    {
        skip_numbers(rest, 2);
        return true;
    }
    const bool known = std::ranges::find(kOneWord, option) != kOneWord.end();
    if (known)
    {
        (void)take_token(rest);
    }
    return known;
}

MapStatement parse_map(std::string_view rest)
{
    MapStatement map;
    std::string_view probe = rest;
    for (auto token = take_token(probe); token.starts_with('-'); token = take_token(probe))
    {
        if (!take_option(token, probe, map))
        {
            break;
        }
        rest = probe;
    }
    const std::size_t begin = rest.find_first_not_of(" \t");
    const std::size_t end = rest.find_last_not_of(" \t");
    map.file = begin == rest.npos ? std::string_view() : rest.substr(begin, end - begin + 1);
    return map;
}

class LibraryReader
{
public:
    LibraryReader(ImageCollector& images, DroppedNotes& dropped)
        : images_(images), dropped_(dropped)
    {
    }

    std::vector<Material> read(std::string_view text)
    {
        LineReader lines(text);
        for (auto line = lines.next(); line; line = lines.next())
        {
            std::string_view rest = *line;
            const std::string keyword = lower_case(take_token(rest));
            if (keyword == "newmtl")
            {
                start(rest);
            }
            else if (!materials_.empty() && !keyword.empty() && !keyword.starts_with('#'))
            {
                read_statement(keyword, rest);
            }
        }
        return std::move(materials_);
    }

private:
    void start(std::string_view rest)
    {
        Material material;
        const std::size_t begin = std::min(rest.find_first_not_of(" \t"), rest.size());
        const std::size_t end = rest.find_last_not_of(" \t") + 1;
        material.name = begin < end ? std::string(rest.substr(begin, end - begin)) : "";
        material.metallic = 0.0F;
        materials_.push_back(std::move(material));
    }

    void read_statement(const std::string& keyword, std::string_view rest)
    {
        Material& material = materials_.back();
        if (keyword.starts_with("map_") || keyword == "bump" || keyword == "norm" ||
            keyword == "disp" || keyword == "decal" || keyword == "refl")
        {
            read_map(keyword, rest, material);
        }
        else if (keyword == "kd")
        {
            read_color(rest, std::span(material.base_color).first<3>());
        }
        else if (keyword == "ke")
        {
            read_color(rest, material.emissive);
        }
        else if (keyword == "ns")
        {
            const float exponent = std::max(take_number(rest).value_or(0.0F), 0.0F);
            // Karis: alpha^2 = 2 / (n + 2), and roughness is the square root of alpha.
            material.roughness = std::sqrt(std::sqrt(2.0F / (exponent + 2.0F)));
        }
        else if (keyword == "pr" || keyword == "pm")
        {
            float& factor = keyword == "pr" ? material.roughness : material.metallic;
            factor = take_unit(rest).value_or(factor);
        }
        else if (keyword == "d" || keyword == "tr")
        {
            read_alpha(keyword == "tr", rest, material);
        }
    }

    static void read_color(std::string_view rest, std::span<float, 3> color)
    {
        const auto first = take_unit(rest);
        if (!first)
        {
            return;
        }
        const auto second = take_unit(rest);
        color[0] = *first;
        color[1] = second.value_or(*first);  // one number is a grey
        color[2] = take_unit(rest).value_or(*first);
    }

    static void read_alpha(bool transparency, std::string_view rest, Material& material)
    {
        std::string_view probe = rest;
        if (take_token(probe) == "-halo")
        {
            rest = probe;
        }
        const auto value = take_unit(rest);
        if (value)
        {
            const float alpha = transparency ? 1.0F - *value : *value;
            material.base_color[3] = alpha;
            material.alpha_mode = alpha < 1.0F ? AlphaMode::Blend : AlphaMode::Opaque;
        }
    }

    void read_map(const std::string& keyword, std::string_view rest, Material& material)
    {
        const MapStatement map = parse_map(rest);
        const bool normal = keyword == "map_bump" || keyword == "bump" || keyword == "norm";
        if (!normal && keyword != "map_kd" && keyword != "map_ke")
        {
            dropped_.add("texture '" + keyword + "' of material '" + material.name + "'");
            return;
        }
        if (map.moved)
        {
            dropped_.add("scale and offset of a texture of material '" + material.name + "'");
        }
        TextureUse use;
        use.image = images_.add_file(map.file);
        use.wrap_u = map.clamp ? TextureWrap::Clamp : TextureWrap::Repeat;
        use.wrap_v = use.wrap_u;
        if (normal && use.image >= 0 && images_.info(use.image).channels < 3)
        {
            dropped_.add("height map of material '" + material.name + "'");
            return;
        }
        if (normal)
        {
            material.normal_texture = use;
            material.normal_scale = map.strength;
            return;
        }
        if (keyword == "map_kd")
        {
            material.base_color_texture = use;
            return;
        }
        material.emissive_texture = use;
        if (material.emissive == std::array{0.0F, 0.0F, 0.0F})
        {
            material.emissive = {1.0F, 1.0F, 1.0F};
        }
    }

    ImageCollector& images_;
    DroppedNotes& dropped_;
    std::vector<Material> materials_;
};

}  // namespace

std::vector<Material> read_material_library(
    std::string_view text, ImageCollector& images, DroppedNotes& dropped
)
{
    return LibraryReader(images, dropped).read(text);
}

}  // namespace vsplit::precompute
