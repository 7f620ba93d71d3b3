#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace vsplit::test {

/// Writes NAME.obj, NAME.mtl and NAME.png: two rings that hang in each other, of two objects and materials,
/// one with a texture that repeats and has seams, the other with colours of its vertices.
/// `side`: of the square texture, pixels; it is noisy, so that its stream is some hundred kB at 600.
/// Throws std::runtime_error when a file cannot be written.
void write_painted_model(
    const std::filesystem::path& folder, const std::string& name, std::uint32_t side
);

/// Writes a square texture of blocks of random colours. `seed`: which ones.
void write_noise(const std::filesystem::path& path, std::uint32_t side, unsigned seed);

}  // namespace vsplit::test
