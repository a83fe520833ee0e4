#include "detail/base_attributes.h"

#include "papilio/error.h"

namespace papilio {

void require_detail_attributes(const std::vector<Attribute>& attributes) {
  size_t known = has_texcoords(attributes) ? 1 : 0;
  if (attributes.size() > known && attributes[known].components == 1) ++known;
  if (attributes.size() > known)
    throw Error(Fault::bad_option,
                "Detail carries texture coordinates, an attribute of two components, and behind them parts, one of one "
                "component. Leave the others out.");
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
