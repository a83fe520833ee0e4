#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "proto/gltf/materials.h"
#include "proto/gltf/views.h"

namespace papilio::proto::gltf {

/// Texture coordinates of a material: the set, and the affine map of KHR_texture_transform.
struct TextureMap {
  uint32_t set = 0;  ///< number n of TEXCOORD_n
  std::array<double, 2> u_axis{1, 0}, v_axis{0, 1}, offset{};

  /// Returns the coordinates at which the image is read.
  [[nodiscard]] std::array<double, 2> point(double u, double v) const {
    return {u_axis[0] * u + v_axis[0] * v + offset[0], u_axis[1] * u + v_axis[1] * v + offset[1]};
  }
  friend bool operator==(const TextureMap&, const TextureMap&) = default;
};

/// Reader of the materials that primitives use, each once, with their images. Skips textures of occlusion and of
/// extensions, samplers, and the maps of all but a material's first texture. `views` must outlive this.
class MaterialReader {
 public:
  explicit MaterialReader(Views& views) : views_(views) {}

  /// Returns the number of a primitive's material in `Materials::materials`; `none` if it has none. Throws `Problem`.
  [[nodiscard]] uint32_t material_of(uint32_t mesh, uint32_t primitive);
  /// Returns the map of a material's first texture: of the base colour, else of the next `ImageUse`.
  [[nodiscard]] TextureMap map_of(uint32_t material) const {
    return material < maps_.size() ? maps_[material] : TextureMap{};
  }
  /// Returns the materials in the order of their first use, without triangles.
  [[nodiscard]] Materials finish() { return std::move(out_); }

 private:
  uint32_t read(uint32_t number);
  void read_textures(const Json& material, const std::string& where);
  void read_texture(const Json& holder, const char* key, ImageUse use, const std::string& where);
  [[nodiscard]] std::optional<uint32_t> image_of_texture(uint32_t texture, const std::string& where);
  [[nodiscard]] Image read_image(uint32_t number);

  Views& views_;
  Materials out_;
  std::vector<TextureMap> maps_;                     ///< [materials]
  bool has_map_ = false;                             ///< whether the latest material has a map
  std::map<uint32_t, uint32_t> materials_, images_;  ///< new numbers by numbers in the document
  uint64_t image_bytes_ = 0;
};

}  // namespace papilio::proto::gltf
