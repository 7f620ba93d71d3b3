// Based on: Khronos, "glTF 2.0 Specification", 2021, section 3.6.2 (accessors, sparse accessors and the
// equations that decode normalised integers).
#include "precompute/gltf_accessor.h"

#include "format.h"
#include "precompute/gltf_document.h"

#include <algorithm>
#include <bit>
#include <optional>

namespace vsplit::precompute {
namespace {

tl::unexpected<Error> bad_accessor(int accessor)
{
    return fail(
        ErrorCode::NotAMesh,
        "accessor " + std::to_string(accessor) + " of the glTF file does not fit its buffer"
    );
}

std::size_t component_bytes(int type)
{
    switch (type)
    {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return 1;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return 2;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            return 4;
        default:
            return 0;
    }
}

std::size_t component_count(int type)
{
    switch (type)
    {
        case TINYGLTF_TYPE_SCALAR:
            return 1;
        case TINYGLTF_TYPE_VEC2:
            return 2;
        case TINYGLTF_TYPE_VEC3:
            return 3;
        case TINYGLTF_TYPE_VEC4:
            return 4;
        default:
            return 0;
    }
}

/// A checked run of elements.
struct Elements
{
    std::span<const std::byte> bytes;
    std::size_t stride = 0;
    std::size_t count = 0;
    int type = 0;  ///< Of the components.

    [[nodiscard]] std::uint32_t bits(std::size_t element, std::size_t component) const
    {
        const std::size_t size = component_bytes(type);
        const std::size_t first = element * stride + component * size;
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < size; ++i)
        {
            value |= static_cast<std::uint32_t>(bytes[first + i]) << (8 * i);
        }
        return value;
    }

    [[nodiscard]] float number(std::size_t element, std::size_t component, bool normalized) const
    {
        const std::uint32_t raw = bits(element, component);
        switch (type)
        {
            case TINYGLTF_COMPONENT_TYPE_BYTE:
            {
                const auto value = static_cast<float>(static_cast<std::int8_t>(raw));
                return normalized ? std::max(value / 127.0F, -1.0F) : value;
            }
            case TINYGLTF_COMPONENT_TYPE_SHORT:
            {
                const auto value = static_cast<float>(static_cast<std::int16_t>(raw));
                return normalized ? std::max(value / 32767.0F, -1.0F) : value;
            }
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
                return static_cast<float>(raw) / (normalized ? 255.0F : 1.0F);
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
                return static_cast<float>(raw) / (normalized ? 65535.0F : 1.0F);
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
                return static_cast<float>(raw);
            default:
                return std::bit_cast<float>(raw);
        }
    }
};

/// Finds elements in a buffer view; nothing when they leave it.
std::optional<Elements> find_elements(
    const tinygltf::Model& model,
    int view,
    std::size_t offset,
    std::size_t count,
    int type,
    std::size_t components
)
{
    const auto bytes = view_bytes(model, view);
    const std::size_t size = component_bytes(type) * components;
    if (!bytes || size == 0 || offset > bytes->size() || count > proto::kMaxVertices * 8ULL)
    {
        return std::nullopt;
    }
    constexpr std::size_t kMaxStride = 1024;  // 252 by the specification
    const std::size_t given = model.bufferViews[static_cast<std::size_t>(view)].byteStride;
    const std::size_t stride = given == 0 ? size : given;
    const std::size_t left = bytes->size() - offset;
    if (stride > kMaxStride || (count > 0 && (left < size || (left - size) / stride < count - 1)))
    {
        return std::nullopt;
    }
    return Elements{bytes->subspan(offset), stride, count, type};
}

/// An accessor without a buffer view is all zeroes, of as many elements as it says.
bool is_plausible(const tinygltf::Model& model, std::size_t count)
{
    std::size_t bytes = 0;
    for (const tinygltf::Buffer& buffer : model.buffers)
    {
        bytes += buffer.data.size();
    }
    return count <= bytes;
}

bool apply_sparse(
    const tinygltf::Model& model, const tinygltf::Accessor& row, AccessorValues& result
)
{
    const auto& sparse = row.sparse;
    if (sparse.count < 0 || sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0)
    {
        return false;
    }
    const auto count = static_cast<std::size_t>(sparse.count);
    const auto indices = find_elements(
        model,
        sparse.indices.bufferView,
        static_cast<std::size_t>(sparse.indices.byteOffset),
        count,
        sparse.indices.componentType,
        1
    );
    const auto values = find_elements(
        model,
        sparse.values.bufferView,
        static_cast<std::size_t>(sparse.values.byteOffset),
        count,
        row.componentType,
        result.components
    );
    for (std::size_t i = 0; indices && values && i < count; ++i)
    {
        const std::size_t target = indices->bits(i, 0);
        if (target >= result.size())
        {
            return false;
        }
        for (std::size_t c = 0; c < result.components; ++c)
        {
            result.values[target * result.components + c] = values->number(i, c, row.normalized);
        }
    }
    return indices && values;
}

}  // namespace

Result<AccessorValues> read_values(const tinygltf::Model& model, int accessor)
{
    if (accessor < 0 || static_cast<std::size_t>(accessor) >= model.accessors.size())
    {
        return bad_accessor(accessor);
    }
    const tinygltf::Accessor& row = model.accessors[static_cast<std::size_t>(accessor)];
    AccessorValues result;
    result.components = component_count(row.type);
    if (result.components == 0)
    {
        return bad_accessor(accessor);
    }
    if (row.bufferView >= 0)
    {
        const auto elements = find_elements(
            model, row.bufferView, row.byteOffset, row.count, row.componentType, result.components
        );
        if (!elements)
        {
            return bad_accessor(accessor);
        }
        result.values.reserve(row.count * result.components);
        for (std::size_t i = 0; i < row.count * result.components; ++i)
        {
            result.values.push_back(
                elements->number(i / result.components, i % result.components, row.normalized)
            );
        }
    }
    else if (is_plausible(model, row.count))
    {
        result.values.assign(row.count * result.components, 0.0F);
    }
    else
    {
        return bad_accessor(accessor);
    }
    const bool whole = !row.sparse.isSparse || apply_sparse(model, row, result);
    return whole ? Result<AccessorValues>(std::move(result)) : bad_accessor(accessor);
}

Result<std::vector<std::uint32_t>> read_indices(const tinygltf::Model& model, int accessor)
{
    if (accessor < 0 || static_cast<std::size_t>(accessor) >= model.accessors.size())
    {
        return bad_accessor(accessor);
    }
    const tinygltf::Accessor& row = model.accessors[static_cast<std::size_t>(accessor)];
    const bool whole = row.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                       row.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                       row.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    const auto elements =
        find_elements(model, row.bufferView, row.byteOffset, row.count, row.componentType, 1);
    if (!elements || !whole || row.type != TINYGLTF_TYPE_SCALAR || row.sparse.isSparse)
    {
        return bad_accessor(accessor);
    }
    std::vector<std::uint32_t> indices;
    indices.reserve(row.count);
    for (std::size_t i = 0; i < row.count; ++i)
    {
        indices.push_back(elements->bits(i, 0));
    }
    return indices;
}

}  // namespace vsplit::precompute
