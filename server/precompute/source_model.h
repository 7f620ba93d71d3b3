#pragma once

#include "mesh/surface.h"
#include "scene/appearance.h"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace vsplit::precompute {

/// What a reader could not take over, in words for people. Not thread safe.
class DroppedNotes
{
public:
    /// Adds a note, unless it is there already or there are very many.
    void add(std::string note);

    /// The notes in the order in which they came.
    [[nodiscard]] const std::vector<std::string>& all() const { return notes_; }

    /// Takes the notes and leaves none.
    [[nodiscard]] std::vector<std::string> take() { return std::exchange(notes_, {}); }

private:
    std::vector<std::string> notes_;
};

/// A model as a source file has it, nothing repaired.
struct SourceModel
{
    Surface surface;
    Appearance appearance;
    std::vector<SourceImage> images;   ///< One for each of Appearance::images, none empty.
    std::vector<std::string> dropped;  ///< What was in the file and is not in here, in words.
};

/// Puts the attributes of a surface into the order that the rest of the program relies on: every number
/// finite, normals of length 1 (those without a direction get their first face's), colours in 0 .. 1 and
/// without an alpha that is 1 everywhere; normals that only say what the faces say are dropped, because
/// they would make every edge a seam, and clients derive them.
/// `surface`: indices in range. `dropped`: gets a note for everything that was changed.
/// Cost: linear. Thread safe.
void tidy_attributes(Surface& surface, DroppedNotes& dropped);

}  // namespace vsplit::precompute
