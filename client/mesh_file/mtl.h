#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// Material libraries of OBJ files (.mtl) between bytes and values. Sources: Alias|Wavefront's MTL specification of
// 1995; the physically based keywords (Pr, Pm, Ke, norm) that exporters have added to it.

namespace papilio::client {

/// Images of a material.
enum class MtlMap : uint8_t { diffuse, emissive, normal, bump, roughness, metallic, opacity };
inline constexpr size_t mtl_map_count = 7;

/// Material of a library; members are empty if the library does not set them.
struct MtlMaterial {
  std::string name{};
  std::optional<std::array<double, 3>> diffuse{}, emissive{};  ///< Kd, Ke
  std::optional<double> opacity{};                             ///< d, else 1 - Tr
  std::optional<double> shininess{};                           ///< Ns
  std::optional<double> roughness{}, metallic{};               ///< Pr, Pm
  std::array<std::string, mtl_map_count> maps{};               ///< file names by `MtlMap`, with / in paths; "" for none

  [[nodiscard]] std::string& map(MtlMap which) { return maps.at(static_cast<size_t>(which)); }
  [[nodiscard]] const std::string& map(MtlMap which) const { return maps.at(static_cast<size_t>(which)); }
  friend bool operator==(const MtlMaterial&, const MtlMaterial&) = default;
};

/// Reads a library. Skips options of maps and unknown keywords. Names may have blanks. Numbers are finite and at least
/// 0; all but Ke and Ns are at most 1. Throws `ParseError`: binary data, UTF-16, a word that is no number, more than
/// `most_materials`.
[[nodiscard]] std::vector<MtlMaterial> parse_mtl(std::string_view bytes);

/// Writes a library that parse_mtl() reads as these materials. Names must have no line ends, and no blanks at their
/// ends. The roughness and metallic maps are channels of images, green and blue, as in glTF.
[[nodiscard]] std::string format_mtl(const std::vector<MtlMaterial>& materials);

}  // namespace papilio::client
