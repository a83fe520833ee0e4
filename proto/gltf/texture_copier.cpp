#include "proto/gltf/texture_copier.h"

#include <utility>
#include <vector>

namespace papilio::proto::gltf {
namespace {

/// Appends an element to an array of a document; returns its number.
uint32_t append_element(Json& document, const char* array, Json element) {
  document[array].push_back(std::move(element));
  return static_cast<uint32_t>(document[array].size() - 1);
}

}  // namespace

void visit_textures(Json& material, const std::function<bool(const std::string& key, Json& info)>& visit) {
  std::vector<std::string> removed;
  for (const auto& [key, value] : material.items()) {
    if (key == "extras" || !value.is_structured()) continue;
    if (!value.is_object() || !value.contains("index"))
      visit_textures(value, visit);
    else if (!visit(key, value))
      removed.push_back(key);
  }
  for (const std::string& key : removed) material.erase(key);
}

void TextureCopier::copy(Json& material, const std::string& where) {
  visit_textures(material, [&](const std::string& key, Json& info) {
    const auto number = texture(*index_member(info, "index", where + "." + key), where + "." + key);
    if (number) info["index"] = *number;
    return number.has_value();
  });
}

std::optional<uint32_t> TextureCopier::image(uint32_t number) {
  if (const auto known = images_.find(number); known != images_.end()) return known->second;
  return images_.emplace(number, copy_image_(number)).first->second;
}

std::optional<uint32_t> TextureCopier::texture(uint32_t number, const std::string& where) {
  if (const auto known = textures_.find(number); known != textures_.end()) return known->second;
  Json json = element_of(from_, "textures", number, where);
  const std::string at = place("textures", number);
  bool has_image = take_source(json, at);
  std::vector<std::string> lost;
  if (Json* extensions = find_member(json, "extensions", at); extensions != nullptr && extensions->is_object())
    for (const auto& [name, extension] : extensions->items()) {
      if (!extension.is_object() || !extension.contains("source")) continue;
      if (take_source(extension, at + "." + name))
        has_image = true;
      else
        lost.push_back(name);
    }
  for (const std::string& name : lost) erase_extension(json, name.c_str());
  std::optional<uint32_t>& made = textures_[number];
  if (!has_image) return made;
  if (const auto old = index_member(json, "sampler", at)) json["sampler"] = sampler(*old, at);
  made = append_element(to_, "textures", std::move(json));
  return made;
}

uint32_t TextureCopier::sampler(uint32_t number, const std::string& where) {
  if (const auto known = samplers_.find(number); known != samplers_.end()) return known->second;
  return samplers_[number] = append_element(to_, "samplers", element_of(from_, "samplers", number, where));
}

bool TextureCopier::take_source(Json& holder, const std::string& where) {
  const auto old = index_member(holder, "source", where);
  if (!old) return false;
  const auto made = image(*old);
  if (made)
    holder["source"] = *made;
  else
    holder.erase("source");
  return made.has_value();
}

}  // namespace papilio::proto::gltf
