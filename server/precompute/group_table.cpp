#include "precompute/group_table.h"

namespace vsplit::precompute {

void GroupTable::assign(std::size_t triangles, const std::string& name, std::int32_t material)
{
    if (triangles <= by_triangle_.size())
    {
        return;
    }
    const auto next = static_cast<std::uint32_t>(groups_.size());
    const auto [entry, is_new] = known_.try_emplace({name, material}, next);
    if (is_new)
    {
        groups_.push_back({name, material});
    }
    by_triangle_.resize(triangles, entry->second);
}

void GroupTable::finish(SourceModel& model)
{
    const bool nothing = groups_.size() == 1 && groups_.front() == FaceGroup{};
    model.surface.groups =
        groups_.size() > 1 ? std::move(by_triangle_) : std::vector<std::uint32_t>();
    model.appearance.groups = nothing ? std::vector<FaceGroup>() : std::move(groups_);
}

}  // namespace vsplit::precompute
