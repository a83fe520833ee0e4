#include "in_place.h"

#include "butterfly.h"
#include "split.h"

namespace papilio {

Mesh refine_in_place(Mesh mesh, const SplitPlan& plan, float w) {
  const std::vector<Vec3f> added = butterfly(mesh.topology, mesh.positions, plan, w);
  mesh.positions.insert(mesh.positions.end(), added.begin(), added.end());
  mesh.topology = split(mesh.topology, plan, mesh.positions);
  return mesh;
}

}  // namespace papilio
