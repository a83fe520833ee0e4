#include <string>

#include "proto/gltf/scene_refinement.h"
#include "tests/bench/pairs.h"
#include "tests/bench/textured_scene.h"

// Cost of the images of a scene: a scene with 4 MB of images compared with the scene without images plus two copies of
// as many bytes, for reading and writing.

namespace papilio::bench {
namespace {

double refine_scene(const std::string& glb) {
  static const proto::Parameters parameters = proto::parse_query({{"levels", "2"}});
  return seconds([&] { (void)proto::gltf::SceneRefinement(glb, parameters, {}).run(); });
}

}  // namespace

void add_scene() {
  const std::string textured = textured_scene(image_bytes);
  const std::string plain = textured_scene(0);
  const std::string image(image_bytes, 'x');
  add({.name = "scene/4 MB of images",
       .divisor = 1e6,
       .unit = "ms",
       .ours = [=] { return refine_scene(textured); },
       .peer =
           [=] {
             std::string copy;
             const double copying = seconds([&] {
               copy = image;
               copy += image;
             });
             return copy.empty() ? 0 : refine_scene(plain) + copying;
           }});
}

}  // namespace papilio::bench
