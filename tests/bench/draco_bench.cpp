#include <cmath>
#include <memory>

#include "core/mesh/normals.h"
#include "papilio/refine.h"
#include "proto/output_attribute.h"
#include "proto/refinement.h"
#include "tests/bench/draco_peer.h"
#include "tests/bench/pairs.h"
#include "tests/support/libdraco_writer.h"
#include "tests/support/real_mesh.h"

// Draco streams written from half-edges compared with libdraco at equal settings; both write equal bytes. And a
// complete request, from a stream of 10,000 faces to one of 160,000, compared with libdraco, OpenMesh's
// ModifiedButterflyT and libdraco.

namespace papilio::bench {
namespace {

void add_row(const std::string& name, const Mesh& made, int speed, const proto::MeshFormat& format = {}) {
  const auto mesh = std::make_shared<Mesh>(made);
  const proto::QuantizationBox box = proto::quantization_box(mesh->positions);
  const proto::OutputOptions options{.position_bits = 11, .speed = speed};
  const proto::AttributeEncoding encoding = proto::attribute_encoding(*mesh, format);
  const auto by_libdraco = [=] {
    return test::write_with_libdraco(*mesh, box, options, 0, proto::output_attributes(*mesh, encoding));
  };
  if (proto::write_draco(*mesh, box, options, encoding) != by_libdraco())
    throw std::runtime_error("the two writers differ");
  add({.name = "draco/speed " + std::to_string(speed) + "/" + name,
       .divisor = static_cast<double>(mesh->topology.face_count()),
       .unit = "ns/triangle",
       .ours = [=] { return seconds([&] { (void)proto::write_draco(*mesh, box, options, encoding); }); },
       .peer = [=] { return seconds([&] { (void)by_libdraco(); }); }});
}

/// Returns the mesh with normals and texture coordinates of six charts, one per side.
TriangleMesh with_attributes(const TriangleMesh& triangles) {
  const Mesh mesh = build_mesh(triangles);
  const Buffer<Vec3f> normals = vertex_normals(mesh);
  const Buffer<Vec3f> sides = face_normals(mesh);
  const Box box = bounding_box(mesh.positions);
  const double size = box.diagonal();
  TriangleMesh out;
  out.attributes = {{.components = 3, .unit_length = true, .values = {}}, {.components = 2, .values = {}}};
  for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h) {
    const Vec3f p = mesh.positions[mesh.topology.origin[h]];
    const Vec3f n = normals[mesh.topology.origin[h]];
    const Vec3f side = sides[h / 3];
    const double x = std::abs(side.x);
    const double y = std::abs(side.y);
    const double z = std::abs(side.z);
    const bool is_x = x > y && x > z;
    const bool is_y = !is_x && y > z;
    const double across = is_x ? p.y - box.min.y : p.x - box.min.x;
    const double up = is_x || is_y ? p.z - box.min.z : p.y - box.min.y;
    const double chart = (is_x ? side.x : is_y ? side.y : side.z) > 0 ? 0 : 1;
    out.positions.push_back(p);
    out.attributes[0].values.insert(out.attributes[0].values.end(), {n.x, n.y, n.z});
    out.attributes[1].values.insert(out.attributes[1].values.end(), {across / size + chart, up / size + (is_x   ? 0
                                                                                                         : is_y ? 1
                                                                                                                : 2)});
    if (h % 3 == 2) out.triangles.push_back({h - 2, h - 1, h});
  }
  return out;
}

void add_pipeline(int speed) {
  const Mesh coarse = build_mesh(test::real_mesh("elephant10k.drc"));
  const proto::QuantizationBox box = proto::quantization_box(coarse.positions);
  const proto::OutputOptions output{.position_bits = 11, .speed = speed};
  const std::string draco = proto::write_draco(coarse, box, {.position_bits = 14});
  const proto::Parameters parameters = proto::parse_query(
      {{"levels", "2"}, {"tension", "off"}, {"output.position_bits", "11"}, {"output.speed", std::to_string(speed)}});
  const double faces = 16.0 * coarse.topology.face_count();
  add({.name = "draco/decode, refine, encode/speed " + std::to_string(speed),
       .divisor = faces,
       .unit = "ns/triangle out",
       .ours = [=] { return seconds([&] { (void)proto::Refinement(draco, parameters, {}).run(); }); },
       .peer =
           [=] {
             return seconds([&] {
               PeerMesh mesh = decode_for_peer(draco);
               subdivide(mesh, 2);
               (void)encode_for_peer(mesh, box, output);
             });
           }});
}

}  // namespace

void add_draco() {
  for (const int speed : {7, 3}) add_pipeline(speed);
  const TriangleMesh coarse = test::real_mesh("elephant20k.drc");
  const proto::MeshFormat format{.attributes = {{.kind = proto::AttributeKind::normal, .id = 1},
                                                {.kind = proto::AttributeKind::tex_coord, .id = 2}}};
  const Mesh textured = build_mesh(with_attributes(coarse));
  for (const int speed : {7, 3}) {
    for (const int levels : {1, 3}) {
      const Mesh mesh = refine(build_mesh(coarse), {.levels = levels}).mesh;
      add_row(std::to_string(mesh.topology.face_count()) + " faces", mesh, speed);
    }
    add_row("80000 faces, normals, texture coordinates", refine(textured, {.levels = 1}).mesh, speed, format);
  }
}

}  // namespace papilio::bench
