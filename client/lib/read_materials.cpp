#include "client/lib/read_materials.h"

#include <algorithm>

#include "client/lib/file_words.h"
#include "client/lib/material_library.h"
#include "client/lib/read_beside.h"
#include "client/mesh_file/obj_file.h"
#include "proto/detail/find_packed.h"
#include "proto/gltf/flattening.h"
#include "proto/text.h"

namespace papilio::client {
namespace {

bool has_texture_coordinates(const proto::FormattedMesh& mesh) {
  return std::ranges::any_of(mesh.format.attributes, [](const proto::AttributeFormat& format) {
    return format.kind == proto::AttributeKind::tex_coord;
  });
}

MaterialRead read_obj(const MeshPlace& place, const MeshBytes& file) {
  ObjFile obj = parse_obj_file(file.name, file.bytes);
  MaterialRead read{.model = {.mesh = std::move(obj.mesh)}};
  if (obj.materials.libraries.empty() || obj.materials.names.empty()) return read;
  if (place.is_standard()) {
    read.warnings.push_back(file.name + ": names the material library " + proto::quote(obj.materials.libraries[0]) +
                            "; name the .obj file instead of - to have its materials");
    return read;
  }
  LibraryReader reader(place.path, has_texture_coordinates(read.model.mesh));
  read.model.materials = reader.read(obj.materials);
  read.warnings = std::move(reader).warnings();
  return read;
}

/// Reads a packed model with all its levels, and its material.
MaterialRead read_packed_scene(const MeshBytes& file) {
  MaterialRead read{.model = {.mesh = triangles_of(file)}};
  read.model.materials =
      in_words_of_the_file(file.name, [&] { return material_of_packed(file.bytes, read.model.mesh.triangles.size()); });
  return read;
}

MaterialRead read_scene(const MeshPlace& place, const MeshBytes& file) {
  if (proto::detail::find_packed(file.bytes, own_limits)) return read_packed_scene(file);
  MaterialRead read{.model = in_words_of_the_file(
                        file.name, [&] { return proto::gltf::flatten_with_materials(file.bytes, own_limits); })};
  for (proto::gltf::Image& image : read.model.materials.images) {
    if (image.uri.empty()) continue;
    if (place.is_standard()) {
      read.warnings.push_back(file.name + ": names the image " + proto::quote(image.uri) +
                              "; name the file instead of - to have it");
      continue;
    }
    try {
      image.bytes = read_beside(place.path, image.uri);
      if (image.name.empty()) image.name = std::filesystem::path(image.uri).stem().string();
    } catch (const FileError& error) {
      read.warnings.push_back(std::string(error.what()) + ". The image is left out");
    }
  }
  return read;
}

}  // namespace

proto::gltf::Materials material_of_packed(std::string_view glb, size_t triangles) {
  proto::gltf::Materials materials = proto::gltf::flatten_with_materials(glb, own_limits).materials;
  if (materials.empty()) return materials;
  const std::vector<uint32_t> of_base = std::move(materials.of_triangle);
  const size_t below = std::max<size_t>(1, triangles / of_base.size());
  materials.of_triangle.clear();
  for (size_t t = 0; t < triangles; ++t) materials.of_triangle.push_back(of_base.at(t / below));
  return materials;
}

MaterialRead read_with_materials(const MeshPlace& place, const MeshBytes& file) {
  if (file.format == Format::obj) return read_obj(place, file);
  if (is_scene(file.format)) return read_scene(place, file);
  return {.model = {.mesh = triangles_of(file)}};
}

}  // namespace papilio::client
