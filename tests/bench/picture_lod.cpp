#include "picture_lod.h"

#include "draco_surface.h"
#include "jpeg_ladder.h"
#include "lod_ladder.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <meshoptimizer.h>
#include <optional>
#include <set>
#include <vector>

namespace vsplit::bench {
namespace {

/// Shares of the bytes that geometry may take.
constexpr std::array<double, 10> kShares{0.08, 0.15, 0.22, 0.3, 0.38, 0.47, 0.56, 0.66, 0.78, 0.9};
/// Bits of positions and texture coordinates that are tried together; images that repeat need many.
constexpr std::array<std::array<int, 2>, 7> kBits{
    {{9, 8}, {10, 9}, {11, 10}, {12, 11}, {12, 13}, {13, 12}, {14, 13}}};
/// Least bits of normals, where they are not left out.
constexpr int kFewestNormalBits = 7;
constexpr double kLadderRatio = 0.93;
constexpr std::size_t kFinalists = 4;

/// Bits of positions and texture coordinates to try, none above the most.
std::vector<std::array<int, 2>> bits_to_try(const PictureLodBits& most)
{
    std::set<std::array<int, 2>> bits;
    for (const auto& [position, tex_coord] : kBits)
    {
        bits.insert({std::min(position, most.position), std::min(tex_coord, most.tex_coord)});
    }
    return {bits.begin(), bits.end()};
}

/// Simplified surfaces, made when they are asked for.
class SurfaceLadder
{
public:
    explicit SurfaceLadder(const Surface& surface)
        : surface_(surface), targets_(ladder_targets(surface.mesh.triangles.size(), kLadderRatio))
    {
        std::map<std::vector<std::uint32_t>, std::uint32_t> known;
        for (std::size_t f = 0; f < surface.mesh.triangles.size(); ++f)
        {
            for (std::size_t k = 0; k < 3; ++k)
            {
                std::vector<std::uint32_t> point{surface.mesh.triangles[f][k]};
                for (const SurfaceAttribute& attribute : surface.attributes)
                {
                    point.push_back(attribute.corners[f][k]);
                }
                const auto next = static_cast<std::uint32_t>(points_.size());
                const auto [entry, is_new] = known.try_emplace(point, next);
                indices_.push_back(entry->second);
                if (is_new)
                {
                    points_.push_back(point);
                    for (const double coordinate : surface.mesh.positions[point[0]])
                    {
                        positions_.push_back(static_cast<float>(coordinate));
                    }
                }
            }
        }
    }

    std::size_t size() const { return targets_.size(); }

    /// A level with its attributes, the kinds that are wanted.
    Surface level(std::size_t index, bool normals) const
    {
        std::vector<std::uint32_t> indices = indices_;
        if (index > 0)
        {
            indices.resize(meshopt_simplify(
                indices.data(),
                indices_.data(),
                indices_.size(),
                positions_.data(),
                points_.size(),
                3 * sizeof(float),
                3 * targets_[index],
                std::numeric_limits<float>::max(),
                0,
                nullptr
            ));
        }
        return surface_of(indices, normals);
    }

private:
    Surface surface_of(const std::vector<std::uint32_t>& indices, bool normals) const
    {
        Surface result;
        std::vector<std::uint32_t> place(surface_.mesh.positions.size(), ~0U);
        std::vector<Triangle> faces(indices.size() / 3);
        for (std::size_t i = 0; i < indices.size(); ++i)
        {
            const std::uint32_t vertex = points_[indices[i]][0];
            if (place[vertex] == ~0U)
            {
                place[vertex] = static_cast<std::uint32_t>(result.mesh.positions.size());
                result.mesh.positions.push_back(surface_.mesh.positions[vertex]);
            }
            faces[i / 3][i % 3] = place[vertex];
        }
        result.mesh.triangles = std::move(faces);
        for (std::size_t a = 0; a < surface_.attributes.size(); ++a)
        {
            if (surface_.attributes[a].kind == AttributeKind::Normal && !normals)
            {
                continue;
            }
            SurfaceAttribute& copy = result.attributes.emplace_back(surface_.attributes[a]);
            copy.corners.assign(indices.size() / 3, {});
            for (std::size_t i = 0; i < indices.size(); ++i)
            {
                copy.corners[i / 3][i % 3] = points_[indices[i]][a + 1];
            }
        }
        return result;
    }

    const Surface& surface_;
    std::vector<std::size_t> targets_;
    std::vector<std::vector<std::uint32_t>> points_;
    std::vector<std::uint32_t> indices_;
    std::vector<float> positions_;
};

}  // namespace

class PictureLodSearch::Impl
{
public:
    Impl(const ShownModel& original, const Raster& image, const PictureLodBits& most)
        : original_(original),
          bits_(bits_to_try(most)),
          ladder_(original.surface),
          quick_(original, 3, 256),
          careful_(original, 2, 512)
    {
        if (!image.pixels.empty())
        {
            images_.emplace(image);
        }
        if (std::ranges::any_of(original.surface.attributes, [](const auto& attribute) {
                return attribute.kind == AttributeKind::Normal;
            }))
        {
            normal_bits_.insert({kFewestNormalBits, most.normal});
        }
    }

    Result<PictureLod> best(std::size_t bytes, const PictureJudge& judge)
    {
        std::vector<PictureLod> candidates;
        for (const double share : kShares)
        {
            for (std::size_t bits = 0; bits < bits_.size(); ++bits)
            {
                for (const int normals : normal_bits_)
                {
                    VSPLIT_TRY(try_share(bytes, share, {bits, normals}, candidates));
                }
            }
        }
        if (candidates.empty())
        {
            return fail(ErrorCode::Internal, "no level of detail is so small");
        }
        std::ranges::sort(candidates, std::greater<>(), [](const PictureLod& lod) {
            return lod.figures.psnr;
        });
        candidates.resize(std::min(candidates.size(), kFinalists));
        for (PictureLod& lod : candidates)
        {
            VSPLIT_TRY(choose_image(bytes, lod));
            lod.figures = judge.judge(lod.shown);
        }
        return *std::ranges::max_element(candidates, {}, [](const PictureLod& lod) {
            return lod.figures.psnr;
        });
    }

private:
    struct Choice
    {
        std::size_t bits = 0;
        int normal_bits = 0;

        friend auto operator<=>(const Choice&, const Choice&) = default;
    };

    using Key = std::pair<std::size_t, Choice>;  // level

    Result<std::vector<char>> code(const Key& key) const
    {
        const auto [position, tex_coord] = bits_[key.second.bits];
        const DracoBits bits{
            .position = position,
            .tex_coord = tex_coord,
            .normal = std::max(key.second.normal_bits, kFewestNormalBits)};
        return encode_surface_with_draco(
            ladder_.level(key.first, key.second.normal_bits > 0), bits
        );
    }

    Result<std::size_t> bytes_of(const Key& key)
    {
        const auto known = bytes_.find(key);
        if (known != bytes_.end())
        {
            return known->second;
        }
        const auto file = code(key);
        VSPLIT_TRY(file);
        return bytes_[key] = file->size();
    }

    Result<void> try_share(
        std::size_t bytes, double share, Choice choice, std::vector<PictureLod>& candidates
    )
    {
        const auto budget = static_cast<std::size_t>(share * static_cast<double>(bytes));
        std::size_t low = 0, high = ladder_.size();
        while (low < high)
        {
            const std::size_t middle = (low + high) / 2;
            const auto size = bytes_of({middle, choice});
            VSPLIT_TRY(size);
            *size <= budget ? high = middle : low = middle + 1;
        }
        // The whole mesh in less than its share: larger shares are the same.
        if (low == ladder_.size() || !seen_.insert({bytes, {low, choice}}).second)
        {
            return {};
        }
        auto lod = make({low, choice}, bytes);
        VSPLIT_TRY(lod);
        candidates.push_back(std::move(*lod));
        return {};
    }

    Result<PictureLod> make(const Key& key, std::size_t bytes)
    {
        const auto file = code(key);
        VSPLIT_TRY(file);
        auto surface = decode_surface_with_draco(*file);
        VSPLIT_TRY(surface);
        PictureLod lod;
        lod.geometry_bytes = file->size();
        lod.faces = surface->mesh.triangles.size();
        lod.position_bits = bits_[key.second.bits][0];
        lod.tex_coord_bits = bits_[key.second.bits][1];
        lod.normal_bits = key.second.normal_bits;
        lod.shown.surface = std::move(*surface);
        lod.shown.appearance = original_.appearance;
        if (images_)
        {
            const auto jpeg = images_->best(bytes - lod.geometry_bytes);
            VSPLIT_TRY(jpeg);
            put_image(*jpeg, lod);
        }
        lod.figures = quick_.judge(lod.shown);
        return lod;
    }

    static void put_image(const JpegFile& jpeg, PictureLod& lod)
    {
        lod.image_bytes = jpeg.bytes;
        lod.side = jpeg.side;
        lod.quality = jpeg.quality;
        lod.shown.textures = {picture::Texture(jpeg.shown)};
    }

    /// Takes the image's size that looks best, which need not be the closest one pixel by pixel.
    Result<void> choose_image(std::size_t bytes, PictureLod& lod)
    {
        if (!images_)
        {
            return {};
        }
        const auto files = images_->best_by_size(bytes - lod.geometry_bytes);
        VSPLIT_TRY(files);
        PictureLod best = lod;
        best.figures.psnr = 0.0;
        for (const JpegFile& file : *files)
        {
            put_image(file, lod);
            lod.figures = careful_.judge(lod.shown);
            if (lod.figures.psnr > best.figures.psnr)
            {
                best = lod;
            }
        }
        lod = std::move(best);
        return {};
    }

    const ShownModel& original_;
    std::vector<std::array<int, 2>> bits_;  ///< Of positions and texture coordinates.
    std::set<int> normal_bits_{0};          ///< 0: without normals.
    SurfaceLadder ladder_;
    PictureJudge quick_;
    PictureJudge careful_;
    std::optional<JpegLadder> images_;
    std::map<Key, std::size_t> bytes_;
    std::set<std::pair<std::size_t, Key>> seen_;
};

PictureLodSearch::PictureLodSearch(
    const ShownModel& original, const Raster& image, const PictureLodBits& most
)
    : impl_(std::make_unique<Impl>(original, image, most))
{
}

PictureLodSearch::~PictureLodSearch() = default;

Result<PictureLod> PictureLodSearch::best(std::size_t bytes, const PictureJudge& judge)
{
    return impl_->best(bytes, judge);
}

}  // namespace vsplit::bench
