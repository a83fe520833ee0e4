#include "proto/gltf/vertices.h"

#include <algorithm>
#include <functional>
#include <string_view>
#include <unordered_map>

namespace papilio::proto::gltf {
namespace {

/// Calls `visit` with each attribute of the vertices, including morph targets.
template <class Visit>
void for_each_stream(const VertexSet& set, const Visit& visit) {
  for (const VertexStream& stream : set.attributes) visit(stream.elements);
  for (const auto& target : set.targets)
    for (const VertexStream& stream : target) visit(stream.elements);
}

}  // namespace

Buffer<Vec3f> vertex_positions(const VertexSet& set) {
  const Elements& elements = set.find("POSITION")->elements;
  const double unit = elements.format.unit();
  const double lowest = elements.format.normalized ? -1 : lowest_number(ComponentType::float32);
  Buffer<Vec3f> positions(set.count);
  const auto value = [&](uint64_t i, uint32_t component) {
    return static_cast<float>(std::max(elements.number(i, component) * unit, lowest));
  };
  for (uint64_t i = 0; i < set.count; ++i) {
    const bool is_float = elements.format.type == ComponentType::float32;
    const auto at = [&](uint32_t c) { return is_float ? static_cast<float>(elements.number(i, c)) : value(i, c); };
    positions[i] = {at(0), at(1), at(2)};
  }
  return positions;
}

std::vector<uint32_t> equal_vertices(const VertexSet& set) {
  std::vector<size_t> hashes(set.count);
  for_each_stream(set, [&](const Elements& elements) {
    for (uint64_t i = 0; i < set.count; ++i)
      hashes[i] = hashes[i] * 1099511628211U + std::hash<std::string_view>()(elements.element(i));
  });
  const auto are_equal = [&](uint32_t a, uint32_t b) {
    bool same = true;
    for_each_stream(set, [&](const Elements& elements) { same = same && elements.element(a) == elements.element(b); });
    return same;
  };
  std::vector<uint32_t> equal(set.count);
  std::unordered_map<size_t, uint32_t> first(set.count);
  for (uint32_t i = 0; i < set.count; ++i) {
    const auto [known, is_new] = first.emplace(hashes[i], i);
    equal[i] = is_new || !are_equal(known->second, i) ? i : known->second;
  }
  return equal;
}

}  // namespace papilio::proto::gltf
