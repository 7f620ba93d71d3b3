#include "make_assets/implicit.h"
#include "make_assets/models.h"
#include "make_assets/remesh.h"

namespace vsplit::assets {

namespace {

constexpr Vector3 kAcross{0, 0, 1};

Part carved(Part part)
{
    part.carve = true;
    return part;
}

void add_trunk(std::vector<Part>& parts)
{
    // Rump, belly, chest: higher than wide.
    parts.push_back(
        {{{{-0.82, 0.10, 0}, 0.36},
          {{-0.45, 0.05, 0}, 0.435},
          {{-0.02, -0.05, 0}, 0.50},
          {{0.35, -0.03, 0}, 0.48},
          {{0.74, 0.02, 0}, 0.40}},
         0.2,
         kAcross,
         1.2}
    );
    parts.push_back({{{{0.40, 0.36, 0}, 0.08}, {{0.80, 0.37, 0}, 0.13}}, 0.25, kAcross, 1.2});
    add_mirrored(parts, {{{{-0.92, 0.34, 0.17}, 0.07}, {{-0.72, 0.37, 0.20}, 0.05}}, 0.16});
    // Neck and dewlap.
    parts.push_back(
        {{{{0.72, 0.10, 0}, 0.33}, {{1.00, 0.30, 0}, 0.25}, {{1.24, 0.50, 0}, 0.19}},
         0.2,
         kAcross,
         1.3}
    );
    parts.push_back(
        {{{{0.80, -0.26, 0}, 0.12}, {{1.02, -0.02, 0}, 0.09}, {{1.18, 0.26, 0}, 0.05}},
         0.16,
         kAcross,
         1.8}
    );
}

void add_head(std::vector<Part>& parts)
{
    // Skull to nose, then the jaw.
    parts.push_back(
        {{{{1.25, 0.56, 0}, 0.185},
          {{1.42, 0.49, 0}, 0.16},
          {{1.56, 0.38, 0}, 0.118},
          {{1.68, 0.28, 0}, 0.112}},
         0.12,
         kAcross,
         1.08}
    );
    parts.push_back(
        {{{{1.28, 0.42, 0}, 0.115}, {{1.44, 0.30, 0}, 0.09}, {{1.60, 0.20, 0}, 0.078}}, 0.06}
    );
    add_mirrored(parts, {{{{1.68, 0.285, 0.035}, 0.092}, {{1.71, 0.235, 0.05}, 0.082}}, 0.05});
    add_mirrored(parts, {{{{1.36, 0.605, 0.105}, 0.050}, {{1.44, 0.575, 0.118}, 0.042}}, 0.05});
    parts.push_back({{{{1.22, 0.735, 0}, 0.06}, {{1.28, 0.725, 0}, 0.065}}, 0.1});
    add_mirrored(
        parts, carved({{{{1.800, 0.315, 0.045}, 0.018}, {{1.782, 0.275, 0.095}, 0.024}}, 0.015})
    );
    add_mirrored(
        parts,
        carved(
            {{{{1.80, 0.175, 0.0}, 0.016},
              {{1.775, 0.175, 0.075}, 0.016},
              {{1.66, 0.19, 0.135}, 0.014},
              {{1.54, 0.225, 0.125}, 0.006}},
             0.012}
        )
    );
    add_mirrored(parts, {{{{1.445, 0.525, 0.138}, 0.042}}, 0.008});  // eyes
}

void add_ears_and_horns(std::vector<Part>& parts)
{
    // Ears: leaves that hang outwards, hollowed from the front.
    const Vector3 thin = unit({0.85, 0.40, 0.25});
    add_mirrored(
        parts,
        {{{{1.21, 0.60, 0.14}, 0.060},
          {{1.17, 0.625, 0.26}, 0.088},
          {{1.13, 0.60, 0.37}, 0.080},
          {{1.10, 0.55, 0.46}, 0.042}},
         0.04,
         thin,
         2.0}
    );
    add_mirrored(
        parts, carved({{{{1.235, 0.655, 0.25}, 0.042}, {{1.18, 0.61, 0.40}, 0.034}}, 0.03})
    );
    // Horns: out, then up, then in and forward.
    add_mirrored(
        parts,
        {{{{1.235, 0.70, 0.05}, 0.064},
          {{1.23, 0.77, 0.19}, 0.056},
          {{1.24, 0.88, 0.265}, 0.045},
          {{1.28, 0.99, 0.27}, 0.032},
          {{1.335, 1.07, 0.235}, 0.013}},
         0.035}
    );
}

void add_legs(std::vector<Part>& parts)
{
    // Front: shoulder, elbow, knee, cannon, fetlock.
    add_mirrored(
        parts,
        {{{{0.66, 0.05, 0.20}, 0.22},
          {{0.62, -0.34, 0.235}, 0.145},
          {{0.655, -0.60, 0.24}, 0.092},
          {{0.668, -0.70, 0.24}, 0.096},
          {{0.66, -0.82, 0.24}, 0.068},
          {{0.655, -1.00, 0.24}, 0.066},
          {{0.675, -1.10, 0.24}, 0.084}},
         0.12}
    );
    // Hind: thigh, stifle, hock (points backwards), cannon, fetlock.
    add_mirrored(
        parts,
        {{{{-0.74, 0.04, 0.18}, 0.30},
          {{-0.66, -0.32, 0.235}, 0.20},
          {{-0.78, -0.52, 0.24}, 0.125},
          {{-0.905, -0.66, 0.24}, 0.090},
          {{-0.885, -0.80, 0.24}, 0.070},
          {{-0.835, -1.00, 0.24}, 0.067},
          {{-0.81, -1.10, 0.24}, 0.085}},
         0.12}
    );
    add_mirrored(parts, {{{{-0.955, -0.60, 0.24}, 0.045}, {{-0.94, -0.68, 0.24}, 0.05}}, 0.06});
}

void add_hooves_udder_tail(std::vector<Part>& parts)
{
    const Vector3 up{0, 1, 0};
    for (const double x : {0.68, -0.80})
    {
        for (const double toe : {-0.034, 0.034})  // cloven
        {
            const double z = 0.24 + toe;
            add_mirrored(
                parts,
                {{{{x - 0.01, -1.18, z}, 0.088}, {{x + 0.065, -1.195, z}, 0.066}}, 0.02, up, 1.2}
            );
        }
    }
    parts.push_back({{{{-0.48, -0.42, 0}, 0.15}, {{-0.34, -0.42, 0}, 0.15}}, 0.1});
    for (const double x : {-0.47, -0.35})
    {
        add_mirrored(parts, {{{{x, -0.52, 0.07}, 0.036}, {{x, -0.625, 0.08}, 0.024}}, 0.03});
    }
    parts.push_back(
        {{{{-1.05, 0.36, 0}, 0.062},
          {{-1.19, 0.28, 0}, 0.050},
          {{-1.27, 0.05, 0.01}, 0.040},
          {{-1.28, -0.25, 0.035}, 0.034},
          {{-1.25, -0.48, 0.06}, 0.036},
          {{-1.245, -0.62, 0.075}, 0.066},
          {{-1.25, -0.76, 0.085}, 0.022}},
         0.1}
    );
}

}  // namespace

IndexedMesh make_beast()
{
    std::vector<Part> parts;
    add_trunk(parts);
    add_legs(parts);
    add_head(parts);
    add_ears_and_horns(parts);
    add_hooves_udder_tail(parts);
    const Body beast(parts);
    const IndexedMesh raw =
        polygonise(beast, {.low = {-1.5, -1.4, -0.7}, .high = {2.0, 1.2, 0.7}, .cell = 0.025});
    return remesh(
        raw,
        surface_of(beast, 0.002),
        {.chord_error = 0.00088, .shortest_edge = 0.010, .longest_edge = 0.09}
    );
}

}  // namespace vsplit::assets
