#include "proto/detail/only_material.h"

#include <algorithm>

#include "papilio/mesh.h"

namespace papilio::proto::detail {

std::optional<gltf::Materials> only_material(const gltf::Materials& materials) {
  const std::vector<uint32_t>& of_triangle = materials.of_triangle;
  if (of_triangle.empty() || of_triangle[0] >= materials.materials.size()) return std::nullopt;
  if (!std::ranges::all_of(of_triangle, [&](uint32_t number) { return number == of_triangle[0]; })) return std::nullopt;
  gltf::Materials only;
  gltf::Material& material = only.materials.emplace_back(materials.materials[of_triangle[0]]);
  std::vector<uint32_t> number(materials.images.size(), none);
  for (std::optional<uint32_t>& image : material.images) {
    if (!image) continue;
    uint32_t& taken = number.at(*image);
    if (taken == none) {
      taken = static_cast<uint32_t>(only.images.size());
      only.images.push_back(materials.images[*image]);
    }
    image = taken;
  }
  return only;
}

}  // namespace papilio::proto::detail
