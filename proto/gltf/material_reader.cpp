#include "proto/gltf/material_reader.h"

#include <cmath>
#include <numbers>

#include "papilio/trigonometry.h"
#include "proto/gltf/data_uri.h"
#include "proto/gltf/extensions.h"
#include "proto/problem.h"

namespace papilio::proto::gltf {
namespace {

constexpr uint64_t most_image_bytes = uint64_t{1} << 32;

double number_of(const Json& value, const std::string& where) {
  if (!value.is_number()) refuse_document(where, "must be a number");
  return value.get<double>();
}

double number_member(const Json& object, const char* key, double fallback, const std::string& where) {
  const Json* value = find_member(object, key, where);
  return value == nullptr ? fallback : number_of(*value, where + "." + key);
}

/// Replaces the numbers by those of a member, if it exists.
template <size_t count>
void read_numbers(const Json& object, const char* key, std::array<double, count>& numbers, const std::string& where) {
  const Json* value = find_member(object, key, where);
  if (value == nullptr) return;
  const std::string name = where + "." + key;
  if (!value->is_array() || value->size() != count)
    refuse_document(name, "must be " + std::to_string(count) + " numbers");
  for (size_t i = 0; i < count; ++i) numbers[i] = number_of((*value)[i], name);
}

/// Returns sine and cosine of an angle in radians, bit-identical on every processor.
SineCosine sine_and_cosine(double angle) {
  constexpr double steps = 1ULL << 40;  // steps per turn
  const double turns = angle / (2 * std::numbers::pi);
  const double part = turns - std::floor(turns);
  if (!(part >= 0 && part < 1)) return {0, 1};  // not a number
  return sine_and_cosine_of_turn(static_cast<uint64_t>(part * steps), static_cast<uint64_t>(steps));
}

/// Reads the map of a texture: scaled, rotated counter-clockwise, moved. Source: KHR_texture_transform, as in three.js.
TextureMap read_map(const Json& texture, const std::string& where) {
  TextureMap map;
  map.set = static_cast<uint32_t>(whole_number(texture, "texCoord", where, 0));
  const Json* extension = find_extension(texture, texture_transform_extension, where);
  if (extension == nullptr) return map;
  map.set = static_cast<uint32_t>(whole_number(*extension, "texCoord", where, map.set));
  std::array<double, 2> scale{1, 1};
  read_numbers(*extension, "scale", scale, where);
  read_numbers(*extension, "offset", map.offset, where);
  const double rotation = number_member(*extension, "rotation", 0, where);
  const SineCosine at = rotation == 0 ? SineCosine{0, 1} : sine_and_cosine(rotation);
  map.u_axis = {scale[0] * at.cosine, -scale[0] * at.sine};
  map.v_axis = {scale[1] * at.sine, scale[1] * at.cosine};
  return map;
}

/// Returns the image of a texture, or of its extension for another kind of image.
std::optional<uint32_t> image_source_of(const Json& texture, const std::string& where) {
  if (const auto source = index_member(texture, "source", where)) return source;
  for (const char* name : {"EXT_texture_webp", "KHR_texture_basisu", "EXT_texture_avif", "MSFT_texture_dds"})
    if (const Json* extension = find_extension(texture, name, where)) return index_member(*extension, "source", where);
  return std::nullopt;
}

}  // namespace

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
  const TextureMap map = read_map(*texture, name);
  const auto image = image_of_texture(*index, name);
  if (!image) return;
  out_.materials.back().image(use) = image;
  if (!has_map_) maps_.back() = map;
  has_map_ = true;
}

std::optional<uint32_t> MaterialReader::image_of_texture(uint32_t texture, const std::string& where) {
  const auto source = image_source_of(element_of(views_.document().json, "textures", texture, where), where);
  if (!source) return std::nullopt;
  if (const auto known = images_.find(*source); known != images_.end()) return known->second;
  out_.images.push_back(read_image(*source));
  return images_.emplace(*source, static_cast<uint32_t>(out_.images.size() - 1)).first->second;
}

Image MaterialReader::read_image(uint32_t number) {
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
  return image;
}

}  // namespace papilio::proto::gltf
