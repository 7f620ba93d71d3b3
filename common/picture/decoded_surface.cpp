#include "picture/decoded_surface.h"

#include "core/assert.h"

#include <utility>

namespace vsplit::picture {
namespace {

SurfaceAttribute copy_attribute(
    const codec::AttributeInfo& info,
    const std::vector<std::int32_t>& coded,
    const std::vector<Triangle>& wedges
)
{
    SurfaceAttribute attribute;
    attribute.kind = info.kind;
    attribute.set = info.set;
    attribute.components = info.components;
    attribute.name = info.name;
    attribute.values.resize(coded.size() / codec::coded_components(info) * info.components);
    codec::write_values(info, coded, attribute.values);
    attribute.corners = wedges;
    return attribute;
}

}  // namespace

std::vector<SurfaceAttribute> decoded_attributes(
    std::span<const codec::AttributeInfo> infos, const codec::LevelAttributes& attributes
)
{
    VSPLIT_ASSERT(attributes.values.size() == infos.size());
    std::vector<SurfaceAttribute> result;
    for (std::size_t i = 0; i < infos.size(); ++i)
    {
        if (!attributes.values[i].empty())
        {
            result.push_back(copy_attribute(infos[i], attributes.values[i], attributes.wedges));
        }
    }
    return result;
}

Surface decoded_surface(const codec::StreamDecoder& decoder)
{
    Surface surface;
    surface.mesh = codec::extract_mesh(decoder, false);
    const codec::LevelAttributes* const attributes = decoder.attributes();
    if (attributes == nullptr || attributes->wedges.size() != surface.mesh.triangles.size())
    {
        return surface;
    }
    surface.groups = attributes->groups;
    surface.attributes = decoded_attributes(decoder.info()->attributes, *attributes);
    return surface;
}

}  // namespace vsplit::picture
