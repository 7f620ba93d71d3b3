#include "refiner.h"

namespace vsplit::client {

Refiner::Refiner(const codec::StreamInfo& info, const codec::DecodeLimits& limits)
    : decoder_(limits),
      buffers_(info.diagonal()),
      positions_([this](std::uint32_t first, std::uint32_t count, std::span<float> out) {
          decoder_.write_positions(first, count, out);
      }),
      triangles_([this](std::span<Triangle> out) { decoder_.write_triangles(out); })
{
    buffers_.reserve(info.vertex_count, info.face_count);
}

Result<std::size_t> Refiner::feed(std::span<const std::byte> bytes)
{
    return decoder_.feed(bytes);
}

Result<Progress> Refiner::advance(std::chrono::duration<double> budget)
{
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    Progress progress;
    bool going = true;
    while (going)
    {
        const auto step = decoder_.step();
        VSPLIT_TRY(step);
        if (step->kind == codec::StepKind::NeedBytes || step->kind == codec::StepKind::Complete)
        {
            break;
        }
        if (step->kind == codec::StepKind::Chunk)
        {
            buffers_.apply(*step, positions_, triangles_);
            progress.changed = true;
        }
        progress.chunk_bytes += step->chunk_bytes;
        progress.level_complete = step->level_complete;
        going = !step->level_complete && Clock::now() - start < budget;
    }
    progress.decoding = Clock::now() - start;
    return progress;
}

}  // namespace vsplit::client
