#include "proto/gltf/references.h"

#include <string>

#include "proto/gltf/extensions.h"

namespace papilio::proto::gltf {
namespace {

/// References to the elements of an array, by index.
using Counts = std::vector<uint32_t>;

void count(Counts& counts, const Json& index) {
  if (!index.is_number()) return;
  const double number = index.get<double>();  // 4.0 is a valid index
  if (number >= 0 && number < static_cast<double>(counts.size())) ++counts[static_cast<size_t>(number)];
}

void count_member(Counts& counts, const Json& of, const char* key) {
  if (of.is_object() && of.contains(key)) count(counts, of[key]);
}

void count_members(Counts& counts, const Json& of) {
  if (of.is_object())
    for (const auto& [key, value] : of.items()) count(counts, value);
}

const Json& member_or_null(const Json& of, const char* key) {
  static const Json null;
  if (!of.is_object()) return null;
  const auto found = of.find(key);
  return found == of.end() ? null : *found;
}

void count_primitive(Counts& accessors, const Json& primitive) {
  count_members(accessors, member_or_null(primitive, "attributes"));
  count_member(accessors, primitive, "indices");
  for (const Json& target : member_or_null(primitive, "targets")) count_members(accessors, target);
}

Counts count_accessors(const Json& document) {
  Counts counts(array_of(document, "accessors").size());
  for (const Json& mesh : array_of(document, "meshes"))
    for (const Json& primitive : member_or_null(mesh, "primitives")) count_primitive(counts, primitive);
  for (const Json& animation : array_of(document, "animations"))
    for (const Json& sampler : member_or_null(animation, "samplers")) {
      count_member(counts, sampler, "input");
      count_member(counts, sampler, "output");
    }
  for (const Json& skin : array_of(document, "skins")) count_member(counts, skin, "inverseBindMatrices");
  for (const Json& node : array_of(document, "nodes"))
    count_members(
        counts, member_or_null(member_or_null(member_or_null(node, "extensions"), instancing_extension), "attributes"));
  return counts;
}

/// Counts every member "bufferView", in extensions and extras too.
void count_views(Counts& counts, const Json& value) {
  if (!value.is_structured()) return;
  if (value.is_object()) count_member(counts, value, "bufferView");
  for (const Json& inner : value) count_views(counts, inner);
}

Counts count_released_views(const Json& document, const std::vector<bool>& accessors,
                            const std::vector<PrimitivePlace>& replaced) {
  Counts counts(array_of(document, "bufferViews").size());
  for (size_t i = 0; i < accessors.size(); ++i)
    if (accessors[i]) count_views(counts, document["accessors"][i]);
  for (const PrimitivePlace& at : replaced) {
    const Json& extensions = member_or_null(document["meshes"][at.mesh]["primitives"][at.primitive], "extensions");
    count_member(counts, member_or_null(extensions, draco_extension), "bufferView");
    count_views(counts, member_or_null(extensions, detail_extension));
  }
  return counts;
}

std::vector<bool> wholly_released(const Counts& released, const Counts& all) {
  std::vector<bool> out(all.size());
  for (size_t i = 0; i < all.size(); ++i) out[i] = released[i] > 0 && released[i] == all[i];
  return out;
}

}  // namespace

Released find_released(const Json& document, const std::vector<PrimitivePlace>& replaced) {
  const Counts all = count_accessors(document);
  Counts of_replaced(all.size());
  for (const PrimitivePlace& at : replaced)
    count_primitive(of_replaced, document["meshes"][at.mesh]["primitives"][at.primitive]);
  Released released{.accessors = wholly_released(of_replaced, all), .views = {}, .views_of_accessors = {}};
  Counts views(array_of(document, "bufferViews").size());
  count_views(views, document);
  Counts of_accessors(views.size());
  for (const Json& accessor : array_of(document, "accessors")) count_member(of_accessors, accessor, "bufferView");
  released.views_of_accessors = wholly_released(of_accessors, views);
  released.views = wholly_released(count_released_views(document, released.accessors, replaced), views);
  return released;
}

std::vector<uint32_t> find_detail_views(const Json& document) {
  Counts all(array_of(document, "bufferViews").size());
  count_views(all, document);
  Counts of_detail(all.size());
  for (const Json& mesh : array_of(document, "meshes"))
    for (const Json& primitive : member_or_null(mesh, "primitives"))
      count_views(of_detail, member_or_null(member_or_null(primitive, "extensions"), detail_extension));
  const std::vector<bool> released = wholly_released(of_detail, all);
  std::vector<uint32_t> views;
  for (uint32_t v = 0; v < released.size(); ++v)
    if (released[v]) views.push_back(v);
  return views;
}

}  // namespace papilio::proto::gltf
