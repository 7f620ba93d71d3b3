#include "make_assets/implicit.h"
#include "make_assets/models.h"
#include "make_assets/remesh.h"

namespace vsplit::assets {

namespace {

std::vector<Part> bone_parts()
{
    std::vector<Part> parts;
    // The shaft bows a little, is thinnest left of its middle and widens towards both ends.
    parts.push_back(
        {.axis =
             {
                 {{-0.86, 0.01, 0}, 0.165},
                 {{-0.66, 0.04, 0}, 0.122},
                 {{-0.36, 0.075, 0}, 0.093},
                 {{0.00, 0.09, 0}, 0.088},
                 {{0.36, 0.075, 0}, 0.099},
                 {{0.66, 0.04, 0}, 0.130},
                 {{0.86, 0.01, 0}, 0.170},
             }}
    );
    // Left end: two round heads of unequal size.
    parts.push_back(
        {.axis = {{{-0.94, 0.06, -0.135}, 0.175}, {{-0.91, -0.05, -0.15}, 0.170}}, .blend = 0.1}
    );
    parts.push_back(
        {.axis = {{{-0.96, 0.04, 0.145}, 0.155}, {{-0.91, -0.05, 0.14}, 0.150}}, .blend = 0.07}
    );
    // Right end: two long condyles that curl backwards, with a groove between them.
    add_mirrored(
        parts,
        {.axis =
             {{{0.90, 0.11, 0.125}, 0.120},
              {{0.985, 0.02, 0.145}, 0.148},
              {{0.955, -0.13, 0.155}, 0.135}},
         .blend = 0.1}
    );
    parts.push_back(
        {.axis = {{{1.14, 0.20, 0}, 0.06}, {{1.19, 0.02, 0}, 0.085}, {{1.10, -0.24, 0}, 0.105}},
         .blend = 0.08,
         .carve = true}
    );
    // A ridge along the back of the shaft, and two knobs where tendons held.
    parts.push_back(
        {.axis =
             {{{-0.52, -0.030, 0.015}, 0.022},
              {{-0.10, 0.005, 0.02}, 0.026},
              {{0.30, 0.0, 0.01}, 0.018}},
         .blend = 0.05}
    );
    parts.push_back(
        {.axis = {{{-0.78, 0.17, 0.06}, 0.045}, {{-0.68, 0.145, 0.075}, 0.032}}, .blend = 0.08}
    );
    parts.push_back(
        {.axis = {{{0.72, 0.08, -0.13}, 0.035}, {{0.80, 0.08, -0.15}, 0.045}}, .blend = 0.08}
    );
    return parts;
}

}  // namespace

IndexedMesh make_bone()
{
    const Body bone(bone_parts());
    const IndexedMesh raw =
        polygonise(bone, {.low = {-1.3, -0.5, -0.5}, .high = {1.3, 0.5, 0.5}, .cell = 0.025});
    return remesh(
        raw,
        surface_of(bone, 0.002),
        {.chord_error = 0.00034, .shortest_edge = 0.008, .longest_edge = 0.06}
    );
}

}  // namespace vsplit::assets
