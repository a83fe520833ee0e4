#include "tests/bench/textured_scene.h"

#include "tests/support/gltf_scene.h"
#include "tests/support/real_mesh.h"

namespace papilio::bench {

std::string textured_scene(size_t bytes_of_image) {
  test::GltfScene scene;
  scene.add_mesh(test::real_mesh("elephant20k.drc"));
  if (bytes_of_image == 0) return scene.glb();
  const size_t view = scene.add_view(std::string(bytes_of_image, 'x'));
  scene.json["images"] = {{{"bufferView", view}, {"mimeType", "image/png"}}};
  return scene.glb();
}

}  // namespace papilio::bench
