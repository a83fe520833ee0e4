#pragma once

#include "client/cli/commands.h"
#include "proto/refinement.h"

namespace papilio::client {

/// A refined mesh as a Draco stream, or a refined scene as a .glb file.
struct RefinedFile {
  std::string bytes;
  bool is_scene = false;
  proto::Statistics statistics;
  proto::gltf::Materials materials{};  ///< that the faces of a mesh name (material_attribute.h)
};

/// Refines one mesh or scene here, with so many threads, or at the server: both go the same way from the same bytes, so
/// the result is the same. A scene stays one if `output` is a scene, or standard output of no format; else it is
/// refined as a single mesh, which keeps the materials of a scene or an OBJ file if `output` can hold them. What of
/// those is missing is said on standard error. Throws what the work throws, and `FileError` where the mesh is at fault.
[[nodiscard]] RefinedFile refine_mesh(const MeshPlace& input, const MeshPlace& output, const RefineFlags& flags,
                                      unsigned threads);
/// Writes what was refined. Throws `FileError`.
void save_refined(const MeshPlace& output, const RefinedFile& made);

/// Refines every mesh in the folder `flags.input` into the folder `flags.output`, and says which files failed and which
/// were skipped.
void refine_folder(const RefineFlags& flags);

}  // namespace papilio::client
