#include "hierarchy/memory_plan.h"

#include <algorithm>

#include "mesh/attributes.h"
#include "papilio/detail.h"

namespace papilio {
namespace {

constexpr uint64_t face_bytes_of_result = 60;    // connectivity and positions, with spare capacity
constexpr uint64_t face_bytes_of_decoding = 40;  // decoding of a level of detail
/// Factor for values in growing arrays, held together with the values of the level before.
constexpr uint64_t growth = 2;

}  // namespace

MemoryPlan::MemoryPlan(const Mesh& coarse, const Options& options)
    : coarse_faces_(coarse.topology.face_count()),
      coarse_points_(coarse.attributes.empty() ? coarse.topology.vertex_count : coarse.attributes.point_count),
      output_(options.output) {
  if (coarse.detail) detail_levels_ = coarse.detail->level_count();
  const bool has_seams = !coarse.attributes.empty();
  for (HalfEdgeId h = 0; h < coarse.topology.half_edge_count(); ++h)
    open_ += coarse.topology.twin[h] == none || (has_seams && is_seam(coarse.topology, coarse.attributes, h)) ? 1 : 0;
  for (const Attribute& attribute : coarse.attributes.attributes)
    point_bytes_ += (attribute.is_displacement ? 2 : 1) * growth * attribute.components * sizeof(double);
  if (!coarse.attributes.empty()) corner_bytes_ = 6 * sizeof(uint32_t);  // points at a face's corners and on its edges
}

// Each split half-edge adds one face and one point, which two half-edges share unless they are open. Each level doubles
// the open half-edges.
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
