#include "proto/detail/used_materials.h"

#include <vector>

#include "papilio/mesh.h"

namespace papilio::proto::detail {

gltf::Materials used_materials(const gltf::Materials& materials) {
  gltf::Materials used;
  std::vector<bool> is_used(materials.materials.size());
  for (const uint32_t number : materials.of_triangle)
    if (number < is_used.size()) is_used[number] = true;
  std::vector<uint32_t> number(is_used.size(), none), image_number(materials.images.size(), none);
  for (size_t m = 0; m < is_used.size(); ++m) {
    if (!is_used[m]) continue;
    number[m] = static_cast<uint32_t>(used.materials.size());
    gltf::Material& material = used.materials.emplace_back(materials.materials[m]);
    for (std::optional<uint32_t>& image : material.images) {
      if (!image) continue;
      uint32_t& taken = image_number.at(*image);
      if (taken == none) {
        taken = static_cast<uint32_t>(used.images.size());
        used.images.push_back(materials.images[*image]);
      }
      image = taken;
    }
  }
  if (used.empty()) return used;
  for (const uint32_t of : materials.of_triangle) used.of_triangle.push_back(of < number.size() ? number[of] : none);
  return used;
}

}  // namespace papilio::proto::detail
