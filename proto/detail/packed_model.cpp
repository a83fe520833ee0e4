#include "proto/detail/packed_model.h"

#include <algorithm>

namespace papilio::proto::detail {

std::vector<DetailStream> PackedModel::streams() const {
  std::vector<DetailStream> out;
  for (const PackedLevel& level : levels) out.push_back(level.stream);
  return out;
}

bool PackedModel::has_texcoords() const {
  const std::vector<Attribute>& attributes = base.triangles.attributes;
  return !attributes.empty() && attributes[0].components == 2;
}

bool PackedModel::has_colours() const {
  return std::ranges::count(base.triangles.attributes, 3U, &Attribute::components) > 0;
}

DetailReach reach_of(const PackedModel& model) {
  return model.levels.empty() ? model.base_reach : model.levels.back().reach;
}

}  // namespace papilio::proto::detail
