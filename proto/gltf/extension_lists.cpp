#include "proto/gltf/extension_lists.h"

#include <algorithm>
#include <array>

#include "proto/gltf/extensions.h"

namespace papilio::proto::gltf {
bool uses_extension(const Json& value, const char* name) {
  if (value.is_object()) {
    for (const auto& [key, inner] : value.items()) {
      if (key == "extensions" && inner.is_object() && inner.contains(name)) return true;
      if (key != "extras" && uses_extension(inner, name)) return true;
    }
  } else if (value.is_array()) {
    return std::ranges::any_of(value, [&](const Json& inner) { return uses_extension(inner, name); });
  }
  return false;
}

namespace {

constexpr std::array extension_lists{"extensionsUsed", "extensionsRequired"};

bool is_listed(const Json& document, const char* list, const char* name) {
  const Json& names = array_of(document, list);
  return std::ranges::any_of(names, [&](const Json& known) { return is_text(known, name); });
}

void put_listed(Json& document, const char* list, const char* name, bool listed) {
  if (is_listed(document, list, name) == listed) return;
  if (listed) {
    document[list].push_back(name);
    return;
  }
  Json rest = Json::array();
  for (const Json& known : document[list])
    if (!is_text(known, name)) rest.push_back(known);
  if (rest.empty())
    document.erase(list);
  else
    document[list] = std::move(rest);
}

}  // namespace

void list_extensions(Json& document) {
  for (const char* name : {draco_extension, meshopt_extension}) {
    const bool was_required = is_listed(document, "extensionsRequired", name);
    const bool is_used = uses_extension(document, name);
    if (!is_used && !was_required && !is_listed(document, "extensionsUsed", name)) continue;
    put_listed(document, "extensionsUsed", name, is_used);
    put_listed(document, "extensionsRequired", name, is_used);
  }
  if (uses_extension(document, detail_extension)) return;
  for (const char* list : extension_lists) put_listed(document, list, detail_extension, false);
}

void add_listed_extensions(Json& document, const Json& source) {
  for (const char* list : extension_lists)
    for (const Json& name : array_of(source, list))
      if (const std::string text = name.is_string() ? name.get<std::string>() : "";
          uses_extension(document, text.c_str()))
        put_listed(document, list, text.c_str(), true);
}

bool uses_compression(const Json& document) {
  return std::ranges::any_of(array_of(document, "extensionsUsed"), [](const Json& name) {
    return is_text(name, draco_extension) || is_text(name, meshopt_extension);
  });
}

}  // namespace papilio::proto::gltf
