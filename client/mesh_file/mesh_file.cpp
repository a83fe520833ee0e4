#include "client/mesh_file/mesh_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "client/mesh_file/formats.h"
#include "client/mesh_file/sound_mesh.h"

namespace papilio::client {
namespace {

constexpr std::array<std::pair<std::string_view, Format>, 7> kExtensions{{
    {".drc", Format::drc},
    {".obj", Format::obj},
    {".ply", Format::ply},
    {".off", Format::off},
    {".stl", Format::stl},
    {".glb", Format::glb},
    {".gltf", Format::gltf},
}};

std::logic_error format_is_elsewhere() {
  return std::logic_error("drc, glb and gltf are read and written by papilio::proto");
}

ObjFile parse(Format format, std::string_view bytes) {
  switch (format) {
    case Format::obj:
      return parse_obj_file(bytes);
    case Format::ply:
      return {parse_ply(bytes)};
    case Format::off:
      return {{parse_off(bytes), {}}};
    case Format::stl:
      return {{parse_stl(bytes), {}}};
    case Format::drc:
    case Format::glb:
    case Format::gltf:
      break;
  }
  throw format_is_elsewhere();
}

std::string to_bytes(Format format, const TriangleMesh& mesh, const proto::MeshFormat& mesh_format,
                     const ObjMaterials& materials) {
  switch (format) {
    case Format::obj:
      return format_obj(mesh, mesh_format, materials);
    case Format::ply:
      return format_ply(mesh, mesh_format);
    case Format::off:
      return format_off(mesh);
    case Format::stl:
      return format_stl(mesh);
    case Format::drc:
    case Format::glb:
    case Format::gltf:
      break;
  }
  throw format_is_elsewhere();
}

/// Returns a file's mesh, and the materials of an OBJ file.
ObjFile parse_sound(const std::string& name, Format format, std::string_view bytes) {
  if (bytes.empty()) throw FileError(name, "is empty; export the mesh again");
  try {
    ObjFile file = parse(format, bytes);
    if (const std::optional<std::string> fault = find_fault(file.mesh)) throw ParseError(*fault);
    return file;
  } catch (const ParseError& error) {
    throw FileError(name, std::string(error.what()) + "; export the mesh again, or check that its format is " +
                              std::string(name_of(format)));
  }
}

std::string encode(const std::string& name, Format format, const TriangleMesh& mesh,
                   const proto::MeshFormat& mesh_format, const ObjMaterials& materials) {
  if (const std::optional<std::string> fault = find_broken(mesh)) throw std::invalid_argument(*fault);
  // PLY's indices are signed in most readers, STL's count has 32 bits.
  constexpr size_t kMost = std::numeric_limits<int32_t>::max();
  if (mesh.positions.size() > kMost || mesh.triangles.size() > kMost)
    throw FileError(name, "cannot hold more than 2147483647 vertices or faces; simplify the mesh");
  return to_bytes(format, mesh, mesh_format, materials);
}

}  // namespace

bool is_scene(Format format) { return format == Format::glb || format == Format::gltf; }

std::string_view name_of(Format format) {
  return std::ranges::find(kExtensions, format, &std::pair<std::string_view, Format>::second)->first.substr(1);
}

std::optional<Format> format_named(std::string_view name) {
  for (const auto& [extension, format] : kExtensions)
    if (extension.substr(1) == name) return format;
  return std::nullopt;
}

std::optional<Format> known_format_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension.empty() ? std::nullopt : format_named(std::string_view(extension).substr(1));
}

Format format_of(const std::filesystem::path& path) {
  if (const std::optional<Format> format = known_format_of(path)) return *format;
  const std::string extension = path.extension().string();
  const std::string found = extension.empty() ? "has no extension" : "'" + extension + "' is not a known extension";
  throw FileError(path, found + "; use one of .drc, .obj, .ply, .off, .stl, .glb, .gltf");
}

proto::FormattedMesh parse_triangles(const std::string& name, Format format, std::string_view bytes) {
  return parse_sound(name, format, bytes).mesh;
}

ObjFile parse_obj_file(const std::string& name, std::string_view bytes) {
  return parse_sound(name, Format::obj, bytes);
}

proto::FormattedMesh read_triangles(const std::filesystem::path& path, Format format) {
  if (format == Format::drc || is_scene(format)) throw format_is_elsewhere();
  return parse_triangles(path.string(), format, read_bytes(path, kMaxFileBytes));
}

std::string encode_triangles(const std::string& name, Format format, const TriangleMesh& mesh,
                             const proto::MeshFormat& mesh_format) {
  return encode(name, format, mesh, mesh_format, {});
}

std::string encode_obj(const std::string& name, const TriangleMesh& mesh, const proto::MeshFormat& mesh_format,
                       const ObjMaterials& materials) {
  return encode(name, Format::obj, mesh, mesh_format, materials);
}

void write_triangles(const std::filesystem::path& path, Format format, const TriangleMesh& mesh,
                     const proto::MeshFormat& mesh_format) {
  write_atomically(path, encode_triangles(path.string(), format, mesh, mesh_format));
}

}  // namespace papilio::client
