#include "tests/support/draco_faces.h"

#include <algorithm>
#include <array>
#include <bit>

#include "proto/draco_reader.h"

namespace papilio::test {

std::vector<std::vector<uint64_t>> faces_of(std::string_view draco) {
  const proto::FormattedMesh mesh =
      proto::read_draco(draco, {.max_input_faces = 100'000'000, .max_input_vertices = 100'000'000});
  const auto corner = [&](uint32_t point) {
    const Vec3f p = mesh.positions[point];
    std::vector<uint64_t> bits;
    for (const double c : {p.x, p.y, p.z}) bits.push_back(std::bit_cast<uint64_t>(c));
    for (const Attribute& attribute : mesh.attributes)
      for (size_t i = 0; i < attribute.components; ++i)
        bits.push_back(std::bit_cast<uint64_t>(attribute.values[size_t{point} * attribute.components + i]));
    return bits;
  };
  std::vector<std::vector<uint64_t>> faces;
  for (const Triangle& t : mesh.triangles) {
    std::array<std::vector<uint64_t>, 3> face{corner(t[0]), corner(t[1]), corner(t[2])};
    auto least = face;
    for (int turn = 0; turn < 2; ++turn) {
      std::rotate(face.begin(), face.begin() + 1, face.end());
      least = std::min(least, face);
    }
    std::vector<uint64_t>& all = faces.emplace_back();
    for (const std::vector<uint64_t>& values : least) all.insert(all.end(), values.begin(), values.end());
  }
  std::ranges::sort(faces);
  return faces;
}

}  // namespace papilio::test
