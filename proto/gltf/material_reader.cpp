#include "proto/gltf/material_reader.h"

#include <memory>
#include <utility>

#include "proto/gltf/data_uri.h"
#include "proto/gltf/extensions.h"
#include "proto/problem.h"
#include "proto/text.h"

namespace papilio::proto::gltf {
namespace {

constexpr uint64_t most_image_bytes = uint64_t{1} << 32;

/// Returns the image of a texture, or of its extension for another kind of image.
std::optional<uint32_t> image_source_of(const Json& texture, const std::string& where) {
  if (const auto source = index_member(texture, "source", where)) return source;
  for (const char* name : {"EXT_texture_webp", "KHR_texture_basisu", "EXT_texture_avif", "MSFT_texture_dds"})
    if (const Json* extension = find_extension(texture, name, where)) return index_member(*extension, "source", where);
  return std::nullopt;
}

/// Removes the extensions of a material whose data are at the document's root. Returns their names.
std::vector<std::string> erase_shared_extensions(Json& material, const Json& document) {
  std::vector<std::string> erased;
  const auto shared = document.find("extensions");
  if (shared == document.end() || !shared->is_object()) return erased;
  for (const auto& [name, data] : shared->items()) {
    if (find_extension(material, name.c_str(), "a material") == nullptr) continue;
    erase_extension(material, name.c_str());
    erased.push_back(name);
  }
  return erased;
}

}  // namespace

MaterialReader::MaterialReader(Views& views)
    : views_(views),
      textures_(views.document().json, gltf_, [this](uint32_t image) { return std::optional(read_image(image)); }) {}

Materials MaterialReader::finish() {
  for (const char* list : {"extensionsUsed", "extensionsRequired"})
    gltf_[list] = array_of(views_.document().json, list);
  if (!out_.empty()) out_.gltf = std::make_shared<const Json>(std::move(gltf_));
  return std::move(out_);
}

uint32_t MaterialReader::material_of(uint32_t mesh, uint32_t primitive) {
  const std::string where = place("meshes", mesh) + ".primitives[" + std::to_string(primitive) + "]";
  const Json& primitives = element_of(views_.document().json, "meshes", mesh, where).at("primitives");
  const auto number = index_member(primitives.at(primitive), "material", where);
  if (!number) return none;
  if (const auto known = materials_.find(*number); known != materials_.end()) return known->second;
  return materials_.emplace(*number, read(*number)).first->second;
}

uint32_t MaterialReader::read(uint32_t number) {
  const std::string where = place("materials", number);
  const Json& json = element_of(views_.document().json, "materials", number, where);
  Material& material = out_.materials.emplace_back();
  material.name = text_member(json, "name", where);
  const std::string mode = text_member(json, "alphaMode", where);
  material.is_blended = !mode.empty() && mode != "OPAQUE";
  read_numbers(json, "emissiveFactor", material.emissive, where);
  if (const Json* extension = find_extension(json, emissive_strength_extension, where))
    for (double& factor : material.emissive) factor *= number_member(*extension, "emissiveStrength", 1, where);
  if (const Json* pbr = find_member(json, "pbrMetallicRoughness", where)) {
    read_numbers(*pbr, "baseColorFactor", material.base_color, where);
    material.metallic = number_member(*pbr, "metallicFactor", 1, where);
    material.roughness = number_member(*pbr, "roughnessFactor", 1, where);
  }
  read_textures(json, where);
  keep_object(json, where);
  return static_cast<uint32_t>(out_.materials.size() - 1);
}

void MaterialReader::read_textures(const Json& material, const std::string& where) {
  maps_.emplace_back();
  has_map_ = false;
  if (const Json* pbr = find_member(material, "pbrMetallicRoughness", where)) {
    read_texture(*pbr, "baseColorTexture", ImageUse::base_color, where);
    read_texture(*pbr, "metallicRoughnessTexture", ImageUse::metallic_roughness, where);
  }
  read_texture(material, "normalTexture", ImageUse::normal, where);
  read_texture(material, "emissiveTexture", ImageUse::emissive, where);
}

void MaterialReader::read_texture(const Json& holder, const char* key, ImageUse use, const std::string& where) {
  const Json* texture = find_member(holder, key, where);
  if (texture == nullptr) return;
  const std::string name = where + "." + key;
  const auto index = index_member(*texture, "index", name);
  if (!index) refuse_document(name, "has no index");
  const TextureMap map = read_texture_map(*texture, name);
  const auto image = image_of_texture(*index, name);
  if (!image) return;
  out_.materials.back().image(use) = image;
  if (!has_map_) maps_.back() = map;
  has_map_ = true;
}

void MaterialReader::keep_object(const Json& material, const std::string& where) {
  Json json = material;
  const std::string& name = out_.materials.back().name;
  const std::string of = " of " + (name.empty() ? where : "the material " + quote(name));
  for (const std::string& extension : erase_shared_extensions(json, views_.document().json))
    out_.left_out.push_back(extension + of + " is left out: its data are outside of the material.");
  visit_textures(json, [&](const std::string& key, Json& info) {
    const TextureMap map = read_texture_map(info, where + "." + key);
    TextureMap& done = maps_.back();
    if (!std::exchange(has_map_, true)) done = map;
    if (map.set != done.set)
      out_.left_out.push_back(key + of + " is left out: it uses TEXCOORD_" + std::to_string(map.set) +
                              ", and only TEXCOORD_" + std::to_string(done.set) +
                              " is kept, which its other textures use.");
    else if (!rewrite_texture_map(info, map, done))
      out_.left_out.push_back(key + of +
                              " is left out: its KHR_texture_transform does not fit that of the other textures.");
    else
      return true;
    return false;
  });
  textures_.copy(json, where);
  gltf_["materials"].push_back(std::move(json));
}

std::optional<uint32_t> MaterialReader::image_of_texture(uint32_t texture, const std::string& where) {
  const auto source = image_source_of(element_of(views_.document().json, "textures", texture, where), where);
  return source ? textures_.image(*source) : std::nullopt;
}

uint32_t MaterialReader::read_image(uint32_t number) {
  const std::string where = place("images", number);
  const Json& json = element_of(views_.document().json, "images", number, where);
  Image image{.name = text_member(json, "name", where), .media_type = text_member(json, "mimeType", where)};
  if (const auto view = index_member(json, "bufferView", where)) {
    image.bytes = views_.bytes(*view, where);
  } else if (std::string uri = text_member(json, "uri", where); is_data_uri(uri)) {
    auto bytes = decode_data_uri(uri);
    if (!bytes) refuse_document(where, "has a data URI that is not valid base64");
    constexpr size_t scheme = 5;  // "data:"
    if (image.media_type.empty()) image.media_type = uri.substr(scheme, uri.find_first_of(";,") - scheme);
    image.bytes = std::move(*bytes);
  } else {
    image.uri = std::move(uri);
  }
  image_bytes_ += image.bytes.size();
  if (image_bytes_ > most_image_bytes)
    throw Problem(Code::mesh_too_large,
                  "The images of the scene exceed " + std::to_string(most_image_bytes) + " bytes. Use smaller images.");
  Json kept = json;
  for (const char* key : {"bufferView", "uri"}) kept.erase(key);
  gltf_["images"].push_back(std::move(kept));
  out_.images.push_back(std::move(image));
  return static_cast<uint32_t>(out_.images.size() - 1);
}

}  // namespace papilio::proto::gltf
