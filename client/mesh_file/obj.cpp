// Wavefront OBJ: `v x y z` and `f 1 2 3`, indices from 1 or, negative, back from the latest vertex. A face
// may come before its vertices. All other keywords are passed over.

#include <algorithm>
#include <limits>

#include "client/mesh_file/formats.h"
#include "client/mesh_file/polygon.h"
#include "client/mesh_file/text_scanner.h"
#include "client/mesh_file/text_writer.h"

namespace papilio::client {
namespace {

/// The vertex of a face's corner: `7`, `7/1`, `7//3` or `7/1/3`.
uint32_t parse_corner(const TextScanner& scanner, std::string_view word, size_t vertices_so_far) {
  const std::string_view number = word.substr(0, word.find('/'));
  const std::string_view attributes = word.substr(number.size());
  int64_t index = 0;
  if (!parse_number(number, index) || attributes.find_first_not_of("/-0123456789") != std::string_view::npos)
    scanner.fail("expected the number of a vertex, found " + quoted(word));
  const int64_t from_zero = index < 0 ? static_cast<int64_t>(vertices_so_far) + index : index - 1;
  if (from_zero < 0 || from_zero >= std::numeric_limits<uint32_t>::max())
    scanner.fail("there is no vertex " + std::to_string(index));
  return static_cast<uint32_t>(from_zero);
}

}  // namespace

TriangleMesh parse_obj(std::string_view bytes) {
  if (bytes.find('\0') != std::string_view::npos) throw ParseError("is not a text, as OBJ files are");
  TextScanner scanner(bytes, {.hash_comments = true, .backslash_continues = true});
  TriangleMesh mesh;
  std::vector<uint32_t> corners;
  for (bool more = scanner.to_word(); more; more = scanner.next_line()) {
    const std::string_view keyword = scanner.word();
    if (keyword == "v") {
      const float x = scanner.coordinate(), y = scanner.coordinate(), z = scanner.coordinate();
      mesh.positions.push_back({x, y, z});
    } else if (keyword == "f") {
      corners.clear();
      for (std::string_view word = scanner.word(); !word.empty(); word = scanner.word())
        corners.push_back(parse_corner(scanner, word, mesh.positions.size()));
      if (corners.size() < 3) scanner.fail("a face has fewer than three corners");
      append_fan(corners, mesh.triangles);
    }
  }
  return mesh;
}

std::string format_obj(const TriangleMesh& mesh) {
  std::string text = "# " + std::to_string(mesh.positions.size()) + " vertices, " +
                     std::to_string(mesh.triangles.size()) + " triangles\n";
  for (const Vec3f& p : mesh.positions) append_line(text, "v", {p.x, p.y, p.z});
  for (const auto& [a, b, c] : mesh.triangles)
    append_line(text, "f", {uint64_t{a} + 1, uint64_t{b} + 1, uint64_t{c} + 1});
  return text;
}

}  // namespace papilio::client
