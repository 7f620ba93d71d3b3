#pragma once

#include "mesh/indexed_mesh.h"

#include <array>
#include <string_view>

namespace vsplit::assets {

/// A long bone, about 2 units along x, with two condyles at each end: one closed surface of genus 0.
[[nodiscard]] IndexedMesh make_bone();

/// A cow-like animal looking along x, y up, about 3 units long: one closed surface of genus 0.
[[nodiscard]] IndexedMesh make_beast();

/// A bearing bracket with sharp edges, millimetres, y up: one closed surface of genus 3 (two bolt
/// holes and the bore), triangulated as a CAD system does: coarse where it is flat.
[[nodiscard]] IndexedMesh make_bracket();

/// An island in the sea, mountains round a lake, y up, 4 x 4 units: one sheet with one boundary.
[[nodiscard]] IndexedMesh make_terrain();

/// Two linked rings, one of them with a pearl: two closed surfaces of genus 1.
[[nodiscard]] IndexedMesh make_pair();

/// A starfish with everything wrong that repair has to see to; see assets/README.md for the list.
[[nodiscard]] IndexedMesh make_dirty();

/// A model and the name of its file, without extension.
struct Model
{
    std::string_view name;
    IndexedMesh (*make)();
};

/// All models.
inline constexpr std::array<Model, 6> kModels{{
    {"bone", make_bone},
    {"beast", make_beast},
    {"bracket", make_bracket},
    {"terrain", make_terrain},
    {"pair", make_pair},
    {"dirty", make_dirty},
}};

}  // namespace vsplit::assets
