#include "detail/base_attributes.h"

#include "papilio/error.h"

namespace papilio {

void require_detail_attributes(const std::vector<Attribute>& attributes) {
  size_t known = 0;
  for (const uint32_t components : {2U, 3U, 1U})
    if (known < attributes.size() && attributes[known].components == components) ++known;
  if (attributes.size() > known)
    throw Error(Fault::bad_option,
                "Detail carries texture coordinates, an attribute of two components, then colours, of three, then "
                "parts, of one. Leave the others out.");
}

void require_whole_parts(const Mesh& mesh) {
  const std::vector<Attribute>& attributes = mesh.attributes.attributes;
  if (attributes.empty() || attributes.back().components != 1) return;
  const auto part = [&](uint32_t h) { return attributes.back().values[mesh.attributes.point[h]]; };
  for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h)
    if (part(h) != part(Topology::next(h)))
      throw Error(Fault::bad_option, "A face has corners in several parts. Give each part points of its own.");
}

}  // namespace papilio
