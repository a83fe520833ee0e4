#include "client/lib/mesh_stream.h"

#include <iostream>

#include "client/lib/file_words.h"
#include "client/lib/read_beside.h"
#include "client/lib/save_obj.h"
#include "proto/detail/decode_packed.h"
#include "proto/detail/find_packed.h"
#include "proto/draco_reader.h"
#include "proto/draco_writer.h"
#include "proto/gltf/flattening.h"
#include "proto/gltf/material_attribute.h"
#include "proto/gltf/packing.h"
#include "proto/text.h"

namespace papilio::client {
namespace {

/// Returns a .gltf file as a .glb file, and adds to its warnings.
std::string packed(const MeshPlace& place, MeshBytes& file) {
  const auto read = [&](const std::string& uri) {
    if (place.is_standard())
      throw FileError(file.name, "names the file " + proto::quote(uri) + "; name the .gltf file instead of -");
    return read_beside(place.path, uri);
  };
  const auto find_image = [&](const std::string& uri) -> std::optional<std::string> {
    try {
      return read(uri);
    } catch (const FileError& error) {
      file.warnings.push_back(std::string(error.what()) + ". The image keeps its URI");
      return std::nullopt;
    }
  };
  return in_words_of_the_file(file.name, [&] { return proto::gltf::pack_scene(file.bytes, read, find_image); });
}

/// Throws `FileError` if there is no such file, whatever the format of its name would be.
void require_file(const std::filesystem::path& path) {
  std::error_code ignored;  // other errors are those of reading
  if (std::filesystem::status(path, ignored).type() == std::filesystem::file_type::not_found)
    throw FileError(path, "does not exist; check the name");
}

}  // namespace

MeshBytes read_mesh(const MeshPlace& place) {
  MeshBytes file{.name = place.name()};
  if (!place.is_standard()) require_file(place.path);
  if (!place.is_standard()) file.format = place.format ? *place.format : format_of(place.path);
  file.bytes = place.is_standard() ? read_standard_input(kMaxFileBytes) : read_bytes(place.path, kMaxFileBytes);
  if (file.bytes.empty()) throw FileError(file.name, "is empty; export the mesh again");
  if (place.is_standard()) file.format = place.format ? *place.format : format_of_content(file.name, file.bytes);
  if (file.format == Format::gltf) file.bytes = packed(place, file);
  return file;
}

proto::FormattedMesh triangles_of(const MeshBytes& file) {
  if (is_scene(file.format)) {
    return in_words_of_the_file(file.name, [&] {
      const auto packed = proto::detail::find_packed(file.bytes, own_limits);
      return packed ? proto::detail::decode_packed(*packed, {.face_limit = own_limits.max_output_faces})
                    : proto::gltf::flatten_scene(file.bytes, own_limits);
    });
  }
  if (file.format != Format::drc) return parse_triangles(file.name, file.format, file.bytes);
  return in_words_of_the_file(file.name, [&] { return proto::read_draco(file.bytes, own_limits); });
}

std::string draco_of(MeshBytes file) {
  if (file.format == Format::drc) return std::move(file.bytes);
  const proto::FormattedMesh mesh = triangles_of(file);
  return in_words_of_the_file(file.name, [&] { return proto::write_draco_exact(mesh, mesh.format); });
}

std::string draco_of(const std::string& name, proto::gltf::MaterialMesh model) {
  if (!model.materials.empty()) proto::gltf::add_material_attribute(model);
  return in_words_of_the_file(name, [&] { return proto::write_draco_exact(model.mesh, model.mesh.format); });
}

Format output_format(const MeshPlace& place) {
  if (place.is_standard()) return place.format.value_or(Format::drc);
  const Format format = format_of(place.path);
  if (place.format && *place.format != format)
    throw FileError(place.path, "is not named as a file of format " + std::string(name_of(*place.format)) +
                                    "; leave --to away, or change the extension");
  return format;
}

bool holds_materials(const MeshPlace& place) {
  const Format format = output_format(place);
  return is_scene(format) || (format == Format::obj && !place.is_standard());
}

bool holds_normals(Format format) { return format != Format::off && format != Format::stl; }

void save_mesh(const MeshPlace& place, const proto::gltf::MaterialMesh& model) {
  const Format format = output_format(place);
  if (is_scene(format)) return save_scene(place, proto::gltf::scene_of_mesh(model.mesh, model.materials));
  if (format == Format::obj) return save_obj(place, model);
  save_bytes(place, encode_triangles(place.path.string(), format, model.mesh, model.mesh.format));
}

void save_draco(const MeshPlace& place, std::string_view draco, const proto::gltf::Materials& materials) {
  if (output_format(place) == Format::drc) return save_bytes(place, draco);
  proto::gltf::MaterialMesh model{.mesh = proto::read_draco(draco, own_limits), .materials = materials};
  if (!materials.empty() && proto::gltf::has_material_attribute(model.mesh))
    model.materials.of_triangle = proto::gltf::take_material_attribute(model.mesh, materials.materials.size());
  else if (!materials.empty())  // material of all faces of a packed model
    model.materials.of_triangle.assign(model.mesh.triangles.size(), 0);
  save_mesh(place, model);
}

void save_scene(const MeshPlace& place, const std::string& glb) {
  if (place.is_standard() || output_format(place) == Format::glb) return save_bytes(place, glb);
  const auto files = proto::gltf::unpack_scene(glb, place.path.stem().string() + ".bin");
  for (const auto& [name, bytes] : files.buffers) save_bytes({.path = place.path.parent_path() / name}, bytes);
  save_bytes(place, files.document);
}

void save_bytes(const MeshPlace& place, std::string_view bytes) {
  if (!place.is_standard()) return write_atomically(place.path, bytes);
  std::cout.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

}  // namespace papilio::client
