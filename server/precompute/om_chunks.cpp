// Based on: OpenMesh 9.0, OMFormat.hh, OMReader.cc and OMWriter.cc; the format has no other
// specification.
#include "precompute/om_chunks.h"

#include "core/byte_reader.h"
#include "format.h"

#include <OpenMesh/Core/IO/OMFormat.hh>

#include <algorithm>
#include <cstdint>
#include <utility>

namespace vsplit::precompute {
namespace {

namespace om = OpenMesh::IO::OMFormat;
using om::Chunk;

/// Half-edges have signed handles.
constexpr std::uint32_t kMostEdges = (1U << 30) - 1;

tl::unexpected<Error> not_om(const std::string& what)
{
    return fail(ErrorCode::NotAMesh, what);
}

/// The chunks of an OpenMesh file.
class OmChunks
{
public:
    explicit OmChunks(std::span<const std::byte> file) : file_(file), reader_(file) {}

    /// Returns the file without what is not needed. Errors: NotAMesh, Truncated.
    Result<std::string> geometry()
    {
        VSPLIT_TRY(read_header());
        keep_from(0);
        while (reader_.remaining() > 0)
        {
            const std::size_t begin = reader_.position();
            const auto bits = reader_.read<std::uint16_t>();
            VSPLIT_TRY(bits);
            Chunk::Header chunk{};
            chunk << *bits;
            if (chunk.entity_ == Chunk::Entity_Sentinel)
            {
                break;
            }
            VSPLIT_TRY(chunk.name_ != 0 ? skip_name() : Result<void>{});
            VSPLIT_TRY(skip_data(chunk));
            if (is_geometry(chunk))
            {
                VSPLIT_TRY(check_geometry(chunk));
                keep_from(begin);
            }
        }
        constexpr auto kSentinel = static_cast<char>(Chunk::Entity_Sentinel << Chunk::OFF_ENTITY);
        kept_ += {kSentinel, '\0'};
        return std::move(kept_);
    }

private:
    Result<void> read_header()
    {
        const auto start = reader_.read<std::uint32_t>();
        const auto vertices = reader_.read<std::uint32_t>();
        const auto faces = reader_.read<std::uint32_t>();
        const auto edges = reader_.read<std::uint32_t>();
        VSPLIT_TRY(edges);
        const std::string magic{static_cast<char>(*start), static_cast<char>(*start >> 8)};
        kind_ = static_cast<char>(*start >> 16);
        version_ = static_cast<std::uint8_t>(*start >> 24);
        if (magic != "OM" || (kind_ != 'T' && kind_ != 'Q' && kind_ != 'P'))
        {
            return not_om("it does not start as an OpenMesh file does");
        }
        if (version_ > om::mk_version(2, 2))
        {
            return fail(
                ErrorCode::UnsupportedInput,
                "OpenMesh files of version " + std::to_string(om::major_version(version_)) + "." +
                    std::to_string(om::minor_version(version_)) + " are not supported"
            );
        }
        vertices_ = *vertices;
        faces_ = *faces;
        edges_ = *edges;
        if (vertices_ > proto::kMaxVertices || faces_ > proto::kMaxFaces || edges_ > kMostEdges)
        {
            return fail(ErrorCode::InputTooLarge, "it claims more than a mesh can have");
        }
        return {};
    }

    Result<void> skip(std::uint64_t bytes)
    {
        VSPLIT_TRY(reader_.read_bytes(
            static_cast<std::size_t>(std::min<std::uint64_t>(bytes, file_.size() + 1))
        ));
        return {};
    }

    Result<void> skip_name()
    {
        const auto length = reader_.read<std::uint8_t>();
        VSPLIT_TRY(length);
        return skip(*length);
    }

    Result<void> skip_data(const Chunk::Header& chunk)
    {
        switch (chunk.type_)
        {
            case Chunk::Type_Pos:
            case Chunk::Type_Normal:
                return skip(count_of(chunk) * (chunk.bits_ == Chunk::Float_32 ? 12 : 24));
            case Chunk::Type_Texcoord:
                return skip(count_of(chunk) * 8);
            case Chunk::Type_Status:
                return skip(count_of(chunk) * 4);
            case Chunk::Type_Color:
                return skip(count_of(chunk) * 3);
            case Chunk::Type_Topology:
                return skip_topology(chunk);
            case Chunk::Type_Custom:
                return skip_custom();
            default:
                return not_om("it holds a chunk of unknown type");
        }
    }

    Result<void> skip_custom()
    {
        if (version_ > om::mk_version(2, 1))
        {
            VSPLIT_TRY(skip_name());  // of the type
        }
        const auto bytes = reader_.read<std::uint32_t>();
        VSPLIT_TRY(bytes);
        return skip(*bytes);
    }

    Result<void> skip_topology(const Chunk::Header& chunk)
    {
        const std::uint64_t width = std::uint64_t{1} << chunk.bits_;
        if (chunk.entity_ == Chunk::Entity_Halfedge)
        {
            return skip(count_of(chunk) * 3 * width);
        }
        if (chunk.entity_ != Chunk::Entity_Face || version_ >= om::mk_version(2, 0))
        {
            return skip(count_of(chunk) * width);
        }
        if (kind_ != 'P')
        {
            return skip(count_of(chunk) * (kind_ == 'T' ? 3 : 4) * width);
        }
        for (std::uint32_t face = 0; face < faces_; ++face)
        {
            const auto corners = reader_.read<std::uint16_t>();
            VSPLIT_TRY(corners);
            VSPLIT_TRY(skip(*corners * width));
        }
        return {};
    }

    [[nodiscard]] std::uint64_t count_of(const Chunk::Header& chunk) const
    {
        switch (chunk.entity_)
        {
            case Chunk::Entity_Vertex:
                return vertices_;
            case Chunk::Entity_Face:
                return faces_;
            case Chunk::Entity_Edge:
                return edges_;
            case Chunk::Entity_Halfedge:
                return std::uint64_t{2} * edges_;
            default:
                return 1;  // the mesh
        }
    }

    /// The chunks that become the mesh; a vertex's half-edge is not needed.
    [[nodiscard]] static bool is_geometry(const Chunk::Header& chunk)
    {
        const bool position =
            chunk.type_ == Chunk::Type_Pos && chunk.entity_ == Chunk::Entity_Vertex;
        const bool topology =
            chunk.type_ == Chunk::Type_Topology &&
            (chunk.entity_ == Chunk::Entity_Halfedge || chunk.entity_ == Chunk::Entity_Face);
        return chunk.name_ == 0 && (position || topology);
    }

    Result<void> check_geometry(const Chunk::Header& chunk)
    {
        if (chunk.type_ == Chunk::Type_Pos &&
            (chunk.dim_ != Chunk::Dim_3D || chunk.bits_ > Chunk::Float_64))
        {
            return not_om("its positions are not three floating-point numbers each");
        }
        if (chunk.type_ == Chunk::Type_Topology && chunk.bits_ > Chunk::Integer_32)
        {
            return not_om("its topology has integers of 64 bits, which OpenMesh does not read");
        }
        const unsigned bit = 1U << chunk.entity_;
        if ((seen_ & bit) != 0)
        {
            return not_om("it holds the same chunk twice");
        }
        seen_ |= bit;
        return {};
    }

    void keep_from(std::size_t begin)
    {
        const auto part = file_.subspan(begin, reader_.position() - begin);
        kept_.append(reinterpret_cast<const char*>(part.data()), part.size());
    }

    std::span<const std::byte> file_;
    ByteReader reader_;
    char kind_ = 'T';
    std::uint8_t version_ = 0;
    std::uint32_t vertices_ = 0;
    std::uint32_t faces_ = 0;
    std::uint32_t edges_ = 0;
    unsigned seen_ = 0;  ///< Entities whose geometry came.
    std::string kept_;
};

}  // namespace

Result<std::string> om_geometry(std::span<const std::byte> file)
{
    return OmChunks(file).geometry().map_error([](Error error) {
        return error.code == ErrorCode::Truncated
                   ? Error{ErrorCode::NotAMesh, "the file ends too early", error.offset}
                   : error;
    });
}

}  // namespace vsplit::precompute
