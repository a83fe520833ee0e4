#include "client/cli/commands.h"
#include "client/lib/mesh_stream.h"
#include "proto/draco_writer.h"

namespace papilio::client {

void convert_command(const ConvertFlags& flags) {
  const Format format = format_of(flags.output);
  const proto::FormattedMesh triangles = load_triangles(flags.input);
  if (format != Format::drc) {
    write_triangles(flags.output, format, triangles, triangles.format);
    return;
  }
  if (flags.exact) {
    write_atomically(flags.output, proto::write_draco_exact(triangles, triangles.format));
    return;
  }
  const Mesh mesh = build_mesh(triangles);
  write_atomically(flags.output, proto::write_draco(mesh, proto::quantization_box(mesh.positions), flags.options,
                                                    proto::attribute_encoding(mesh, triangles.format)));
}

}  // namespace papilio::client
