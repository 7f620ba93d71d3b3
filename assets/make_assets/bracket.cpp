#include "make_assets/models.h"
#include "make_assets/patch_builder.h"

#include <algorithm>

namespace vsplit::assets {

namespace {

// Millimetres. The base plate lies on y = 0, the upright plate stands at x = 0 .. 12; both are
// symmetric in z.
constexpr double kHalfWidth = 30.0;
constexpr double kBaseLength = 90.0;
constexpr double kBaseHeight = 10.0;
constexpr double kCorner = 8.0;  // radius of the base's front corners and of the fillet
constexpr double kUpright = 12.0;
constexpr double kFilletEnd = kUpright + kCorner;
constexpr double kBoreHeight = 60.0;  // also where the upright's round top begins
constexpr double kBore = 16.0;
constexpr double kBoss = 24.0;
constexpr double kBossEnd = 22.0;
constexpr double kBoltX = 66.0, kBoltZ = 15.0;
constexpr double kBolt = 5.5, kCounterbore = 10.0, kCounterboreFloor = 5.0;

// Points of base_edge() up to where the straight side begins.
constexpr std::size_t kRimPoints = 22;

constexpr Vector3 kX{1, 0, 0}, kY{0, 1, 0}, kZ{0, 0, 1};

Polyline reversed(Polyline line)
{
    std::reverse(line.begin(), line.end());
    return line;
}

Polyline lifted(Polyline line, const Vector3& shift)
{
    for (Vector3& point : line)
    {
        point = point + shift;
    }
    return line;
}

// The base's outline at height y for z >= 0, from (x, 0) on the symmetry plane along the front and
// the side back to x_back: an open line.
Polyline base_edge(double y, double x_back)
{
    const double side = kHalfWidth, front = kBaseLength;
    Polyline line{{front, y, 0}};
    line_to(line, {front, y, side - kCorner}, 5);
    arc_to(line, {front - kCorner, y, side - kCorner}, {front - kCorner, y, side}, 4);
    line_to(line, {kFilletEnd, y, side}, 12);
    if (x_back < kFilletEnd)
    {
        line_to(line, {x_back, y, side}, 4);
    }
    return line;
}

// One half of the base's top or bottom as a loop.
Polyline base_half(double y, double x_back)
{
    Polyline loop = base_edge(y, x_back);
    line_to(loop, {x_back, y, 0}, 6);
    line_to(loop, {kBaseLength, y, 0}, static_cast<int>((kBaseLength - x_back) / 5.0));
    loop.pop_back();
    return loop;
}

Polyline bore_circle(double x, double radius)
{
    return circle({x, kBoreHeight, 0}, kZ, kY, radius, 5);
}

// The upright's outline at x from (y_low, z = 30) up, over the round top and down: an open line.
Polyline upright_edge(double x, double y_low)
{
    Polyline line{{x, y_low, kHalfWidth}};
    line_to(line, {x, kBoreHeight, kHalfWidth}, 10);
    const Vector3 centre{x, kBoreHeight, 0};
    arc_to(line, centre, centre + kY * kHalfWidth, 5);
    arc_to(line, centre, centre - kZ * kHalfWidth, 5);
    line_to(line, {x, y_low, -kHalfWidth}, 10);
    return line;
}

// The half of the base plate with z >= 0.
void add_half_base(PatchBuilder& builder)
{
    const auto hole = [](double y, double radius) {
        return circle({kBoltX, y, kBoltZ}, kX, kZ, radius, 4);
    };
    // Loops round y turn counter-clockwise seen from below.
    builder.fill_polygon(base_half(0, 0), kY * -1.0, hole(0, 2.0 * kBolt));
    builder.fill_band(hole(0, 2.0 * kBolt), hole(0, kBolt), 2);
    builder.fill_band(hole(0, kBolt), hole(kCounterboreFloor, kBolt), 2);
    builder.fill_band(hole(kCounterboreFloor, kBolt), hole(kCounterboreFloor, kCounterbore), 2);
    builder.fill_band(hole(kCounterboreFloor, kCounterbore), hole(kBaseHeight, kCounterbore), 2);
    builder.fill_polygon(
        reversed(base_half(kBaseHeight, kFilletEnd)), kY, reversed(hole(kBaseHeight, kCounterbore))
    );
    // The front and the rounded corner; the side is filled as a polygon.
    const auto rim = [](double y) {
        Polyline line = base_edge(y, kFilletEnd);
        line.resize(kRimPoints);
        return reversed(line);
    };
    builder.fill_strip(rim(0), rim(kBaseHeight), 2);
}

// The L-shaped side at z = 30: base, fillet, upright up to the round top.
Polyline side_outline()
{
    const double z = kHalfWidth;
    Polyline loop = reversed(base_edge(0, 0));
    loop.resize(loop.size() - kRimPoints + 1);
    line_to(loop, {kBaseLength - kCorner, kBaseHeight, z}, 2);
    line_to(loop, {kFilletEnd, kBaseHeight, z}, 12);
    arc_to(loop, {kFilletEnd, kBaseHeight + kCorner, z}, {kUpright, kBaseHeight + kCorner, z}, 3);
    line_to(loop, {kUpright, kBoreHeight, z}, 10);
    line_to(loop, {0, kBoreHeight, z}, 3);
    line_to(loop, {0, 0, z}, 10);
    loop.pop_back();
    return loop;
}

void add_fillet(PatchBuilder& builder)
{
    const double y = kBaseHeight + kCorner;
    const auto arc = [y](double z) {
        Polyline line{{kFilletEnd, kBaseHeight, z}};
        arc_to(line, {kFilletEnd, y, z}, {kUpright, y, z}, 3);
        return line;
    };
    builder.fill_strip(arc(-kHalfWidth), arc(kHalfWidth), 12);
}

void add_upright(PatchBuilder& builder)
{
    const auto loop = [](double x, double y_low) {
        Polyline outline = upright_edge(x, y_low);
        line_to(outline, {x, y_low, kHalfWidth}, 12);
        outline.pop_back();
        return outline;
    };
    // Loops round x turn counter-clockwise seen from behind (-x) as bore_circle() makes them.
    const double low = kBaseHeight + kCorner;
    builder.fill_polygon(loop(0, 0), kX * -1.0, bore_circle(0, kBore));
    builder.fill_band(bore_circle(0, kBore), bore_circle(kBossEnd, kBore), 6);
    builder.fill_band(bore_circle(kBossEnd, kBore), bore_circle(kBossEnd, kBoss), 3);
    builder.fill_band(bore_circle(kBossEnd, kBoss), bore_circle(kUpright, kBoss), 3);
    builder.fill_polygon(reversed(loop(kUpright, low)), kX, reversed(bore_circle(kUpright, kBoss)));
    const Polyline back = upright_edge(0, low);
    const Polyline top(back.begin() + 10, back.end() - 10);  // without the straight sides
    builder.fill_strip(lifted(top, kX * kUpright), top, 3);
}

}  // namespace

IndexedMesh make_bracket()
{
    PatchBuilder builder;
    add_half_base(builder);
    builder.fill_polygon(side_outline(), kZ);
    builder.add_mirror_image();
    add_fillet(builder);
    add_upright(builder);
    return flip_flat_edges(builder.take());
}

}  // namespace vsplit::assets
