#include "hierarchy/memory_plan.h"

#include <algorithm>

#include "mesh/attributes.h"
#include "papilio/detail.h"

namespace papilio {
namespace {

constexpr uint64_t face_bytes_of_result = 60;    // connectivity and positions, with the room that arrays keep
constexpr uint64_t face_bytes_of_decoding = 40;  // of a level of detail
/// Values are held in arrays that grow, while those of the level before are still there.
constexpr uint64_t growth = 2;

}  // namespace

MemoryPlan::MemoryPlan(const Mesh& coarse, const Options& options)
    : coarse_faces_(coarse.topology.face_count()),
      coarse_points_(coarse.attributes.empty() ? coarse.topology.vertex_count : coarse.attributes.point_count),
      output_(options.output) {
  if (coarse.detail) detail_levels_ = coarse.detail->level_count();
  for (uint32_t h = 0; h < coarse.topology.half_edge_count(); ++h)
    open_ += coarse.topology.twin[h] == none || is_seam(coarse.topology, coarse.attributes, h) ? 1 : 0;
  for (const Attribute& attribute : coarse.attributes.attributes)
    point_bytes_ += (attribute.is_displacement ? 2 : 1) * growth * attribute.components * sizeof(double);
  if (!coarse.attributes.empty())
    corner_bytes_ = 6 * sizeof(uint32_t);  // of the corners and of those made on the edges
}

// Each half-edge that is split adds one face. A point is made for each, but two half-edges share it unless they are
// open; and each level doubles these.
uint64_t MemoryPlan::points(uint64_t faces, int level) const {
  const uint64_t made = faces - std::min(faces, coarse_faces_);
  const uint64_t open = open_ * ((uint64_t{1} << level) - 1);
  return coarse_points_ + (made + std::min(made, open) + 1) / 2;
}

uint64_t MemoryPlan::made(uint64_t faces, int level, uint64_t face_bytes) const {
  const uint64_t decoding = level <= detail_levels_ ? face_bytes_of_decoding : 0;
  return faces * (face_bytes + corner_bytes_ + decoding) + points(faces, level) * point_bytes_;
}

uint64_t MemoryPlan::given(uint64_t faces, int level) const {
  return made(faces, level, face_bytes_of_result + output_.face) + points(faces, level) * output_.point;
}

}  // namespace papilio
