// The files that the vase is kept in.

#include "core/byte_writer.h"
#include "make_assets/vase.h"

#include <array>
#include <cstdio>
#include <map>
#include <span>

namespace vsplit::assets {
namespace {

constexpr std::uint32_t kPixels = 128;

/// CRC-32 of PNG (reflected polynomial 0xEDB88320).
std::uint32_t png_crc(std::span<const std::byte> bytes)
{
    std::uint32_t crc = 0xFFFFFFFF;
    for (const std::byte byte : bytes)
    {
        crc ^= static_cast<std::uint32_t>(byte);
        for (int i = 0; i < 8; ++i)
        {
            crc = crc >> 1 ^ (0xEDB88320U & (0U - (crc & 1U)));
        }
    }
    return ~crc;
}

void write_big_endian(ByteWriter& out, std::uint32_t number)
{
    for (int shift = 24; shift >= 0; shift -= 8)
    {
        out.write(static_cast<std::uint8_t>(number >> shift));
    }
}

void write_png_chunk(ByteWriter& out, const char* type, std::span<const std::byte> contents)
{
    ByteWriter body;
    body.write_bytes(std::as_bytes(std::span(type, 4)));
    body.write_bytes(contents);
    write_big_endian(out, static_cast<std::uint32_t>(contents.size()));
    out.write_bytes(body.view());
    write_big_endian(out, png_crc(body.view()));
}

/// Colour of a pixel: bands of glaze with dots between, plain clay below.
std::uint8_t texel(std::uint32_t x, std::uint32_t y)
{
    const std::uint32_t band = y / 8;
    if (y >= 77)
    {
        return static_cast<std::uint8_t>(12 + (x / 4 + y / 4) % 4);
    }
    const std::uint32_t dx = x % 16;
    const std::uint32_t dy = y % 8;
    const std::uint32_t distance = (dx - 8) * (dx - 8) + 4 * (dy - 4) * (dy - 4);
    return static_cast<std::uint8_t>(band % 3 == 1 && distance < 30 ? 10 + band % 2 : band);
}

/// The pixels, each row behind a zero, as PNG has it without filters.
std::vector<std::byte> png_rows()
{
    ByteWriter rows;
    for (std::uint32_t y = 0; y < kPixels; ++y)
    {
        rows.write(std::uint8_t{0});
        for (std::uint32_t x = 0; x < kPixels; x += 2)
        {
            rows.write(static_cast<std::uint8_t>(texel(x, y) << 4 | texel(x + 1, y)));
        }
    }
    return rows.take();
}

/// A zlib stream of one stored block. Precondition: below 64 KiB.
std::vector<std::byte> stored(std::span<const std::byte> bytes)
{
    ByteWriter out;
    out.write(std::uint8_t{0x78});
    out.write(std::uint8_t{0x01});
    out.write(std::uint8_t{1});
    out.write(static_cast<std::uint16_t>(bytes.size()));
    out.write(static_cast<std::uint16_t>(~bytes.size()));
    out.write_bytes(bytes);
    std::uint32_t a = 1;
    std::uint32_t b = 0;
    for (const std::byte byte : bytes)
    {
        a = (a + static_cast<std::uint32_t>(byte)) % 65521;
        b = (b + a) % 65521;
    }
    write_big_endian(out, b << 16 | a);
    return out.take();
}

/// Appends formatted numbers behind a word.
void append_line(std::string& text, const char* word, std::span<const float> numbers)
{
    text += word;
    for (const float number : numbers)
    {
        std::array<char, 32> digits{};
        std::snprintf(digits.data(), digits.size(), " %.4f", static_cast<double>(number));
        text += digits.data();
    }
    text += '\n';
}

}  // namespace

std::vector<std::byte> vase_png()
{
    ByteWriter out;
    for (const unsigned byte : {0x89U, 0x50U, 0x4EU, 0x47U, 0x0DU, 0x0AU, 0x1AU, 0x0AU})
    {
        out.write(static_cast<std::uint8_t>(byte));
    }
    ByteWriter header;
    write_big_endian(header, kPixels);
    write_big_endian(header, kPixels);
    for (const unsigned byte : {4U, 3U, 0U, 0U, 0U})  // 4 bits a pixel, a palette
    {
        header.write(static_cast<std::uint8_t>(byte));
    }
    write_png_chunk(out, "IHDR", header.view());
    ByteWriter palette;
    for (std::uint32_t i = 0; i < 16; ++i)
    {
        palette.write(static_cast<std::uint8_t>(
            i < 10   ? 30 + 8 * i
            : i < 12 ? 235
                     : 150 + 8 * (i - 12)
        ));
        palette.write(static_cast<std::uint8_t>(
            i < 10   ? 80 + 12 * i
            : i < 12 ? 215
                     : 90 + 6 * (i - 12)
        ));
        palette.write(static_cast<std::uint8_t>(
            i < 10   ? 150 - 6 * i
            : i < 12 ? 160
                     : 60 + 4 * (i - 12)
        ));
    }
    write_png_chunk(out, "PLTE", palette.view());
    write_png_chunk(out, "IDAT", stored(png_rows()));
    write_png_chunk(out, "IEND", {});
    return out.take();
}

std::string vase_mtl()
{
    return "# vsplit asset, MIT licence\n"
           "newmtl clay\nKd 0.9 0.8 0.7\nmap_Kd vase.png\n"
           "newmtl glaze\nKd 1 1 1\nKs 0.5 0.5 0.5\nNs 200\nmap_Kd vase.png\n";
}

std::string obj_text(
    const Surface& surface, const std::string& library, const std::vector<std::string>& materials
)
{
    std::string text = "# vsplit asset, MIT licence\nmtllib " + library + '\n';
    const SurfaceAttribute& coordinates = surface.attributes[0];
    const SurfaceAttribute& normals = surface.attributes[1];
    const SurfaceAttribute& colors = surface.attributes[2];
    for (std::size_t v = 0; v < surface.mesh.positions.size(); ++v)
    {
        const auto& p = surface.mesh.positions[v];
        const auto color = std::span(colors.values).subspan(3 * v, 3);
        const std::array numbers{
            static_cast<float>(p[0]),
            static_cast<float>(p[1]),
            static_cast<float>(p[2]),
            color[0],
            color[1],
            color[2]};
        append_line(text, "v", numbers);
    }
    // Corners that lie at one place of the image share a line.
    std::map<std::array<float, 2>, std::size_t> lines;
    std::vector<std::size_t> line_of(coordinates.size());
    for (std::size_t i = 0; i < coordinates.size(); ++i)
    {
        const std::array<float, 2> at{coordinates.values[2 * i], coordinates.values[2 * i + 1]};
        const auto [found, is_new] = lines.try_emplace(at, lines.size() + 1);
        line_of[i] = found->second;
        if (is_new)
        {
            append_line(text, "vt", std::array{at[0], 1.0F - at[1]});
        }
    }
    for (std::size_t i = 0; i < normals.size(); ++i)
    {
        append_line(text, "vn", std::span(normals.values).subspan(3 * i, 3));
    }
    for (std::size_t f = 0; f < surface.mesh.triangles.size(); ++f)
    {
        if (f == 0 || surface.groups[f] != surface.groups[f - 1])
        {
            text += "usemtl " + materials[surface.groups[f]] + '\n';
        }
        text += 'f';
        for (std::size_t k = 0; k < 3; ++k)
        {
            text += ' ' + std::to_string(surface.mesh.triangles[f][k] + 1) + '/' +
                    std::to_string(line_of[coordinates.corners[f][k]]) + '/' +
                    std::to_string(normals.corners[f][k] + 1);
        }
        text += '\n';
    }
    return text;
}

}  // namespace vsplit::assets
