#include <filesystem>
#include <iostream>
#include <system_error>
#include <thread>

#include "client/cli/refine_mesh.h"
#include "client/lib/file_words.h"
#include "client/lib/local_limits.h"
#include "client/lib/read_materials.h"
#include "proto/detail/find_packed.h"
#include "proto/findings.h"
#include "proto/gltf/scene_refinement.h"
#include "proto/text.h"

namespace papilio::client {
namespace {

namespace fs = std::filesystem;

std::string shown(const MeshPlace& place) { return proto::escape_controls(place.path.string()); }

void report(std::ostream& out, const RefineFlags& flags, const MeshPlace& output, const RefinedFile& made) {
  const proto::Statistics& statistics = made.statistics;
  if (flags.json) {
    out << proto::statistics_json(statistics);
    return;
  }
  std::cerr << shown(output) << ": " << statistics.vertices << " vertices, " << statistics.faces << " faces, ";
  if (made.is_scene || output_format(output) == Format::drc)  // files of other formats have another size
    std::cerr << made.bytes.size() << (made.is_scene ? " bytes of glTF, " : " bytes of Draco, ");
  std::cerr << statistics.level << (statistics.level == 1 ? " level" : " levels") << "; decode "
            << statistics.times.decode << " ms, refine " << statistics.times.refine << " ms, encode "
            << statistics.times.encode << " ms\n";
  if (const std::string found = proto::defects_text(statistics.found); !found.empty())
    std::cerr << proto::escape_controls(flags.input.name()) << ": mended or worked round " << found << '\n';
  if (!statistics.unreached.empty()) std::cerr << "warning: " << statistics.unreached << '\n';
}

/// Returns the output beside the input: bunny.refined.obj for bunny.obj. Throws if the file exists.
fs::path path_beside(const MeshPlace& input, std::optional<Format> to) {
  if (!to) to = input.format;
  if (!to) (void)format_of(input.path);  // refuses an unknown extension
  const std::string extension = to ? "." + std::string(name_of(*to)) : input.path.extension().string();
  fs::path path = input.path.parent_path() / (input.path.stem().string() + ".refined" + extension);
  std::error_code ignored;
  if (fs::exists(path, ignored))
    throw UsageError(path.string() + " exists already. To replace it, name it: -o " + path.string() + ".");
  return path;
}

MeshPlace output_of(const RefineFlags& flags) {
  MeshPlace output = flags.output;
  if (output.path.empty()) output.path = flags.input.is_standard() ? "-" : path_beside(flags.input, output.format);
  return output;
}

/// Returns whether a scene stays a scene. On standard output it does, unless another format is given.
bool stays_scene(const MeshBytes& file, const MeshPlace& output) {
  return is_scene(file.format) && ((output.is_standard() && !output.format) || is_scene(output_format(output)));
}

/// Returns a mesh file as a Draco stream, and a packed model unchanged. Sets `materials` to the materials of its faces,
/// if the output can store any.
std::string mesh_to_refine(const MeshPlace& input, const MeshPlace& output, MeshBytes file,
                           proto::gltf::Materials& materials) {
  if (is_scene(file.format) && proto::detail::find_packed(file.bytes, own_limits)) {
    if (holds_materials(output))
      materials = in_words_of_the_file(file.name, [&] { return material_of_packed(file.bytes, 0); });
    return std::move(file.bytes);
  }
  const bool has_materials = file.format == Format::obj || is_scene(file.format);
  if (!has_materials || !holds_materials(output)) return draco_of(std::move(file));
  MaterialRead read = read_with_materials(input, file);
  print_warnings(read.warnings);
  materials.materials = read.model.materials.materials;
  materials.images = std::move(read.model.materials.images);
  return draco_of(file.name, std::move(read.model));
}

void refine_file(const RefineFlags& flags) {
  const MeshPlace output = output_of(flags);
  check_output(output);
  const RefinedFile made = refine_mesh(flags.input, output, flags, std::thread::hardware_concurrency());
  save_refined(output, made);
  report(output.is_standard() ? std::cerr : std::cout, flags, output, made);
}

}  // namespace

RefinedFile refine_mesh(const MeshPlace& input, const MeshPlace& output, const RefineFlags& flags, unsigned threads) {
  const proto::Limits limits = local_limits(is_folder(flags.input.path) ? flags.jobs : 1);
  MeshBytes file = read_mesh(input);
  warn_of_detail(file);
  const std::string name = file.name;
  const proto::RefinementHooks hooks{.on_level = {}, .cancelled = {}, .threads = static_cast<int>(threads)};
  if (stays_scene(file, output)) {
    print_warnings(file.warnings);
    return in_words_of_the_file(name, [&]() -> RefinedFile {
      auto made = flags.server.empty() ? proto::gltf::SceneRefinement(file.bytes, flags.parameters, limits).run(hooks)
                                       : Remote(flags.server, flags.remote).refine_scene(file.bytes, flags.parameters);
      return {std::move(made.bytes), true, std::move(made.statistics)};
    });
  }
  proto::gltf::Materials materials;
  const std::string bytes = mesh_to_refine(input, output, std::move(file), materials);
  return in_words_of_the_file(name, [&]() -> RefinedFile {
    auto made = flags.server.empty() ? proto::Refinement(bytes, flags.parameters, limits).run(hooks)
                                     : Remote(flags.server, flags.remote).refine(bytes, flags.parameters);
    return {std::move(made.bytes), false, std::move(made.statistics), std::move(materials)};
  });
}

void save_refined(const MeshPlace& output, const RefinedFile& made) {
  if (made.is_scene)
    save_scene(output, made.bytes);
  else
    save_draco(output, made.bytes, made.materials);
}

void refine_command(const RefineFlags& flags) {
  try {
    if (!flags.server.empty()) (void)Remote(flags.server);
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
  if (!flags.input.is_standard() && is_folder(flags.input.path))
    refine_folder(flags);
  else
    refine_file(flags);
}

}  // namespace papilio::client
