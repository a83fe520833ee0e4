#pragma once

#include "client/cli/commands.h"
#include "proto/refinement.h"

namespace papilio::client {

/// Refined mesh as a Draco stream, or refined scene as a .glb file.
struct RefinedFile {
  std::string bytes;
  bool is_scene = false;
  proto::Statistics statistics;
  proto::gltf::Materials materials{};  ///< materials of the mesh's faces (material_attribute.h)
};

/// Refines one mesh or scene locally, with `threads` threads, or at the server, with byte-identical results. A scene
/// stays a scene if `output` is a scene, or standard output without a format. Otherwise it is refined as a single mesh,
/// which keeps the materials of a scene or an OBJ file if `output` can store them; missing ones are reported on
/// standard error. Throws errors of the work, and `FileError` for a defective mesh.
[[nodiscard]] RefinedFile refine_mesh(const MeshPlace& input, const MeshPlace& output, const RefineFlags& flags,
                                      unsigned threads);
/// Writes a refined file. Throws `FileError`.
void save_refined(const MeshPlace& output, const RefinedFile& made);

/// Refines every mesh in the folder `flags.input` into the folder `flags.output`, and reports failed and skipped files.
void refine_folder(const RefineFlags& flags);

}  // namespace papilio::client
