#include <cmath>
#include <string>
#include <utility>

#include "base/memory_guard.h"
#include "mesh/attributes.h"
#include "mesh/blended_points.h"
#include "mesh/close_gaps.h"
#include "mesh/draft.h"
#include "mesh/weld.h"
#include "papilio/error.h"
#include "papilio/mesh.h"

namespace papilio {
namespace {

void check_mesh(const TriangleMesh& input) {
  const size_t points = input.positions.size();
  if (points >= none) throw Error(Fault::index_out_of_range, "The mesh has more points than 32 bits can number.");
  if (input.triangles.size() > face_count_limit)
    throw Error(Fault::result_too_large, "The mesh has more than 2^30 faces. Use fewer.");
  for (size_t f = 0; f < input.triangles.size(); ++f)
    for (uint32_t p : input.triangles[f])
      if (p >= points)
        throw Error(Fault::index_out_of_range, "Face " + std::to_string(f) + " names point " + std::to_string(p) +
                                                   ", but there are only " + std::to_string(points) + " points.");
  for (size_t p = 0; p < points; ++p) {
    const Vec3f v = input.positions[p];
    const auto usable = [](float c) { return std::abs(c) <= coordinate_limit; };  // false for NaN
    if (!usable(v.x) || !usable(v.y) || !usable(v.z))
      throw Error(Fault::not_finite, "Point " + std::to_string(p) +
                                         " has a coordinate that is NaN, infinite or beyond 1e18. Repair or rescale "
                                         "the mesh.");
  }
}

Mesh build(const TriangleMesh& input, BuildReport* report, double gap) {
  check_mesh(input);
  Draft draft;
  draft.topology.origin = weld(input, draft.positions, draft.report, draft.corner_point);
  if (draft.topology.origin.empty()) {
    throw Error(Fault::no_faces, input.triangles.empty()
                                     ? "The mesh has no faces. Use a triangle mesh."
                                     : "Every face of the mesh has two corners in one place, so there is no surface "
                                       "to refine. Check the mesh's scale and precision.");
  }
  connect(draft);
  BlendedPoints points(input);
  if (gap > 0) close_gaps(draft, points, gap * bounding_box(draft.positions).diagonal());
  if (report != nullptr) *report = draft.report;
  PointAttributes attributes = gather_attributes(points.mesh(), draft.topology, draft.corner_point);
  return {std::move(draft.topology), std::move(draft.positions), std::move(attributes)};
}

}  // namespace

Mesh build_mesh(const TriangleMesh& input, BuildReport* report, double gap) {
  return guard_memory([&] { return build(input, report, gap); },
                      "There is not enough memory for this mesh. Use a smaller one.");
}

}  // namespace papilio
