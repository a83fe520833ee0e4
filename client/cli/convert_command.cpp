#include "client/cli/commands.h"
#include "client/lib/file_words.h"
#include "client/lib/read_materials.h"
#include "proto/draco_writer.h"

namespace papilio::client {

void convert_command(const ConvertFlags& flags) {
  check_output(flags.output);
  const Format format = output_format(flags.output);
  const MeshBytes file = read_mesh(flags.input);
  if (is_scene(format) && is_scene(file.format)) {
    print_warnings(file.warnings);
    return save_scene(flags.output, file.bytes);
  }
  warn_of_detail(file);
  if (holds_materials(flags.output)) {
    const MaterialRead read = read_with_materials(flags.input, file);
    print_warnings(read.warnings);
    return save_mesh(flags.output, read.model);
  }
  const proto::FormattedMesh triangles = triangles_of(file);
  if (format != Format::drc) return save_mesh(flags.output, {.mesh = triangles});
  save_bytes(flags.output, in_words_of_the_file(file.name, [&] {
               if (flags.exact) return proto::write_draco_exact(triangles, triangles.format);
               const Mesh mesh = build_mesh(triangles, nullptr, rounding_gap);
               return proto::write_draco(mesh, proto::quantization_box(mesh.positions), flags.options,
                                         proto::attribute_encoding(mesh, triangles.format));
             }));
}

}  // namespace papilio::client
