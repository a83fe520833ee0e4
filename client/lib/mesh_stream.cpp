#include "client/lib/mesh_stream.h"

#include "core/mesh.h"
#include "proto/draco_reader.h"
#include "proto/draco_writer.h"

namespace papilio::client {
namespace {

/// A user's own files on a user's own machine: bounded by what the core can number.
constexpr proto::Limits own_limits{face_count_limit, face_count_limit, face_count_limit};

}  // namespace

proto::FormattedMesh load_triangles(const std::filesystem::path& path) {
  const Format format = format_of(path);
  if (format == Format::drc) return proto::read_draco(read_bytes(path, kMaxFileBytes), own_limits);
  return read_triangles(path, format);
}

std::string load_draco(const std::filesystem::path& path) {
  const Format format = format_of(path);
  if (format == Format::drc) return read_bytes(path, kMaxFileBytes);
  const proto::FormattedMesh mesh = read_triangles(path, format);
  return proto::write_draco_exact(mesh, mesh.format);
}

void save_draco(const std::filesystem::path& path, std::string_view draco) {
  const Format format = format_of(path);
  if (format == Format::drc) {
    write_atomically(path, draco);
    return;
  }
  const proto::FormattedMesh mesh = proto::read_draco(draco, own_limits);
  write_triangles(path, format, mesh, mesh.format);
}

}  // namespace papilio::client
