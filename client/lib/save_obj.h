#pragma once

#include "client/lib/mesh_stream.h"
#include "proto/gltf/materials.h"

namespace papilio::client {

/// Writes a mesh as NAME.obj, and beside it its materials as NAME.mtl and their images, such as NAME_IMAGE.png. Images
/// are written first and the .obj file last; after a failure, new files are removed again. To standard output, or
/// without materials, only the mesh is written. Names are changed to stay in the folder, to be unique, and to fit on a
/// line. Throws `FileError`.
void save_obj(const MeshPlace& place, const proto::gltf::MaterialMesh& model);

}  // namespace papilio::client
