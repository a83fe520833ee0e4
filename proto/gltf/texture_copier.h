#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "proto/gltf/json.h"

// Textures of materials, by the objects that name them: texture infos, objects with a member "index", anywhere in a
// material but in extras.

namespace papilio::proto::gltf {

/// Calls `visit` with the key and the object of each texture info of a material, and removes those for which it returns
/// false.
void visit_textures(Json& material, const std::function<bool(const std::string& key, Json& info)>& visit);

/// Copier of the textures that materials use, each once, with their samplers, from one document to another.
class TextureCopier {
 public:
  /// `copy_image`: copies an image of `from`, and returns its number in `to`; nothing if it is left out. Refers to both
  /// documents, which must outlive this.
  TextureCopier(const Json& from, Json& to, std::function<std::optional<uint32_t>(uint32_t image)> copy_image)
      : from_(from), to_(to), copy_image_(std::move(copy_image)) {}

  /// Copies the textures of a material's object, and changes their numbers in it. Removes texture infos without an
  /// image. Throws `Problem`; `where` names the material.
  void copy(Json& material, const std::string& where);
  /// Returns the number in `to` of an image of `from`, which is copied at its first use.
  std::optional<uint32_t> image(uint32_t number);

 private:
  std::optional<uint32_t> texture(uint32_t number, const std::string& where);
  uint32_t sampler(uint32_t number, const std::string& where);
  /// Changes the number of the image in a texture, or in an extension of it. Returns false if it has none.
  bool take_source(Json& holder, const std::string& where);

  const Json& from_;
  Json& to_;
  std::function<std::optional<uint32_t>(uint32_t)> copy_image_;
  std::map<uint32_t, std::optional<uint32_t>> textures_, images_;  ///< new numbers
  std::map<uint32_t, uint32_t> samplers_;
};

}  // namespace papilio::proto::gltf
