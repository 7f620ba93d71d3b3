#pragma once

#include "precompute/source_model.h"
#include "scene/appearance.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace vsplit::precompute {

/// Collects which triangles belong together. Not thread safe.
class GroupTable
{
public:
    /// Puts the triangles up to `triangles` that have no group yet into the group of a name and a
    /// material (-1: none), which is made when it is new.
    void assign(std::size_t triangles, const std::string& name, std::int32_t material);

    /// Hands groups over to a model. One group without name and material is none.
    void finish(SourceModel& model);

private:
    std::map<std::pair<std::string, std::int32_t>, std::uint32_t> known_;
    std::vector<FaceGroup> groups_;
    std::vector<std::uint32_t> by_triangle_;
};

}  // namespace vsplit::precompute
