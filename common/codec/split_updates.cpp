#include "codec/split_updates.h"

#include <algorithm>

namespace vsplit::codec {
namespace {

TriangleUpdate update_of(const Face& face)
{
    return {face.slot, face.vertex};
}

}  // namespace

void SplitUpdates::show(std::span<const Split> splits)
{
    shows_all_ = false;
    splits_ = splits;
    first_added_ = mesh_.face_capacity() - mesh_.added_count();
}

std::size_t SplitUpdates::read(Cursor& cursor, std::span<TriangleUpdate> out) const
{
    if (shows_all_)
    {
        return read_all(cursor, out);
    }
    std::size_t count = 0;
    while (cursor.item < splits_.size() && out.size() - count >= kLeastRoom)
    {
        count += read_split(cursor, out.subspan(count));
    }
    return count;
}

std::size_t SplitUpdates::read_all(Cursor& cursor, std::span<TriangleUpdate> out) const
{
    const auto [old, added] = mesh_.face_ranges();
    const std::size_t first = first_shown_ + cursor.item;
    const bool in_old = first < old.size();
    const auto rest = in_old ? old.subspan(first) : added.subspan(first - old.size());
    const std::size_t count = std::min(rest.size(), out.size());
    std::ranges::transform(rest.first(count), out.begin(), update_of);
    cursor.item += count;
    return count;
}

/// Writes the updates of one split: its wedge, then its new faces.
std::size_t SplitUpdates::read_split(Cursor& cursor, std::span<TriangleUpdate> out) const
{
    const Split& split = splits_[cursor.item++];
    std::size_t count = 0;
    Corner corner = split.first;
    for (int i = 0; i < split.wedge; ++i)
    {
        out[count++] = update_of(mesh_.faces()[face_of(corner)]);
        corner = i + 1 < split.wedge ? next_corner(mesh_.opposite(next_corner(corner))) : corner;
    }
    for (std::uint32_t left = RefinementMesh::added_faces({&split, 1}); left > 0; --left)
    {
        out[count++] = update_of(mesh_.faces()[first_added_ - ++cursor.added]);
    }
    return count;
}

}  // namespace vsplit::codec
