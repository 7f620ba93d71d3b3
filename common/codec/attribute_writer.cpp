#include "codec/attribute_writer.h"

#include "codec/attribute_coder.h"
#include "codec/bit_counter.h"
#include "codec/coarse_values.h"
#include "codec/stream_decoder.h"
#include "core/byte_writer.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

namespace vsplit::codec {
namespace {

/// Values after which the length is looked at.
constexpr std::uint32_t kStep = 512;

/// Normals by which styles are compared.
constexpr std::uint32_t kTriedNormals = 4000;

/// A source triangle of a level: its vertices, the least one first, and its wedges in the same order.
struct LevelFace
{
    Triangle vertices{};
    Triangle wedges{};
    std::uint32_t face = 0;
};

/// Turns a triangle so that its least vertex comes first. Result: by how many corners.
std::size_t turn_of(const Triangle& triangle)
{
    return static_cast<std::size_t>(std::ranges::min_element(triangle) - triangle.begin());
}

Triangle turned(const Triangle& triangle, std::size_t turn)
{
    return {triangle[turn], triangle[(turn + 1) % 3], triangle[(turn + 2) % 3]};
}

/// The source's triangles and wedges while the collapses are carried out again, finest level first.
class SeamReplay
{
public:
    explicit SeamReplay(const StreamPlan& plan)
        : plan_(plan),
          wedge_vertex_(count_wedges(plan.wedges)),
          parent_(wedge_vertex_.size()),
          gone_(plan.wedges.size(), 0)
    {
        for (std::uint32_t w = 0; w < parent_.size(); ++w)
        {
            parent_[w] = w;
        }
        for (std::size_t f = 0; f < plan.wedges.size(); ++f)
        {
            for (std::size_t k = 0; k < 3; ++k)
            {
                wedge_vertex_[plan.wedges[f][k]] = plan.mesh->triangles[f][k];
            }
        }
    }

    /// Carries out the collapses of a level.
    void undo(const PlannedLevel& level)
    {
        for (std::size_t i = level.seams.size(); i-- > 0;)
        {
            for (const SeamRecord& record : level.seams[i])
            {
                vanish(record, 0, 2);
                vanish(record, 1, 1);
            }
        }
    }

    /// The triangles that are left, sorted by their vertices.
    std::vector<LevelFace> faces()
    {
        std::vector<LevelFace> faces;
        for (std::uint32_t f = 0; f < gone_.size(); ++f)
        {
            if (gone_[f] == 0)
            {
                faces.push_back(face(f));
            }
        }
        std::ranges::sort(faces, {}, &LevelFace::vertices);
        return faces;
    }

    /// Number of wedges of the source.
    [[nodiscard]] std::size_t wedge_count() const { return parent_.size(); }

private:
    /// Drops a face whose wedge at corner `removed` continues in that of the kept vertex, corner 0.
    void vanish(const SeamRecord& record, std::size_t side, std::size_t removed)
    {
        if (record.faces[side] < gone_.size())
        {
            gone_[record.faces[side]] = 1;
            parent_[root(record.wedges[side][removed])] = root(record.wedges[side][0]);
        }
    }

    std::uint32_t root(std::uint32_t wedge)
    {
        while (parent_[wedge] != wedge)
        {
            parent_[wedge] = parent_[parent_[wedge]];
            wedge = parent_[wedge];
        }
        return wedge;
    }

    LevelFace face(std::uint32_t number)
    {
        LevelFace result;
        Triangle vertices{};
        Triangle wedges{};
        for (std::size_t k = 0; k < 3; ++k)
        {
            wedges[k] = root(plan_.wedges[number][k]);
            vertices[k] = wedge_vertex_[wedges[k]];
        }
        const std::size_t turn = turn_of(vertices);
        result.vertices = turned(vertices, turn);
        result.wedges = turned(wedges, turn);
        result.face = number;
        return result;
    }

    const StreamPlan& plan_;
    std::vector<std::uint32_t> wedge_vertex_;
    std::vector<std::uint32_t> parent_;  ///< By wedge the one that it was folded into, or itself.
    std::vector<std::uint8_t> gone_;     ///< By source triangle.
};

/// Codes the attributes while the stream is decoded.
class AttributeWriter
{
public:
    AttributeWriter(
        std::span<const std::byte> file,
        const StreamPlan& plan,
        std::span<const std::uint32_t> sources
    )
        : file_(file),
          plan_(plan),
          sources_(sources),
          coder_(
              plan.attributes,
              {count_wedges(plan.wedges), static_cast<std::uint32_t>(plan.mesh->positions.size())}
          ),
          coarse_(plan)
    {
    }

    Result<std::vector<ExtraChunk>> run()
    {
        auto position = file_;
        std::size_t chunk = 0;
        while (!decoder_.complete())
        {
            const auto taken = decoder_.feed(position);
            VSPLIT_TRY(taken);
            position = position.subspan(*taken);
            const auto step = decoder_.step();
            VSPLIT_TRY(step);
            if (step->kind == StepKind::Header)
            {
                collect_levels();
            }
            if (step->kind == StepKind::Chunk && step->level_complete)
            {
                VSPLIT_TRY(code_level(step->level, chunk, step->triangles_replaced));
            }
            chunk += step->kind == StepKind::Chunk || step->kind == StepKind::SkippedChunk ? 1 : 0;
        }
        VSPLIT_TRY(code_all_normals(chunk - 1));
        VSPLIT_TRY(code_late_bits(chunk - 1));
        return std::move(chunks_);
    }

private:
    /// Finds what each level of the stream has, from the finest one down.
    void collect_levels()
    {
        SeamReplay replay(plan_);
        source_.wedges.number_of.assign(replay.wedge_count(), kNoWedge);
        source_.values = plan_.values;
        for (const std::uint32_t group : plan_.groups)
        {
            source_.group_count = std::max(source_.group_count, group + 1);
        }
        const std::size_t levels = decoder_.info()->levels.size();
        faces_.resize(levels);
        faces_.back() = replay.faces();
        for (std::size_t level = plan_.levels.size(); level-- > 1;)
        {
            replay.undo(plan_.levels[level]);
            if (level <= levels - 1)
            {
                faces_[level - 1] = replay.faces();
            }
        }
    }

    /// Finds the source's wedges at the corners of every slot.
    Result<void> find_labels(const LevelMesh& mesh, const std::vector<LevelFace>& faces)
    {
        source_.wedges.labels.resize(mesh.triangles.size());
        source_.groups.resize(plan_.groups.empty() ? 0 : mesh.triangles.size());
        for (std::size_t slot = 0; slot < mesh.triangles.size(); ++slot)
        {
            Triangle vertices{};
            std::ranges::transform(mesh.triangles[slot], vertices.begin(), [&](std::uint32_t v) {
                return sources_[v];
            });
            const std::size_t turn = turn_of(vertices);
            const Triangle wanted = turned(vertices, turn);
            const auto found = std::ranges::lower_bound(faces, wanted, {}, &LevelFace::vertices);
            if (found == faces.end() || found->vertices != wanted)
            {
                return fail(ErrorCode::Internal, "a level has a triangle that its source has not");
            }
            source_.wedges.labels[slot] = turned(found->wedges, (3 - turn) % 3);
            if (!plan_.groups.empty())
            {
                source_.groups[slot] = plan_.groups[found->face];
            }
        }
        return {};
    }

    Result<void> code_level(std::uint32_t level, std::size_t chunk, bool replaced)
    {
        LevelMesh mesh = decoder_.level_mesh();
        VSPLIT_TRY(find_labels(mesh, faces_[level]));
        faces_[level] = {};
        source_.lacks = coarse_.lacking(decoder_.shift(), coder_.shown().wedge_vertices.size());
        MeasuredEncoder body;
        VSPLIT_TRY(coder_.begin_level(body, std::move(mesh), replaced, &source_));
        BitEncoder head;
        head.append(body.bits());
        std::size_t before = body.bytes();
        for (; coder_.in_level(); before = 0)
        {
            MeasuredEncoder values;
            std::uint32_t count = 0;
            while (coder_.in_level() && before + values.bytes() <= kFullChunk)
            {
                const std::uint32_t step = std::min(coder_.left(), kStep);
                VSPLIT_TRY(coder_.code_values(values, step));
                count += step;
            }
            static_cast<void>(code_count(head, count));
            head.append(values.bits());
            add_chunk(chunk, 0, head);
        }
        return {};
    }

    Result<void> code_all_normals(std::size_t chunk)
    {
        while (coder_.next_normals())
        {
            NormalStyle style;
            VSPLIT_TRY(choose_style(style));
            bool open = true;
            while (open)
            {
                const std::uint32_t left = coder_.normals_left();
                BitEncoder head;
                MeasuredEncoder body;
                std::uint32_t count = 0;
                while (count < left && body.bytes() <= kFullChunk)
                {
                    const std::uint32_t step = std::min(left - count, kStep);
                    VSPLIT_TRY(coder_.code_normals(body, step, style));
                    count += step;
                }
                static_cast<void>(code_count(head, count));
                head.append(body.bits());
                add_chunk(chunk, 1, head);
                open = count < left;
            }
        }
        return {};
    }

    /// Ends with the bits that values still lack.
    Result<void> code_late_bits(std::size_t chunk)
    {
        while (coder_.late_left() > 0)
        {
            const auto fitting = static_cast<std::uint32_t>(kFullChunk * 8 / coder_.late_bits());
            const std::uint32_t count = std::min(coder_.late_left(), fitting);
            BitEncoder bits;
            static_cast<void>(code_count(bits, count));
            VSPLIT_TRY(coder_.code_late_bits(bits, count));
            add_chunk(chunk, proto::kLateBitsCodec, bits);
        }
        return {};
    }

    /// Tries every style on the first normals.
    Result<void> choose_style(NormalStyle& style)
    {
        std::size_t least = 0;
        for (std::uint32_t choice = 0; choice < 16; ++choice)
        {
            const NormalStyle tried{
                static_cast<NormalWeight>(choice & 3),
                static_cast<std::uint8_t>((choice >> 2) * 2)};
            const auto bytes = coder_.try_normals(kTriedNormals, tried);
            VSPLIT_TRY(bytes);
            if (choice == 0 || *bytes < least)
            {
                least = *bytes;
                style = tried;
            }
        }
        return {};
    }

    void add_chunk(std::size_t after, std::uint8_t codec, BitEncoder& bits)
    {
        ByteWriter bytes;
        bits.finish(bytes);
        const auto view = bytes.view();
        chunks_.push_back({.after = after, .codec = codec, .bytes = {view.begin(), view.end()}});
    }

    std::span<const std::byte> file_;
    const StreamPlan& plan_;
    std::span<const std::uint32_t> sources_;
    StreamDecoder decoder_;
    AttributeCoder coder_;
    AttributeSource source_;
    CoarseValues coarse_;
    std::vector<std::vector<LevelFace>> faces_;  ///< By level, sorted.
    std::vector<ExtraChunk> chunks_;
};

}  // namespace

std::uint32_t count_wedges(std::span<const Triangle> wedges)
{
    std::uint32_t count = 0;
    for (const Triangle& triangle : wedges)
    {
        count = std::max(count, std::ranges::max(triangle) + 1);
    }
    return count;
}

Result<std::vector<ExtraChunk>> code_attributes(
    std::span<const std::byte> file, const StreamPlan& plan, std::span<const std::uint32_t> sources
)
{
    return AttributeWriter(file, plan, sources).run();
}

}  // namespace vsplit::codec
