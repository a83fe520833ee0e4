#include <memory>

#include "core/refine.h"
#include "proto/edgebreaker/writer.h"
#include "proto/refinement.h"
#include "tests/bench/draco_peer.h"
#include "tests/bench/pairs.h"
#include "tests/support/real_mesh.h"

// Draco streams written from the half-edges, against libdraco at the same settings; both write the same bytes. And all
// that a request does, from a stream of 10,000 faces to one of 160,000, against libdraco, OpenMesh's ModifiedButterflyT
// and libdraco.

namespace papilio::bench {
namespace {

void add_row(const char* name, int levels, int speed) {
  const auto mesh = std::make_shared<Mesh>(refine(build_mesh(test::real_mesh(name)), {.levels = levels}).mesh);
  const proto::QuantizationBox box = proto::quantization_box(mesh->positions);
  const proto::OutputOptions options{.position_bits = 11, .speed = speed};
  if (proto::edgebreaker::write(*mesh, box, options, 0) != proto::write_with_libdraco(*mesh, box, options))
    throw std::runtime_error("the two writers differ");
  const double faces = mesh->topology.face_count();
  add({.name = "draco/speed " + std::to_string(speed) + "/" + std::to_string(mesh->topology.face_count()) + " faces",
       .divisor = faces,
       .unit = "ns/triangle",
       .ours = [=] { return seconds([&] { (void)proto::edgebreaker::write(*mesh, box, options, 0); }); },
       .peer = [=] { return seconds([&] { (void)proto::write_with_libdraco(*mesh, box, options); }); }});
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
  for (const int speed : {7, 3}) {
    add_row("elephant20k.drc", 1, speed);
    add_row("elephant20k.drc", 3, speed);
  }
}

}  // namespace papilio::bench
