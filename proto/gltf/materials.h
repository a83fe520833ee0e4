#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "proto/mesh_format.h"

// Materials as plain values, between glTF and other formats.

namespace papilio::proto::gltf {

/// Image of a material: its bytes or, where it is a file of its own, its URI.
struct Image {
  std::string name{};
  std::string media_type{};  ///< "image/png"; "" if the scene does not say
  std::string bytes{};
  std::string uri{};  ///< relative; "" for an image with bytes

  friend bool operator==(const Image&, const Image&) = default;
};

/// Purpose of a material's image.
enum class ImageUse : uint8_t { base_color, metallic_roughness, normal, emissive };
inline constexpr size_t image_use_count = 4;

/// Material of the metallic-roughness model. Numbers are in 0..1 unless they say otherwise.
struct Material {
  std::string name{};
  std::array<double, 4> base_color{1, 1, 1, 1};
  bool is_blended = false;             ///< alpha counts; else the surface is opaque whatever its alpha
  std::array<double, 3> emissive{};    ///< at least 0, beyond 1 for stronger lights
  double metallic = 1, roughness = 1;  ///< glTF's defaults
  std::array<std::optional<uint32_t>, image_use_count> images{};  ///< in Materials::images, by `ImageUse`

  [[nodiscard]] std::optional<uint32_t>& image(ImageUse use) { return images.at(static_cast<size_t>(use)); }
  [[nodiscard]] const std::optional<uint32_t>& image(ImageUse use) const { return images.at(static_cast<size_t>(use)); }
  friend bool operator==(const Material&, const Material&) = default;
};

/// Materials of a mesh.
struct Materials {
  std::vector<Material> materials{};
  std::vector<Image> images{};
  std::vector<uint32_t> of_triangle{};  ///< in `materials`, `none` for none; empty without materials

  [[nodiscard]] bool empty() const { return materials.empty(); }
};

/// A mesh whose triangles have materials.
struct MaterialMesh {
  FormattedMesh mesh;
  Materials materials{};
};

}  // namespace papilio::proto::gltf
