#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "proto/gltf/materials.h"
#include "proto/gltf/texture_copier.h"
#include "proto/gltf/texture_map.h"
#include "proto/gltf/views.h"

namespace papilio::proto::gltf {

/// Reader of the materials that primitives use, each once, with their images. `Material` has neither textures of
/// occlusion and of extensions, nor samplers, nor maps; `Materials::gltf` has them all, but for textures of another set
/// than that of the material's first one. `views` must outlive this.
class MaterialReader {
 public:
  explicit MaterialReader(Views& views);

  /// Returns the number of a primitive's material in `Materials::materials`; `none` if it has none. Throws `Problem`.
  [[nodiscard]] uint32_t material_of(uint32_t mesh, uint32_t primitive);
  /// Returns the map of a material's first texture: of the base colour, else of the next `ImageUse`, else any.
  [[nodiscard]] TextureMap map_of(uint32_t material) const {
    return material < maps_.size() ? maps_[material] : TextureMap{};
  }
  /// Returns the materials in the order of their first use, without triangles.
  [[nodiscard]] Materials finish();

 private:
  uint32_t read(uint32_t number);
  void read_textures(const Json& material, const std::string& where);
  void read_texture(const Json& holder, const char* key, ImageUse use, const std::string& where);
  /// Adds a material's object to `gltf_`, its textures for coordinates that have the material's map.
  void keep_object(const Json& material, const std::string& where);
  [[nodiscard]] std::optional<uint32_t> image_of_texture(uint32_t texture, const std::string& where);
  /// Reads an image of the document. Returns its number in `out_`.
  uint32_t read_image(uint32_t number);

  Views& views_;
  Materials out_;
  Json gltf_ = Json::object();              ///< Materials::gltf
  TextureCopier textures_;                  ///< from the document to `gltf_`
  std::vector<TextureMap> maps_;            ///< [materials]
  bool has_map_ = false;                    ///< whether the latest material has a map
  std::map<uint32_t, uint32_t> materials_;  ///< new numbers by numbers in the document
  uint64_t image_bytes_ = 0;
};

}  // namespace papilio::proto::gltf
