#include <algorithm>
#include <bit>

#include "client/mesh_file/formats.h"
#include "client/mesh_file/mtl.h"
#include "tests/fuzz/fuzz.h"

// The first byte as the format, the rest as a file: what can be read can be written, and is equal when read again. The
// fifth format is material libraries.

using namespace papilio;

namespace {

/// Returns the bits of the positions of all corners.
std::vector<std::array<uint32_t, 3>> corners(const TriangleMesh& mesh) {
  std::vector<std::array<uint32_t, 3>> all;
  for (const Triangle& triangle : mesh.triangles)
    for (const uint32_t v : triangle) {
      const Vec3f p = mesh.positions[v];
      all.push_back({std::bit_cast<uint32_t>(p.x), std::bit_cast<uint32_t>(p.y), std::bit_cast<uint32_t>(p.z)});
    }
  return all;
}

bool has_sound_indices(const TriangleMesh& mesh) {
  return std::ranges::all_of(mesh.triangles,
                             [&](const Triangle& t) { return std::ranges::max(t) < mesh.positions.size(); });
}

proto::FormattedMesh parse(int format, std::string_view bytes) {
  if (format == 0) return client::parse_obj(bytes);
  if (format == 1) return client::parse_ply(bytes);
  return {format == 2 ? client::parse_off(bytes) : client::parse_stl(bytes), {}};
}

std::string write(int format, const proto::FormattedMesh& mesh) {
  if (format == 0) return client::format_obj(mesh, mesh.format);
  if (format == 1) return client::format_ply(mesh, mesh.format);
  return format == 2 ? client::format_off(mesh) : client::format_stl(mesh);
}

bool is_finite(const TriangleMesh& mesh) {
  return std::ranges::all_of(mesh.positions,
                             [](Vec3f p) { return p.x - p.x == 0 && p.y - p.y == 0 && p.z - p.z == 0; });
}

/// Reads a library and, if names fit on a line, writes it and reads it again.
void check_library(std::string_view bytes) {
  const std::vector<client::MtlMaterial> materials = client::parse_mtl(bytes);
  std::vector<client::MtlMaterial> plain = materials;
  for (client::MtlMaterial& material : plain)
    for (std::string& map : material.maps)
      if (map.starts_with('-') || map.starts_with('"')) map = "map";
  fuzz::require(client::parse_mtl(client::format_mtl(plain)) == plain, "libraries survive");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size == 0) return 0;
  const int format = data[0] % 5;
  proto::FormattedMesh mesh;
  try {
    if (format == 4) {
      check_library(fuzz::text_of(data + 1, size - 1));
      return 0;
    }
    mesh = parse(format, fuzz::text_of(data + 1, size - 1));
  } catch (const client::ParseError&) {
    return 0;
  }
  if (mesh.triangles.empty() || !has_sound_indices(mesh)) return 0;
  for (int written = 0; written < 4; ++written) {
    const std::string bytes = write(written, mesh);
    if (is_finite(mesh)) fuzz::require(corners(parse(written, bytes)) == corners(mesh), "positions survive to the bit");
  }
  return 0;
}
