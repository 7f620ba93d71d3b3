#include "integration/painted_model.h"

#include "core/file_io.h"
#include "image/image_file.h"

#include <cmath>
#include <fstream>
#include <numbers>
#include <random>
#include <stdexcept>
#include <vector>

namespace vsplit::test {

namespace fs = std::filesystem;

namespace {

constexpr int kAround = 40;
constexpr int kAcross = 20;

/// A ring round the z axis, moved and turned for the second one. `first`: vertices before it.
void write_ring(std::ofstream& file, bool second, int first)
{
    constexpr double kTurn = 2.0 * std::numbers::pi;
    for (int i = 0; i < kAround * kAcross; ++i)
    {
        const double u = kTurn * (i / kAcross) / kAround;
        const double v = kTurn * (i % kAcross) / kAcross;
        const double radius = 3.0 + std::cos(v);
        const double x = radius * std::cos(u);
        const double y = radius * std::sin(u);
        const double z = std::sin(v);
        file << "v " << (second ? x + 3.0 : x) << ' ' << (second ? z : y) << ' '
             << (second ? y : z);
        const double red = second ? 0.5 + 0.5 * std::cos(u) : 1.0;
        const double green = second ? 0.5 + 0.5 * std::sin(v) : 1.0;
        file << ' ' << red << ' ' << green << " 1\n";
    }
    const int row = kAcross + 1;
    for (int i = 0; !second && i < (kAround + 1) * row; ++i)
    {
        file << "vt " << 2.0 * (i / row) / kAround << ' ' << 1.0 * (i % row) / kAcross << '\n';
    }
    const auto corner = [&](int around, int across) {
        file << ' ' << first + around % kAround * kAcross + across % kAcross + 1;
        if (!second)
        {
            file << '/' << around * row + across + 1;
        }
    };
    for (int i = 0; i < kAround * kAcross; ++i)
    {
        const int a = i / kAcross;
        const int b = i % kAcross;
        file << 'f';
        corner(a, b);
        corner(a + 1, b);
        corner(a + 1, b + 1);
        corner(a, b + 1);
        file << '\n';
    }
}

}  // namespace

void write_noise(const fs::path& path, std::uint32_t side, unsigned seed)
{
    constexpr std::uint32_t kBlock = 4;
    std::mt19937 random(seed);
    std::vector<std::uint8_t> row;
    Raster raster;
    raster.width = side;
    raster.height = side;
    raster.channels = 3;
    for (std::uint32_t y = 0; y < side; ++y)
    {
        if (y % kBlock == 0)
        {
            row.clear();
            for (std::uint32_t x = 0; x < side; ++x)
            {
                const std::uint32_t color = x % kBlock == 0 ? random() : 0;
                for (std::uint32_t channel = 0; channel < 3; ++channel)
                {
                    row.push_back(
                        x % kBlock == 0 ? static_cast<std::uint8_t>(color >> (8 * channel))
                                        : row[row.size() - 3]
                    );
                }
            }
        }
        raster.pixels.insert(raster.pixels.end(), row.begin(), row.end());
    }
    const auto png = image::write_png(raster);
    if (!png || !write_file_atomically(path, *png))
    {
        throw std::runtime_error("cannot write " + path.string());
    }
}

void write_painted_model(const fs::path& folder, const std::string& name, std::uint32_t side)
{
    write_noise(folder / (name + ".png"), side, 1);
    std::ofstream(folder / (name + ".mtl"))
        << "newmtl noise\nmap_Kd " << name << ".png\nnewmtl plain\nKd 1 0.9 0.8\n";
    std::ofstream file(folder / (name + ".obj"));
    file << "mtllib " << name << ".mtl\no first\nusemtl noise\n";
    write_ring(file, false, 0);
    file << "o second\nusemtl plain\n";
    write_ring(file, true, kAround * kAcross);
    file.close();
    if (!file)
    {
        throw std::runtime_error("cannot write " + name + ".obj");
    }
}

}  // namespace vsplit::test
