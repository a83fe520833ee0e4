#include "proto/detail/packed_model.h"

namespace papilio::proto::detail {

std::vector<DetailStream> PackedModel::streams() const {
  std::vector<DetailStream> out;
  for (const PackedLevel& level : levels) out.push_back(level.stream);
  return out;
}

}  // namespace papilio::proto::detail
