#pragma once

#include "precompute/collapse_mesh.h"

namespace vsplit::bench {

using precompute::cross;
using precompute::dot;
using precompute::operator*;
using precompute::operator+;
using precompute::operator-;
using precompute::Vector3;

}  // namespace vsplit::bench
