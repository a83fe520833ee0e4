// Geomview's Object File Format, as text: `OFF`, the counts of vertices, faces and edges, then one line for each vertex
// and each face. The keyword may be absent, or declare attributes after each position. These are skipped, as are
// colours at the end of a face's line. http://www.geomview.org/docs/html/OFF.html

#include <algorithm>
#include <limits>

#include "client/mesh_file/byte_order_mark.h"
#include "client/mesh_file/formats.h"
#include "client/mesh_file/polygon.h"
#include "client/mesh_file/text_scanner.h"
#include "client/mesh_file/text_writer.h"

namespace papilio::client {
namespace {

/// Parses a count of lines, each of at least `least` bytes, so that memory is bounded by the file's size.
size_t parse_count(TextScanner& scanner, const std::string& what, size_t least) {
  const int64_t count = scanner.integer();
  if (count < 0 || count > std::numeric_limits<int32_t>::max() ||
      static_cast<size_t>(count) > scanner.remaining() / least + 1)
    scanner.fail(std::to_string(count) + " " + what + " are declared, more than the file can hold");
  return static_cast<size_t>(count);
}

/// Parses the keyword, if any.
void parse_keyword(TextScanner& scanner) {
  TextScanner ahead = scanner;
  std::string_view keyword = ahead.word_anywhere();
  int64_t count = 0;
  if (parse_number(keyword, count)) return;
  if (!keyword.ends_with("OFF")) scanner.fail("expected the keyword OFF, found " + quoted(keyword));
  keyword.remove_suffix(3);
  for (const std::string_view attribute : {"ST", "C", "N"})
    if (keyword.starts_with(attribute)) keyword.remove_prefix(attribute.size());
  if (!keyword.empty()) scanner.fail("only OFF files of three dimensions are read");
  scanner = ahead;
  if (ahead.word() == "BINARY") scanner.fail("binary OFF files are not read, only those in text");
}

}  // namespace

TriangleMesh parse_off(std::string_view bytes) {
  bytes = skip_byte_order_mark(bytes);
  TextScanner scanner(bytes, {.hash_comments = true});
  parse_keyword(scanner);
  scanner.to_word();
  const size_t vertices = parse_count(scanner, "vertices", sizeof "0 0 0");
  const size_t faces = parse_count(scanner, "faces", sizeof "0");

  TriangleMesh mesh;
  mesh.positions.reserve(vertices);
  mesh.triangles.reserve(faces);
  for (size_t i = 0; i < vertices; ++i) {
    if (!scanner.next_line()) scanner.fail("the file ends within its vertices");
    const float x = scanner.coordinate(), y = scanner.coordinate(), z = scanner.coordinate();
    mesh.positions.push_back({x, y, z});
  }
  const auto position = [&](uint32_t vertex) { return mesh.positions[vertex]; };
  std::vector<uint32_t> corners;
  for (size_t i = 0; i < faces; ++i) {
    if (!scanner.next_line()) scanner.fail("the file ends within its faces");
    corners.clear();
    for (int64_t left = scanner.integer(); left > 0; --left) {
      const int64_t vertex = scanner.integer();
      if (vertex < 0 || static_cast<size_t>(vertex) >= vertices)
        scanner.fail("there is no vertex " + std::to_string(vertex));
      corners.push_back(static_cast<uint32_t>(vertex));
    }
    append_polygon(corners, position, mesh.triangles);
  }
  if (scanner.next_line()) scanner.fail("the file goes on after the faces that it declares");
  return mesh;
}

std::string format_off(const TriangleMesh& mesh) {
  std::string text = "OFF\n";
  text += std::to_string(mesh.positions.size()) + " " + std::to_string(mesh.triangles.size()) + " 0\n";
  for (const Vec3f& p : mesh.positions) {
    append_line(text, "", {p.x, p.y, p.z});
  }
  for (const auto& [a, b, c] : mesh.triangles) append_line(text, "3", {a, b, c});
  return text;
}

}  // namespace papilio::client
