#include "proto/gltf/split_instances.h"

#include <vector>

#include "proto/draco_header.h"

namespace papilio::proto::gltf {

void split_instances(Json& document) {
  std::vector<uint8_t> is_shown(array_of(document, "meshes").size(), 0);
  uint64_t copied = 0;
  for (size_t n = 0; n < array_of(document, "nodes").size(); ++n) {
    Json& node = document["nodes"][n];
    const std::string where = place("nodes", n);
    const auto mesh = index_member(node, "mesh", where);
    if (!mesh) continue;
    (void)element_of(document, "meshes", *mesh, where);
    if (is_shown[*mesh] == 0) {
      is_shown[*mesh] = 1;
      continue;
    }
    Json copy = document["meshes"][*mesh];
    require_within(copied += copy.dump().size(), most_copied_json, "bytes of JSON in copies of meshes",
                   "Leave split_instances out.");
    node["mesh"] = document["meshes"].size();
    document["meshes"].push_back(std::move(copy));
  }
}

}  // namespace papilio::proto::gltf
