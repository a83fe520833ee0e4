#include <algorithm>
#include <cmath>

#include "papilio/refine.h"
#include "proto/draco_reader.h"
#include "proto/draco_writer.h"
#include "proto/edgebreaker/writer.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/soup.h"
#include "tests/support/draco_faces.h"
#include "tests/support/libdraco_writer.h"

// Written streams can be read: faces are equal, and positions within half a cell of the grid, or bit-identical if sent
// exactly. The stream of libdraco has equal faces and attribute values.

using namespace papilio;

namespace {

double largest_difference(Vec3f a, Vec3f b) {
  return std::max({std::abs(double{a.x} - b.x), std::abs(double{a.y} - b.y), std::abs(double{a.z} - b.z)});
}

void require_near(const Buffer<Vec3f>& some, const Buffer<Vec3f>& others, double distance) {
  for (const Vec3f& p : some)
    fuzz::require(std::ranges::any_of(others, [&](Vec3f q) { return largest_difference(p, q) <= distance; }),
                  "every position is where one was");
}

void require_libdracos_faces(const Mesh& mesh, const proto::QuantizationBox& box, const proto::OutputOptions& output,
                             const proto::AttributeEncoding& encoding) {
  const auto attributes = proto::output_attributes(mesh, encoding);
  const uint32_t id = encoding.format.position_id;
  fuzz::require(test::faces_of(proto::edgebreaker::write(mesh, box, output, id, attributes)) ==
                    test::faces_of(test::write_with_libdraco(mesh, box, output, id, attributes)),
                "our faces are libdraco's");
}

/// Small meshes are written by another method than large ones.
void write_refined(const proto::FormattedMesh& soup, const proto::OutputOptions& output) {
  Mesh mesh = build_mesh(soup);
  const proto::QuantizationBox box = proto::quantization_box(mesh.positions);
  const proto::AttributeEncoding encoding = proto::attribute_encoding(mesh, soup.format);
  while (mesh.topology.face_count() < 1000) mesh = refine(std::move(mesh), {.levels = 1}).mesh;
  require_libdracos_faces(mesh, box, output, encoding);
}

void write_and_read(const proto::FormattedMesh& soup, const proto::OutputOptions& output) {
  const Mesh mesh = build_mesh(soup);
  const proto::QuantizationBox box = proto::quantization_box(mesh.positions);
  const proto::AttributeEncoding encoding = proto::attribute_encoding(mesh, soup.format);
  require_libdracos_faces(mesh, box, output, encoding);
  const proto::FormattedMesh read = proto::read_draco(proto::write_draco(mesh, box, output, encoding), {});
  fuzz::require(read.triangles.size() == mesh.topology.face_count(), "faces are kept");
  const double cell = double{box.range} / ((1 << output.position_bits) - 1);
  const double rounding = 1e-6 * (largest_difference(box.origin, {}) + box.range);
  require_near(read.positions, mesh.positions, cell / 2 + rounding);
  require_near(mesh.positions, read.positions, cell / 2 + rounding);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  fuzz::ByteSource bytes(data, size);
  fuzz::unless_refused([&] {
    const proto::OutputOptions output{8 + static_cast<int>(bytes.up_to(8)), static_cast<int>(bytes.up_to(10))};
    const proto::FormattedMesh soup = fuzz::take_soup(bytes);
    const Mesh exact = build_mesh(proto::read_draco(proto::write_draco_exact(soup, soup.format), {}));
    fuzz::require(exact.topology.face_count() == build_mesh(soup).topology.face_count(), "faces are kept exactly");
    require_near(exact.positions, soup.positions, 0);
    write_and_read(soup, output);
    if (bytes.flag()) write_refined(soup, output);
  });
  return 0;
}
