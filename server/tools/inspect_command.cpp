#include "commands.h"
#include "report.h"
#include "stream_file.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <memory>
#include <string>

namespace vsplit::tools {
namespace {

struct InspectArguments
{
    std::string file;
    std::string json;
};

const char* kind_name(const codec::ChunkInfo& chunk)
{
    switch (chunk.kind)
    {
        case proto::ChunkKind::Base:
            return "base";
        case proto::ChunkKind::Batch:
            return "batch";
        case proto::ChunkKind::Growth:
            return "growth";
        case proto::ChunkKind::Parts:
            return "parts";
        case proto::ChunkKind::Stitch:
            return "stitch";
        case proto::ChunkKind::Attributes:
            return chunk.codec == proto::kNormalsCodec    ? "normals"
                   : chunk.codec == proto::kLateBitsCodec ? "late bits"
                                                          : "attributes";
        case proto::ChunkKind::Appearance:
            return "appearance";
        case proto::ChunkKind::Texture:
            return "texture";
    }
    return "unknown";
}

Json chunks_json(const codec::StreamInfo& info)
{
    Json rows = Json::array();
    for (const codec::ChunkInfo& chunk : info.chunks)
    {
        rows.push_back({
            {"kind", kind_name(chunk)},
            {"codec", chunk.codec},
            {"offset", chunk.offset},
            {"bytes", chunk.bytes},
            {"vertices", chunk.vertices},
            {"faces", chunk.faces},
            {"ends_level", chunk.ends_level},
            {"tag", chunk.tag},
        });
    }
    return rows;
}

Json info_json(const StreamFile& stream)
{
    const codec::StreamInfo& info = stream.info();
    return {
        {"version", {{"major", info.major}, {"minor", info.minor}}},
        {"vertices", info.vertex_count},
        {"faces", info.face_count},
        {"position_bits", info.grid.bits},
        {"grid", {{"origin", info.grid.origin}, {"cell", info.grid.cell}}},
        {"box", {{"min", info.box_min}, {"max", info.box_max}}},
        {"diagonal", info.diagonal()},
        {"bytes", info.file_bytes},
        {"bytes_present", stream.size()},
        {"header_bytes", info.header_bytes},
        {"bits_per_vertex", bits_per_vertex(info, info.file_bytes)},
        {"decoder_heap_bytes", codec::decoder_heap_bytes(info)},
        {"base", base_json(info)},
        {"levels", levels_json(info)},
        {"chunks", chunks_json(info)},
    };
}

void print_info(const StreamFile& stream)
{
    const codec::StreamInfo& info = stream.info();
    std::printf(
        "%s: stream version %d.%d, %llu bytes (%.2f bits a vertex)\n",
        stream.path().c_str(),
        info.major,
        info.minor,
        static_cast<unsigned long long>(info.file_bytes),
        bits_per_vertex(info, info.file_bytes)
    );
    if (stream.size() != info.file_bytes)
    {
        std::printf(
            "  the file has %llu bytes instead\n", static_cast<unsigned long long>(stream.size())
        );
    }
    std::printf(
        "  %u vertices, %u faces, %d bits a coordinate, cell %.9g\n",
        info.vertex_count,
        info.face_count,
        info.grid.bits,
        info.grid.cell
    );
    std::printf(
        "  box %.9g %.9g %.9g to %.9g %.9g %.9g, diagonal %.9g\n",
        info.box_min[0],
        info.box_min[1],
        info.box_min[2],
        info.box_max[0],
        info.box_max[1],
        info.box_max[2],
        info.diagonal()
    );
    std::printf(
        "  header and index %u bytes, %zu chunks, decoder heap at most %llu bytes\n",
        info.header_bytes,
        info.chunks.size(),
        static_cast<unsigned long long>(codec::decoder_heap_bytes(info))
    );
    print_levels(stdout, info);
}

Result<void> run(const InspectArguments& arguments)
{
    const auto stream = StreamFile::open(arguments.file);
    VSPLIT_TRY(stream);
    if (arguments.json != "-")
    {
        print_info(*stream);
    }
    return write_json(info_json(*stream), arguments.json);
}

}  // namespace

void add_inspect_command(CLI::App& app, Result<void>& result)
{
    const auto arguments = std::make_shared<InspectArguments>();
    CLI::App* const command = app.add_subcommand(
        "inspect", "Shows header, index and levels of a stream without decoding it"
    );
    command->add_option("FILE", arguments->file, "The stream; it may be cut off")->required();
    command->add_option("--json", arguments->json, "Write JSON to a file, or to stdout with -");
    command->callback([arguments, &result] { result = run(*arguments); });
}

}  // namespace vsplit::tools
