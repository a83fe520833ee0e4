#include "client/lib/mesh_stream.h"

#include <iostream>

#include "client/lib/file_words.h"
#include "proto/draco_reader.h"
#include "proto/draco_writer.h"

namespace papilio::client {

MeshBytes read_mesh(const MeshPlace& place) {
  MeshBytes file{.name = place.name()};
  if (!place.is_standard()) file.format = place.format ? *place.format : format_of(place.path);
  file.bytes = place.is_standard() ? read_standard_input(kMaxFileBytes) : read_bytes(place.path, kMaxFileBytes);
  if (file.bytes.empty()) throw FileError(file.name, "is empty; export the mesh again");
  if (place.is_standard()) file.format = place.format ? *place.format : format_of_content(file.name, file.bytes);
  return file;
}

proto::FormattedMesh triangles_of(const MeshBytes& file) {
  if (file.format != Format::drc) return parse_triangles(file.name, file.format, file.bytes);
  return in_words_of_the_file(file.name, [&] { return proto::read_draco(file.bytes, own_limits); });
}

std::string draco_of(MeshBytes file) {
  if (file.format == Format::drc) return std::move(file.bytes);
  const proto::FormattedMesh mesh = triangles_of(file);
  return in_words_of_the_file(file.name, [&] { return proto::write_draco_exact(mesh, mesh.format); });
}

Format output_format(const MeshPlace& place) {
  if (place.is_standard()) return place.format.value_or(Format::drc);
  const Format format = format_of(place.path);
  if (place.format && *place.format != format)
    throw FileError(place.path, "is not named as a file of format " + std::string(name_of(*place.format)) +
                                    "; leave --to away, or change the extension");
  return format;
}

void save_draco(const MeshPlace& place, std::string_view draco) {
  const Format format = output_format(place);
  if (format == Format::drc) return save_bytes(place, draco);
  const proto::FormattedMesh mesh = proto::read_draco(draco, own_limits);
  save_bytes(place, encode_triangles(place.path.string(), format, mesh, mesh.format));
}

void save_bytes(const MeshPlace& place, std::string_view bytes) {
  if (!place.is_standard()) return write_atomically(place.path, bytes);
  std::cout.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

}  // namespace papilio::client
