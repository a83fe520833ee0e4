#include "proto/gltf/material_writer.h"

#include <algorithm>
#include <string>
#include <vector>

#include "proto/gltf/extensions.h"

namespace papilio::proto::gltf {
namespace {

/// Returns text in UTF-8; other text is read as Latin-1.
std::string as_utf8(const std::string& text) {
  try {
    (void)Json(text).dump();
    return text;
  } catch (const Json::type_error&) {
    std::string out;
    for (const char c : text) {
      const auto byte = static_cast<unsigned char>(c);
      if (byte < 0x80) {
        out += c;
        continue;
      }
      out += static_cast<char>(0xC0 | byte >> 6);
      out += static_cast<char>(0x80 | (byte & 0x3F));
    }
    return out;
  }
}

/// Sets a texture of `holder`, if the material has an image for it. `textures`: number of each image's texture.
void set_texture(Json& holder, const char* key, const Material& material, ImageUse use,
                 const std::vector<std::optional<size_t>>& textures) {
  const auto image = material.image(use);
  if (image && *image < textures.size() && textures[*image]) holder[key] = {{"index", *textures[*image]}};
}

Json pbr_json(const Material& material, const std::vector<std::optional<size_t>>& textures) {
  Json pbr = Json::object();
  if (material.base_color != Material{}.base_color) pbr["baseColorFactor"] = material.base_color;
  set_texture(pbr, "baseColorTexture", material, ImageUse::base_color, textures);
  if (material.metallic != 1) pbr["metallicFactor"] = material.metallic;
  if (material.roughness != 1) pbr["roughnessFactor"] = material.roughness;
  set_texture(pbr, "metallicRoughnessTexture", material, ImageUse::metallic_roughness, textures);
  return pbr;
}

Json material_json(const Material& material, const std::vector<std::optional<size_t>>& textures) {
  Json json = Json::object();
  if (!material.name.empty()) json["name"] = as_utf8(material.name);
  json["pbrMetallicRoughness"] = pbr_json(material, textures);
  set_texture(json, "normalTexture", material, ImageUse::normal, textures);
  set_texture(json, "emissiveTexture", material, ImageUse::emissive, textures);
  const double strength = std::max(1.0, std::ranges::max(material.emissive));  // factors are at most 1
  std::array<double, 3> factors = material.emissive;
  for (double& factor : factors) factor /= strength;
  if (material.emissive != Material{}.emissive) json["emissiveFactor"] = factors;
  if (material.is_blended) json["alphaMode"] = "BLEND";
  if (strength > 1) json["extensions"][emissive_strength_extension] = {{"emissiveStrength", strength}};
  return json;
}

}  // namespace

void add_materials(Json& document, const Materials& materials, bool has_coordinates,
                   const std::function<size_t(std::string_view bytes)>& add_view) {
  std::vector<std::optional<size_t>> textures(materials.images.size());
  for (size_t i = 0; i < textures.size(); ++i) {
    const Image& image = materials.images[i];
    if (image.bytes.empty() || !has_coordinates) continue;
    Json json{{"bufferView", add_view(image.bytes)}, {"mimeType", as_utf8(image.media_type)}};
    if (!image.name.empty()) json["name"] = as_utf8(image.name);
    textures[i] = document["images"].size();
    document["images"].push_back(std::move(json));
    document["textures"].push_back({{"source", *textures[i]}});
  }
  for (const Material& material : materials.materials)
    document["materials"].push_back(material_json(material, textures));
  const bool has_strength = std::ranges::any_of(
      materials.materials, [](const Material& material) { return std::ranges::max(material.emissive) > 1; });
  if (has_strength) document["extensionsUsed"].push_back(emissive_strength_extension);
}

}  // namespace papilio::proto::gltf
