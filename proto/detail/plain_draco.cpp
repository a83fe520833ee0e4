#include "proto/detail/plain_draco.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "papilio/refine.h"
#include "proto/detail/base_coder.h"
#include "proto/detail/packed_normals.h"
#include "proto/detail/packed_texcoords.h"
#include "proto/detail/packed_writer.h"
#include "proto/detail/part_streams.h"
#include "proto/gltf/document.h"
#include "proto/gltf/extensions.h"
#include "proto/gltf/flattening.h"

namespace papilio::proto::detail {
namespace {

/// Rounding of positions to Draco's grid, in double precision.
class GridMoves {
 public:
  GridMoves(const QuantizationBox& box, int bits)
      : origin_(to_double(box.origin)), step_(static_cast<double>(box.range) / ((1 << bits) - 1)) {}
  [[nodiscard]] Vec3d operator()(Vec3d p) const {
    const Vec3d at = p - origin_;
    return Vec3d{rounded(at.x), rounded(at.y), rounded(at.z)} - at;
  }

 private:
  [[nodiscard]] double rounded(double x) const { return std::floor(x / step_ + 0.5) * step_; }
  Vec3d origin_;
  double step_;
};

/// Returns the style of normals in the extras of a primitive.
NormalStyle style_of(const gltf::Json& primitive) {
  const auto extras = primitive.find("extras");
  if (extras == primitive.end() || !extras->is_object()) return {};
  const auto name = extras->find("normals");
  if (name == extras->end() || !name->is_string()) return {};
  return normal_style_named(name->get<std::string>()).value_or(NormalStyle::absent);
}

/// Returns whether a file without levels may have the primitive.
bool is_plain(const gltf::Json& primitive) {
  if (gltf::find_extension(primitive, gltf::draco_extension, "a primitive") == nullptr ||
      gltf::find_extension(primitive, gltf::detail_extension, "a primitive") != nullptr)
    return false;
  const gltf::Json* attributes = gltf::find_member(primitive, "attributes", "a primitive");
  if (attributes == nullptr || !attributes->is_object()) return false;
  return attributes->size() == attributes->count("POSITION") + attributes->count("TEXCOORD_0") +
                                   attributes->count("COLOR_0") + attributes->count("NORMAL");
}

}  // namespace

double grid_rms(const Mesh& mesh, int position_bits) {
  const Box box = bounding_box(mesh.positions);
  const GridMoves move(tight_box(box), position_bits);
  double sum = 0;
  double doubled_area = 0;
  for (uint32_t f = 0; f < mesh.topology.face_count(); ++f) {
    const auto corner = [&](uint32_t i) { return to_double(mesh.positions[mesh.topology.origin[3 * f + i]]); };
    const Vec3d a = corner(0), b = corner(1), c = corner(2);
    const Vec3d normal = cross(b - a, c - a);
    const double size = length(normal);
    if (!(size > 0)) continue;
    const double x = dot(move(a), normal) / size, y = dot(move(b), normal) / size, z = dot(move(c), normal) / size;
    sum += size * (x * x + y * y + z * z + x * y + y * z + z * x) / 6;  // mean square of a linear function
    doubled_area += size;
  }
  return doubled_area > 0 ? std::sqrt(sum / doubled_area) / box.diagonal() : 0;
}

PlainDraco write_plain_draco(const Mesh& mesh, double rms, const PlainOptions& options) {
  int bits = fewest_position_bits;
  while (bits < most_position_bits && grid_rms(mesh, bits) > rms) {
    if (options.poll) options.poll();
    ++bits;
  }
  return write_plain_grid(mesh, bits, options);
}

PlainDraco write_plain_grid(const Mesh& mesh, int position_bits, const PlainOptions& options) {
  PlainDraco plain{.position_bits = position_bits, .rms = grid_rms(mesh, position_bits)};
  const PartStreams coded = write_parts(mesh, tight_box(bounding_box(mesh.positions)),
                                        {.position_bits = plain.position_bits, .speed = 0}, options.poll);
  plain.glb = write_plain(coded.decoded, coded.streams, options.normals,
                          options.materials == nullptr ? gltf::Materials() : *options.materials);
  return plain;
}

std::optional<PlainModel> read_plain_draco(std::string_view glb, const Limits& limits) {
  if (!gltf::is_glb(glb)) return std::nullopt;
  const gltf::Json json = gltf::read_document(glb).json;
  const gltf::Json& meshes = gltf::array_of(json, "meshes");
  if (meshes.size() != 1) return std::nullopt;
  const gltf::Json* primitives = gltf::find_member(meshes[0], "primitives", "meshes[0]");
  if (primitives == nullptr || !primitives->is_array() || primitives->empty()) return std::nullopt;
  if (!std::ranges::all_of(*primitives, is_plain)) return std::nullopt;
  std::optional<FormattedMesh> mesh = gltf::find_only_mesh(glb, limits);
  if (!mesh) return std::nullopt;
  return PlainModel{.mesh = std::move(*mesh), .normals = style_of((*primitives)[0])};
}

namespace {

void take_normals(FormattedMesh& mesh) {
  for (size_t a = mesh.attributes.size(); a-- > 0;) {
    if (mesh.format.attributes[a].kind != AttributeKind::normal) continue;
    mesh.attributes.erase(mesh.attributes.begin() + static_cast<ptrdiff_t>(a));
    mesh.format.attributes.erase(mesh.format.attributes.begin() + static_cast<ptrdiff_t>(a));
  }
}

/// Returns a mesh with normals in a style, split at the creases of `built`, which was built from it.
FormattedMesh add_normals(FormattedMesh mesh, Mesh built, NormalStyle style) {
  add_detail_normals(built, style);
  append_normals(mesh.format);
  static_cast<TriangleMesh&>(mesh) = std::move(built).triangles();
  return mesh;
}

}  // namespace

FormattedMesh with_normals(FormattedMesh mesh, NormalStyle style) {
  take_normals(mesh);
  if (!has_detail_normals(style)) return mesh;
  Mesh built = build_mesh(mesh);
  (void)mark_detail_curves(built);
  return add_normals(std::move(mesh), std::move(built), style);
}

FormattedMesh with_normals_of_shape(FormattedMesh mesh) {
  take_normals(mesh);
  Mesh built = refine(build_mesh(mesh), {.levels = 0}).mesh;  // marks the creases of the shape
  (void)mark_detail_curves(built);
  return add_normals(std::move(mesh), std::move(built), NormalStyle::creased);
}

}  // namespace papilio::proto::detail
