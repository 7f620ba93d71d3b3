#include "gpu_buffers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace vsplit::client {
namespace {

// A mesh that changes as a decoder's does; not a sensible surface, which the arrays need not care
// about.
class RandomRefinement
{
public:
    explicit RandomRefinement(unsigned seed) : random_(seed) {}

    // Appends vertices and triangles and changes some known triangles; `moves`: every known vertex
    // moves as well. The step refers to memory of this object until the next call.
    codec::Step refine(std::uint32_t new_vertices, std::uint32_t new_faces, bool moves)
    {
        const auto known = static_cast<std::uint32_t>(positions_.size());
        const auto known_faces = static_cast<std::uint32_t>(triangles_.size());
        positions_.resize(known + new_vertices);
        for (std::uint32_t v = moves ? 0 : known; v < positions_.size(); ++v)
        {
            positions_[v] = {coordinate(), coordinate(), coordinate()};
        }
        updates_.clear();
        triangles_.resize(known_faces + new_faces);
        for (std::uint32_t slot = known_faces; slot < triangles_.size(); ++slot)
        {
            update(slot);
        }
        for (std::uint32_t i = 0; i < std::min(known_faces, new_faces); ++i)
        {
            update(below(known_faces));
        }
        std::shuffle(updates_.begin(), updates_.end(), random_);
        for (const auto& update : updates_)
        {
            triangles_[update.slot] =
                update.vertices;  // A slot may come twice; the last one counts.
        }
        codec::Step step;
        step.kind = codec::StepKind::Chunk;
        step.first_new_vertex = known;
        step.first_moved_vertex = moves ? 0 : known;
        step.vertices = static_cast<std::uint32_t>(positions_.size());
        step.faces = static_cast<std::uint32_t>(triangles_.size());
        step.triangles = updates_;
        return step;
    }

    // The whole mesh as if it came in one step.
    codec::Step whole()
    {
        updates_.clear();
        for (std::uint32_t slot = 0; slot < triangles_.size(); ++slot)
        {
            updates_.push_back({slot, triangles_[slot]});
        }
        codec::Step step;
        step.kind = codec::StepKind::Chunk;
        step.vertices = static_cast<std::uint32_t>(positions_.size());
        step.faces = static_cast<std::uint32_t>(triangles_.size());
        step.triangles = updates_;
        return step;
    }

    PositionSource positions() const
    {
        return [this](std::uint32_t first, std::uint32_t count, std::span<float> out) {
            for (std::size_t i = 0; i < count; ++i)
            {
                std::copy_n(positions_[first + i].begin(), 3, out.begin() + 3 * i);
            }
        };
    }

    const std::vector<Triangle>& triangles() const { return triangles_; }

private:
    float coordinate() { return std::uniform_real_distribution<float>(-1.0F, 1.0F)(random_); }

    std::uint32_t below(std::uint32_t end)
    {
        return std::uniform_int_distribution<std::uint32_t>(0, end - 1)(random_);
    }

    void update(std::uint32_t slot)
    {
        const auto count = static_cast<std::uint32_t>(positions_.size());
        updates_.push_back({slot, {below(count), below(count), below(count)}});
    }

    std::mt19937 random_;
    std::vector<std::array<float, 3>> positions_;
    std::vector<Triangle> triangles_;
    std::vector<codec::TriangleUpdate> updates_;
};

// What the GPU would hold if it got the dirty ranges and nothing else.
struct Shadow
{
    std::vector<GpuVertex> vertices;
    std::vector<Triangle> triangles;

    void upload(GpuBuffers& buffers)
    {
        vertices.resize(buffers.vertices().size());
        triangles.resize(buffers.triangles().size());
        for (const ElementRange& range : buffers.take_dirty_vertices())
        {
            std::copy_n(
                buffers.vertices().begin() + range.first,
                range.count,
                vertices.begin() + range.first
            );
        }
        for (const ElementRange& range : buffers.take_dirty_triangles())
        {
            std::copy_n(
                buffers.triangles().begin() + range.first,
                range.count,
                triangles.begin() + range.first
            );
        }
    }
};

constexpr double kDiagonal = 3.5;

TEST(GpuBuffers, EqualARebuildFromScratchAfterEveryStep)
{
    for (unsigned seed = 1; seed <= 5; ++seed)
    {
        SCOPED_TRACE(seed);
        RandomRefinement mesh(seed);
        GpuBuffers buffers(kDiagonal);
        Shadow shadow;
        for (unsigned level = 0; level < 12; ++level)
        {
            const bool moves = level % 4 == 3;
            const codec::Step step = mesh.refine(10 + 20 * level, 30 + 40 * level, moves);
            buffers.apply(step, mesh.positions());
            shadow.upload(buffers);

            GpuBuffers rebuilt(kDiagonal);
            rebuilt.apply(mesh.whole(), mesh.positions());
            ASSERT_TRUE(std::ranges::equal(shadow.vertices, rebuilt.vertices())) << level;
            ASSERT_TRUE(std::ranges::equal(shadow.triangles, mesh.triangles())) << level;
        }
    }
}

TEST(GpuBuffers, UploadOnlyThePagesThatChanged)
{
    RandomRefinement mesh(7);
    GpuBuffers buffers(kDiagonal);
    buffers.apply(mesh.refine(10000, 20000, false), mesh.positions());
    EXPECT_EQ(buffers.take_dirty_vertices(), (std::vector<ElementRange>{{0, 10000}}));
    EXPECT_EQ(buffers.take_dirty_triangles(), (std::vector<ElementRange>{{0, 20000}}));

    const std::vector<codec::TriangleUpdate> updates{{5000, {0, 1, 2}}};
    codec::Step step;
    step.kind = codec::StepKind::Chunk;
    step.first_new_vertex = step.first_moved_vertex = step.vertices = 10000;
    step.faces = 20000;
    step.triangles = updates;
    buffers.apply(step, mesh.positions());
    std::uint32_t vertices = 0;
    for (const ElementRange& range : buffers.take_dirty_vertices())
    {
        vertices += range.count;
    }
    // The three corners before and the three after, a page of 64 each at most.
    EXPECT_LE(vertices, 6U * 64U);
    const auto triangles = buffers.take_dirty_triangles();
    ASSERT_EQ(triangles.size(), 1U);
    EXPECT_LE(triangles[0].first, 5000U);
    EXPECT_GT(triangles[0].first + triangles[0].count, 5000U);
    EXPECT_LE(triangles[0].count, 128U);
    EXPECT_TRUE(buffers.take_dirty_vertices().empty());
    EXPECT_TRUE(buffers.take_dirty_triangles().empty());
}

TEST(GpuBuffers, PointNormalsOutwards)
{
    const std::vector<std::array<float, 3>> points{
        {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    const std::vector<codec::TriangleUpdate> octahedron{
        {0, {0, 2, 4}},
        {1, {2, 1, 4}},
        {2, {1, 3, 4}},
        {3, {3, 0, 4}},
        {4, {2, 0, 5}},
        {5, {1, 2, 5}},
        {6, {3, 1, 5}},
        {7, {0, 3, 5}}};
    codec::Step step;
    step.kind = codec::StepKind::Chunk;
    step.vertices = 6;
    step.faces = 8;
    step.triangles = octahedron;
    GpuBuffers buffers(2.0);
    buffers.apply(step, [&](std::uint32_t first, std::uint32_t count, std::span<float> out) {
        for (std::size_t i = 0; i < count; ++i)
        {
            std::copy_n(points[first + i].begin(), 3, out.begin() + 3 * i);
        }
    });
    for (std::size_t v = 0; v < points.size(); ++v)
    {
        const auto& normal = buffers.vertices()[v].normal;
        const double length = std::hypot(normal[0], normal[1], normal[2]);
        ASSERT_GT(length, 0.0);
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            EXPECT_NEAR(normal[axis] / length, points[v][axis], 1e-5);
        }
    }
}

TEST(GpuBuffers, AreNotHarmedByDegenerateTriangles)
{
    RandomRefinement mesh(3);
    GpuBuffers buffers(0.0);
    buffers.apply(mesh.refine(3, 0, false), mesh.positions());
    const std::vector<codec::TriangleUpdate> updates{{0, {1, 1, 2}}, {1, {0, 0, 0}}};
    codec::Step step;
    step.kind = codec::StepKind::Chunk;
    step.first_new_vertex = step.first_moved_vertex = step.vertices = 3;
    step.faces = 2;
    step.triangles = updates;
    buffers.apply(step, mesh.positions());
    for (const GpuVertex& vertex : buffers.vertices())
    {
        EXPECT_EQ(vertex.normal, (std::array<std::int32_t, 3>{}));
        EXPECT_EQ(vertex.weight, 0);
    }
}

TEST(GpuBuffers, SayHowMuchMemoryTheyTake)
{
    // 28 bytes a vertex and 12 a triangle, here and on the GPU, and a little for the pages.
    const std::uint64_t arrays = 2 * (28 * 10000 + 12 * 20000);
    const std::uint64_t bytes = GpuBuffers::memory_bytes(10000, 20000, false);
    EXPECT_GE(bytes, arrays);
    EXPECT_LE(bytes, arrays + arrays / 100);
    EXPECT_EQ(GpuBuffers::memory_bytes(10000, 20000, true), bytes + 24 * 20000);
}

TEST(DirtyPages, JoinNeighboursAndCutAtTheEnd)
{
    DirtyPages pages(10);
    pages.mark(35);
    pages.mark(12);
    pages.mark(29);
    pages.mark(12);
    EXPECT_EQ(pages.take(33), (std::vector<ElementRange>{{10, 23}}));
    EXPECT_TRUE(pages.take(33).empty());
    pages.mark_range(5, 5);
    EXPECT_TRUE(pages.take(100).empty());
    pages.mark_range(9, 21);
    pages.mark(77);
    EXPECT_EQ(pages.take(100), (std::vector<ElementRange>{{0, 30}, {70, 10}}));
}

}  // namespace
}  // namespace vsplit::client
