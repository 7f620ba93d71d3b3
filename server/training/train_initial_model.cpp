// Learns the state in which every stream starts, from a list of meshes: prints the contents of
// proto/initial_model.inc. Run through scripts/train-model; a new table is a new format.
#include "codec/initial_model.h"
#include "precompute/encode_mesh.h"
#include "precompute/mesh_io.h"
#include "precompute/repair.h"

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <vector>

namespace {

using namespace vsplit;

/// Rounds over all meshes; each starts from what the round before taught on average.
constexpr int kRounds = 3;

/// Bytes per line of the table.
constexpr std::size_t kColumns = 24;

IndexedMesh load(const char* path, std::vector<std::uint32_t>& stitches)
{
    const auto mesh = precompute::read_mesh(path);
    auto repaired = mesh.and_then([](const IndexedMesh& m) { return precompute::repair_mesh(m); });
    if (!repaired)
    {
        std::fprintf(
            stderr, "train_initial_model: %s: %s\n", path, describe(repaired.error()).c_str()
        );
        std::exit(exit_status(repaired.error().code));
    }
    stitches = std::move(repaired->stitches);
    return std::move(repaired->mesh);
}

void print_table(const std::vector<std::uint8_t>& packed)
{
    for (std::size_t i = 0; i < packed.size(); ++i)
    {
        std::printf("%u,%s", packed[i], (i + 1) % kColumns == 0 ? "\n" : "");
    }
    std::printf("\n");
}

codec::LearnedModel unpack_round(const std::vector<codec::LearnedModel>& learned)
{
    codec::LearnedModel mean{};
    auto* const weights = reinterpret_cast<std::int32_t*>(&mean.connectivity);
    for (std::size_t i = 0; i < sizeof(mean.connectivity) / sizeof(std::int32_t); ++i)
    {
        double sum = 0.0;
        for (const auto& model : learned)
        {
            sum += reinterpret_cast<const std::int32_t*>(&model.connectivity)[i];
        }
        weights[i] = static_cast<std::int32_t>(sum / static_cast<double>(learned.size()));
    }
    return mean;
}

}  // namespace

int main(int argc, char** argv)
{
    std::vector<codec::LearnedModel> learned;
    codec::LearnedModel start{};
    for (int round = 0; round < kRounds; ++round)
    {
        learned.clear();
        double bits = 0.0;
        for (int i = 1; i < argc; ++i)
        {
            std::vector<std::uint32_t> stitches;
            const IndexedMesh mesh = load(argv[i], stitches);
            codec::LearnedModel model = start;
            const auto encoded = precompute::encode_mesh(mesh, stitches, {.training = &model});
            if (!encoded)
            {
                std::fprintf(stderr, "%s: %s\n", argv[i], describe(encoded.error()).c_str());
                return exit_status(encoded.error().code);
            }
            bits += 8.0 * static_cast<double>(encoded->file.size()) /
                    static_cast<double>(mesh.positions.size());
            learned.push_back(model);
        }
        std::fprintf(stderr, "round %d: %.3f bits a vertex on average\n", round, bits / (argc - 1));
        start = unpack_round(learned);
    }
    print_table(codec::pack_model(learned));
}
