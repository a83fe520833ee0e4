#include <cmath>
#include <memory>
#include <string>

#include "detail/base_curves.h"
#include "detail/detail_level.h"
#include "detail/manifold_surface.h"
#include "detail/residual_frames.h"
#include "detail/residuals.h"
#include "papilio/detail.h"
#include "papilio/error.h"

namespace papilio {
namespace {

void check(const Mesh& base, std::span<const DetailStream> levels, uint64_t face_limit) {
  if (levels.size() > static_cast<size_t>(most_detail_levels))
    throw Error(Fault::bad_option,
                "Detail has " + std::to_string(levels.size()) + " levels; at most " +
                    std::to_string(most_detail_levels) + " are decoded.",
                "levels");
  for (const DetailStream& level : levels)
    if (!(level.step > 0 && level.step <= coordinate_limit))
      throw Error(Fault::bad_option, "A level of detail has a step that is not above 0.", "step");
  const uint64_t faces = uint64_t{base.topology.face_count()} << (2 * levels.size());
  if (faces > std::min(face_limit, face_count_limit))
    throw Error(Fault::result_too_large, "Detail of " + std::to_string(levels.size()) + " levels has " +
                                             std::to_string(faces) + " faces, more than the limit of " +
                                             std::to_string(face_limit) + ". Decode fewer levels.");
}

void require_finite(const Buffer<Vec3f>& positions) {
  for (const Vec3f p : positions)
    if (!(std::abs(p.x) <= coordinate_limit && std::abs(p.y) <= coordinate_limit && std::abs(p.z) <= coordinate_limit))
      throw Error(Fault::not_finite, "Detail moves a vertex beyond the largest coordinate: it is damaged.");
}

}  // namespace

TriangleMesh decode_detail(const DetailBase& base, std::span<const DetailStream> levels, uint64_t face_limit,
                           const std::function<bool()>& cancelled) {
  Mesh mesh = build_mesh(base.triangles);
  require_manifold(mesh);
  decode_base_curves(base.curves, mesh.topology);
  check(mesh, levels, face_limit);
  Buffer<Vec3f> positions = std::move(mesh.positions);
  Buffer<int32_t> at_vertex(positions.size());
  const auto models = std::make_unique<ResidualModels>();
  DetailLevel level(std::move(mesh.topology));
  for (const DetailStream& stream : levels) {
    if (cancelled && cancelled()) throw Error(Fault::cancelled, "Decoding was cancelled.");
    const Buffer<Vec3f> normals = residual_normals(level, positions.data());
    level.predict(positions);
    const Residuals residuals = decode_residuals(level, stream.bytes, stream.step, at_vertex, positions, *models);
    displace(level, normals, residuals, positions);
    require_finite(positions);
    at_vertex.insert(at_vertex.end(), residuals.along_normal.begin(), residuals.along_normal.end());
    level = level.next();
  }
  const Topology& t = level.topology();
  TriangleMesh made;
  made.positions = std::move(positions);
  made.triangles.reserve(t.face_count());
  for (uint32_t h = 0; h < t.half_edge_count(); h += 3)
    made.triangles.push_back({t.origin[h], t.origin[h + 1], t.origin[h + 2]});
  return made;
}

}  // namespace papilio
