#include <memory>

#include "core/refine.h"
#include "proto/edgebreaker/writer.h"
#include "tests/bench/pairs.h"
#include "tests/support/real_mesh.h"

// Draco streams written from the half-edges, against libdraco at the same settings; both write the same bytes.

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

}  // namespace

void add_draco() {
  for (const int speed : {7, 3}) {
    add_row("elephant20k.drc", 1, speed);
    add_row("elephant20k.drc", 3, speed);
  }
}

}  // namespace papilio::bench
