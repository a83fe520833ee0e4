// Stereolithography, binary and text. Binary: 80 arbitrary bytes, a count, and 50 bytes for each triangle. Text starts
// with `solid`, but so do the 80 bytes of many binary files: these are recognized by their size, which follows from the
// count. Some writers append bytes to a binary file. They are skipped, unless they could be whole triangles not
// counted.

#include <cctype>
#include <cmath>

#include "client/mesh_file/binary.h"
#include "client/mesh_file/byte_order_mark.h"
#include "client/mesh_file/formats.h"
#include "client/mesh_file/polygon.h"
#include "client/mesh_file/text_scanner.h"

namespace papilio::client {
namespace {

constexpr size_t kHeaderBytes = 84;
constexpr size_t kTriangleBytes = 50;
constexpr size_t kNormalBytes = 3 * sizeof(float);

bool equals_ignoring_case(std::string_view word, std::string_view lower) {
  return std::ranges::equal(word, lower, [](unsigned char a, unsigned char b) { return std::tolower(a) == b; });
}

/// Returns the declared number of triangles. The header must be complete.
size_t declared_triangles(std::string_view bytes) { return load<uint32_t>(bytes.substr(80), std::endian::little); }

size_t size_of_binary(size_t triangles) { return kHeaderBytes + kTriangleBytes * triangles; }

/// Returns whether the size exactly matches a binary file's count.
bool is_surely_binary(std::string_view bytes) {
  return bytes.size() >= kHeaderBytes && size_of_binary(declared_triangles(bytes)) == bytes.size();
}

bool is_text(std::string_view bytes) {
  return equals_ignoring_case(TextScanner(bytes, {}).word_anywhere(), "solid") &&
         bytes.find('\0') == std::string_view::npos;
}

/// Throws `ParseError` if triangles are missing, or not counted.
void check_size(std::string_view bytes) {
  const size_t declared = declared_triangles(bytes);
  const size_t needed = size_of_binary(declared);
  const std::string count = "declares " + std::to_string(declared) + " triangles, ";
  if (needed > bytes.size())
    throw ParseError(count + "which take " + std::to_string(needed) + " bytes, but has " +
                     std::to_string(bytes.size()) + ": it is cut short, or is no STL file");
  const size_t more = bytes.size() - needed;
  if (more > 0 && more % kTriangleBytes == 0)
    throw ParseError(count + "but its " + std::to_string(bytes.size()) + " bytes hold " +
                     std::to_string(declared + more / kTriangleBytes) + ": its count or its end is damaged");
}

/// Appends a position, and returns its index.
uint32_t append_corner(TriangleMesh& mesh, Vec3f position) {
  mesh.positions.push_back(position);
  return static_cast<uint32_t>(mesh.positions.size() - 1);
}

TriangleMesh parse_binary(std::string_view bytes) {
  if (bytes.size() < kHeaderBytes) throw ParseError("is no STL file: neither text nor long enough for a binary one");
  check_size(bytes);
  const size_t triangles = declared_triangles(bytes);
  TriangleMesh mesh;
  mesh.positions.reserve(3 * triangles);
  mesh.triangles.reserve(triangles);
  for (size_t i = 0; i < triangles; ++i) {
    const std::string_view corners = bytes.substr(kHeaderBytes + kTriangleBytes * i + kNormalBytes);
    const auto coordinate = [&](size_t k) {
      return load<float>(corners.substr(k * sizeof(float)), std::endian::little);
    };
    const auto corner = [&](size_t k) {
      return append_corner(mesh, {coordinate(3 * k), coordinate(3 * k + 1), coordinate(3 * k + 2)});
    };
    const uint32_t a = corner(0), b = corner(1), c = corner(2);
    mesh.triangles.push_back({a, b, c});
  }
  return mesh;
}

void expect(TextScanner& scanner, std::string_view lower) {
  const std::string_view word = scanner.word_anywhere();
  if (!equals_ignoring_case(word, lower)) scanner.fail("expected " + quoted(lower) + ", found " + quoted(word));
}

/// Parses the rest of a facet after `facet`, including `endfacet`. Skips the normal, which some writers set to NaN.
void parse_facet(TextScanner& scanner, TriangleMesh& mesh) {
  expect(scanner, "normal");
  for (int i = 0; i < 3; ++i) (void)scanner.word_anywhere();
  expect(scanner, "outer");
  expect(scanner, "loop");
  std::vector<uint32_t> corners;
  std::string_view word = scanner.word_anywhere();
  for (; equals_ignoring_case(word, "vertex"); word = scanner.word_anywhere()) {
    const float x = scanner.coordinate(), y = scanner.coordinate(), z = scanner.coordinate();
    corners.push_back(append_corner(mesh, {x, y, z}));
  }
  if (!equals_ignoring_case(word, "endloop")) scanner.fail("expected 'vertex' or 'endloop', found " + quoted(word));
  if (corners.size() < 3) scanner.fail("a facet has fewer than three corners");
  expect(scanner, "endfacet");
  append_polygon(
      corners, [&](uint32_t corner) { return mesh.positions[corner]; }, mesh.triangles);
}

/// Parses one or more solids: `solid NAME`, facets, `endsolid NAME`. The name may have several words.
TriangleMesh parse_text(std::string_view bytes) {
  TextScanner scanner(bytes, {});
  TriangleMesh mesh;
  for (bool more = scanner.to_word(); more; more = scanner.next_line()) {
    expect(scanner, "solid");
    scanner.next_line();
    std::string_view word = scanner.word_anywhere();
    for (; equals_ignoring_case(word, "facet"); word = scanner.word_anywhere()) parse_facet(scanner, mesh);
    if (word.empty()) scanner.fail("the file ends before 'endsolid': it is cut short");
    if (!equals_ignoring_case(word, "endsolid")) scanner.fail("expected 'facet' or 'endsolid', found " + quoted(word));
  }
  return mesh;
}

/// Returns the unit normal, or zero for a degenerate triangle.
Vec3f unit_normal(Vec3d a, Vec3d b, Vec3d c) {
  const Vec3d normal = cross(b - a, c - a);
  const double size = length(normal);
  return size > 0 && std::isfinite(size) ? to_float((1 / size) * normal) : Vec3f{};
}

}  // namespace

bool looks_like_stl(std::string_view bytes) { return is_surely_binary(bytes) || is_text(skip_byte_order_mark(bytes)); }

TriangleMesh parse_stl(std::string_view bytes) {
  if (is_surely_binary(bytes)) return parse_binary(bytes);
  const std::string_view text = skip_byte_order_mark(bytes);
  return is_text(text) ? parse_text(text) : parse_binary(bytes);
}

std::string format_stl(const TriangleMesh& mesh) {
  std::string bytes = "binary STL, written by papilio";
  bytes.reserve(kHeaderBytes + kTriangleBytes * mesh.triangles.size());
  bytes.resize(80, ' ');
  store(bytes, static_cast<uint32_t>(mesh.triangles.size()));
  for (const auto& [i, j, k] : mesh.triangles) {
    const Vec3f a = mesh.positions[i], b = mesh.positions[j], c = mesh.positions[k];
    store_vector(bytes, unit_normal(to_double(a), to_double(b), to_double(c)));
    for (const Vec3f& corner : {a, b, c}) store_vector(bytes, corner);
    store(bytes, uint16_t{0});
  }
  return bytes;
}

}  // namespace papilio::client
