#include "proto/gltf/material_writer.h"

#include <algorithm>
#include <string>
#include <vector>

#include "proto/gltf/extension_lists.h"
#include "proto/gltf/extensions.h"
#include "proto/gltf/texture_copier.h"

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

using AddView = std::function<size_t(std::string_view bytes)>;

/// Adds an image. `json`: its object without its bytes. Returns its number; nothing if it has no bytes.
std::optional<uint32_t> add_image(Json& document, const Image& image, Json json, const AddView& add_view) {
  if (image.bytes.empty()) return std::nullopt;
  json["bufferView"] = add_view(image.bytes);
  if (!image.media_type.empty()) json["mimeType"] = as_utf8(image.media_type);
  if (!image.name.empty()) json["name"] = as_utf8(image.name);
  document["images"].push_back(std::move(json));
  return static_cast<uint32_t>(document["images"].size() - 1);
}

/// Adds the materials of a scene as they are there.
void add_objects(Json& document, const Materials& materials, bool has_coordinates, const AddView& add_view) {
  const Json& gltf = *materials.gltf;
  TextureCopier textures(gltf, document, [&](uint32_t image) {
    return has_coordinates ? add_image(document, materials.images.at(image), gltf.at("images").at(image), add_view)
                           : std::nullopt;
  });
  for (Json material : gltf.at("materials")) {
    textures.copy(material, "materials");
    document["materials"].push_back(std::move(material));
  }
  add_listed_extensions(document, gltf);
}

}  // namespace

void add_materials(Json& document, const Materials& materials, bool has_coordinates, const AddView& add_view) {
  if (materials.gltf) return add_objects(document, materials, has_coordinates, add_view);
  std::vector<std::optional<size_t>> textures(materials.images.size());
  for (size_t i = 0; has_coordinates && i < textures.size(); ++i) {
    textures[i] = add_image(document, materials.images[i], Json::object(), add_view);
    if (textures[i]) document["textures"].push_back({{"source", *textures[i]}});
  }
  for (const Material& material : materials.materials)
    document["materials"].push_back(material_json(material, textures));
  const bool has_strength = std::ranges::any_of(
      materials.materials, [](const Material& material) { return std::ranges::max(material.emissive) > 1; });
  if (has_strength) document["extensionsUsed"].push_back(emissive_strength_extension);
}

}  // namespace papilio::proto::gltf
