#include "proto/detail/used_materials.h"

#include <memory>
#include <utility>
#include <vector>

#include "papilio/mesh.h"
#include "proto/gltf/texture_copier.h"

namespace papilio::proto::detail {

using gltf::Json;

gltf::Materials used_materials(const gltf::Materials& materials) {
  gltf::Materials used;
  std::vector<bool> is_used(materials.materials.size());
  for (const uint32_t number : materials.of_triangle)
    if (number < is_used.size()) is_used[number] = true;
  std::vector<uint32_t> number(is_used.size(), none);
  const Json nothing = Json::object();
  const Json& from = materials.gltf ? *materials.gltf : nothing;
  Json objects = Json::object();
  gltf::TextureCopier textures(from, objects, [&](uint32_t image) {
    used.images.push_back(materials.images.at(image));
    if (materials.gltf) objects["images"].push_back(from.at("images").at(image));
    return std::optional(static_cast<uint32_t>(used.images.size() - 1));
  });
  for (size_t m = 0; m < is_used.size(); ++m) {
    if (!is_used[m]) continue;
    number[m] = static_cast<uint32_t>(used.materials.size());
    gltf::Material& material = used.materials.emplace_back(materials.materials[m]);
    if (materials.gltf) {
      material.images = {};  // writers take those of the object
      Json object = from.at("materials").at(m);
      textures.copy(object, "materials");
      objects["materials"].push_back(std::move(object));
    }
    for (std::optional<uint32_t>& image : material.images)
      if (image) image = textures.image(*image);
  }
  if (used.empty()) return used;
  for (const uint32_t of : materials.of_triangle) used.of_triangle.push_back(of < number.size() ? number[of] : none);
  if (!materials.gltf) return used;
  for (const char* list : {"extensionsUsed", "extensionsRequired"}) objects[list] = gltf::array_of(from, list);
  used.gltf = std::make_shared<const Json>(std::move(objects));
  return used;
}

}  // namespace papilio::proto::detail
