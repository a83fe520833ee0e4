#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "proto/mesh_format.h"

// Materials as plain values, between glTF and other formats.

namespace papilio::proto::gltf {

/// Image of a material: its bytes, or the URI of an external file.
struct Image {
  std::string name{};
  std::string media_type{};  ///< "image/png"; "" if unknown
  std::string bytes{};
  std::string uri{};  ///< relative URI; "" for an image with bytes

  friend bool operator==(const Image&, const Image&) = default;
};

/// Purpose of a material's image.
enum class ImageUse : uint8_t { base_color, metallic_roughness, normal, emissive };
inline constexpr size_t image_use_count = 4;

/// Material of the metallic-roughness model. Numbers are in 0..1 unless noted.
struct Material {
  std::string name{};
  std::array<double, 4> base_color{1, 1, 1, 1};
  bool is_blended = false;             ///< whether alpha has an effect; else the surface is opaque
  std::array<double, 3> emissive{};    ///< light of the surface, at least 0, and above 1 for stronger lights
  double metallic = 1, roughness = 1;  ///< factors, with glTF's defaults
  std::array<std::optional<uint32_t>, image_use_count> images{};  ///< [ImageUse] index in Materials::images

  [[nodiscard]] std::optional<uint32_t>& image(ImageUse use) { return images.at(static_cast<size_t>(use)); }
  [[nodiscard]] const std::optional<uint32_t>& image(ImageUse use) const { return images.at(static_cast<size_t>(use)); }
  friend bool operator==(const Material&, const Material&) = default;
};

/// Materials of a mesh.
struct Materials {
  std::vector<Material> materials{};
  std::vector<Image> images{};
  std::vector<uint32_t> of_triangle{};  ///< [triangles] index in `materials`, or `none`; empty without materials
  /// Document with the materials of a scene as they are there, and their textures and samplers. Its arrays "materials"
  /// and "images" have the numbers of `materials` and `images`, and texture coordinates are those of TEXCOORD_0 as the
  /// mesh has them. Null for materials of other formats.
  std::shared_ptr<const nlohmann::ordered_json> gltf{};
  std::vector<std::string> left_out{};  ///< sentences about parts of a scene's materials that `gltf` lacks

  [[nodiscard]] bool empty() const { return materials.empty(); }
};

/// Mesh whose triangles have materials.
struct MaterialMesh {
  FormattedMesh mesh;
  Materials materials{};
};

}  // namespace papilio::proto::gltf
