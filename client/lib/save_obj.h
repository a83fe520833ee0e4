#pragma once

#include "client/lib/mesh_stream.h"
#include "proto/gltf/materials.h"

namespace papilio::client {

/// Writes a mesh as NAME.obj, and beside it its materials as NAME.mtl and their images as NAME_IMAGE.png and the like.
/// Images come first and the .obj file last; where one cannot be written, those that are new are removed again. To
/// standard output, and without materials, the mesh alone is written. Names are changed so that they stay in the
/// folder, are unique and fit on a line. Throws `FileError`.
void save_obj(const MeshPlace& place, const proto::gltf::MaterialMesh& model);

}  // namespace papilio::client
