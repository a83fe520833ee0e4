#include "proto/gltf/scene.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "proto/draco_header.h"
#include "proto/gltf/extensions.h"
#include "proto/gltf/vertices.h"

namespace papilio::proto::gltf {
namespace {

constexpr uint64_t most_joints = 65536;

/// Returns the numbers of a member that is an array of `count`; nothing if it is absent.
template <size_t count>
std::optional<std::array<double, count>> numbers_member(const Json& of, const char* key, const std::string& where) {
  const Json* member = find_member(of, key, where);
  if (member == nullptr) return std::nullopt;
  std::array<double, count> numbers{};
  bool is_sound = member->is_array() && member->size() == count;
  for (size_t i = 0; is_sound && i < count; ++i) {
    is_sound = (*member)[i].is_number();
    if (is_sound) numbers[i] = (*member)[i].get<double>();
  }
  if (!is_sound) refuse_document(where + "." + key, "must be " + std::to_string(count) + " numbers");
  return numbers;
}

Affine affine_of_columns(const std::array<double, 16>& m) {
  return {{{{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}}}, {m[12], m[13], m[14]}};
}

Affine local_map(const Json& node, const std::string& where) {
  if (const auto matrix = numbers_member<16>(node, "matrix", where)) return affine_of_columns(*matrix);
  const auto t = numbers_member<3>(node, "translation", where).value_or(std::array<double, 3>{0, 0, 0});
  const auto s = numbers_member<3>(node, "scale", where).value_or(std::array<double, 3>{1, 1, 1});
  const auto r = numbers_member<4>(node, "rotation", where).value_or(std::array<double, 4>{0, 0, 0, 1});
  return affine_of({t[0], t[1], t[2]}, r, {s[0], s[1], s[2]});
}

/// Returns the maps of all nodes to the scene.
std::vector<Affine> world_maps(const Json& document) {
  const Json& nodes = array_of(document, "nodes");
  std::vector<uint32_t> parent(nodes.size(), none);
  for (uint32_t n = 0; n < nodes.size(); ++n) {
    const std::string where = place("nodes", n);
    const Json* children = find_member(nodes[n], "children", where);
    if (children == nullptr) continue;
    for (const Json& child : *children) {
      const bool is_sound = child.is_number_unsigned() && child.get<uint64_t>() < nodes.size();
      if (!is_sound || parent[child.get<size_t>()] != none)
        refuse_document(where, "has a child that does not exist, or is another node's");
      parent[child.get<size_t>()] = n;
    }
  }
  std::vector<Affine> maps(nodes.size());
  std::vector<uint8_t> is_done(nodes.size());
  for (uint32_t n = 0; n < nodes.size(); ++n) {
    std::vector<uint32_t> path;  // nodes upwards, to the first with a known map
    for (uint32_t at = n; at != none && is_done[at] == 0; at = parent[at]) {
      path.push_back(at);
      if (path.size() > nodes.size()) refuse_document(place("nodes", n), "is in its own subtree");
    }
    for (; !path.empty(); path.pop_back()) {
      const uint32_t at = path.back();
      const Affine local = local_map(nodes[at], place("nodes", at));
      maps[at] = parent[at] == none ? local : maps[parent[at]] * local;
      is_done[at] = 1;
    }
  }
  return maps;
}

std::vector<Affine> skin_maps(Views& views, const Json& skin, const std::vector<Affine>& worlds,
                              const std::string& where) {
  const Json* joints = find_member(skin, "joints", where);
  if (joints == nullptr || !joints->is_array()) refuse_document(where, "has no joints");
  require_within(joints->size(), most_joints, "joints in a skin");
  std::vector<Affine> maps;
  for (const Json& joint : *joints) {
    if (!joint.is_number_unsigned() || joint.get<uint64_t>() >= worlds.size())
      refuse_document(where, "has a joint that does not exist");
    maps.push_back(worlds[joint.get<size_t>()]);
  }
  if (const auto accessor = index_member(skin, "inverseBindMatrices", where)) {
    const Elements matrices = read_accessor(views, *accessor, most_joints, where);
    if (matrices.format.components != 16 || matrices.count < maps.size())
      refuse_document(where, "has other than one inverse bind matrix for each joint");
    for (size_t j = 0; j < maps.size(); ++j) {
      std::array<double, 16> m{};
      for (uint32_t c = 0; c < 16; ++c) m[c] = matrices.number(j, c);
      maps[j] = maps[j] * affine_of_columns(m);
    }
  }
  return maps;
}

/// Returns the maps of a node's instances relative to the node; the identity for a node without the extension.
std::vector<Affine> instance_maps(Views& views, const Json& node, const std::string& where) {
  const Json* instancing = find_extension(node, instancing_extension, where);
  if (instancing == nullptr) return {Affine{}};
  const Json* attributes = find_member(*instancing, "attributes", where);
  if (attributes == nullptr) refuse_document(where, "has instances without attributes");
  const auto read = [&](const char* name, uint32_t components) {
    std::optional<Elements> elements;
    if (const auto accessor = index_member(*attributes, name, where)) {
      elements = read_accessor(views, *accessor, most_instances, where);
      if (elements->format.components != components)
        refuse_document(where, std::string("has ") + name + " of an unknown format");
    }
    return elements;
  };
  const auto t = read("TRANSLATION", 3);
  const auto r = read("ROTATION", 4);
  const auto s = read("SCALE", 3);
  uint64_t count = most_instances;
  for (const auto* elements : {&t, &r, &s})
    if (*elements) count = std::min(count, (*elements)->count);
  if (!t && !r && !s) return {Affine{}};
  std::vector<Affine> maps;
  const auto vector = [](const std::optional<Elements>& of, uint64_t i, Vec3d otherwise) {
    return of ? Vec3d{of->number(i, 0), of->number(i, 1), of->number(i, 2)} : otherwise;
  };
  for (uint64_t i = 0; i < count; ++i) {
    std::array<double, 4> rotation{0, 0, 0, 1};
    for (uint32_t c = 0; r && c < 4; ++c) rotation[c] = r->number(i, c) * r->format.unit();
    maps.push_back(affine_of(vector(t, i, {}), rotation, vector(s, i, {1, 1, 1})));
  }
  return maps;
}

void extend(Box& box, Vec3d point) {
  if (!std::isfinite(point.x + point.y + point.z)) return;
  const Vec3f p = to_float(point);
  if (box.min.x > box.max.x) {
    box = {p, p};
    return;
  }
  box.min = {std::min(box.min.x, p.x), std::min(box.min.y, p.y), std::min(box.min.z, p.z)};
  box.max = {std::max(box.max.x, p.x), std::max(box.max.y, p.y), std::max(box.max.z, p.z)};
}

/// Calls `visit` with the joints of a vertex and their weights.
template <class Visit>
void for_each_joint(const VertexSet& set, uint64_t vertex, const Visit& visit) {
  for (int number = 0;; ++number) {
    const VertexStream* joints = set.find("JOINTS_" + std::to_string(number));
    const VertexStream* weights = set.find("WEIGHTS_" + std::to_string(number));
    if (joints == nullptr || weights == nullptr) return;
    const uint32_t most = std::min(joints->elements.format.components, weights->elements.format.components);
    for (uint32_t k = 0; k < most; ++k) {
      const double weight = weights->elements.number(vertex, k) * weights->elements.format.unit();
      if (weight > 0) visit(static_cast<size_t>(joints->elements.number(vertex, k)), weight);
    }
  }
}

void extend_by_skin(Box& box, const std::vector<Affine>& joints, const MeshGeometry& geometry) {
  for (const VertexSet& set : geometry.sets) {
    const Buffer<Vec3f> positions = vertex_positions(set);
    for (uint64_t i = 0; i < set.count; ++i) {
      Vec3d sum;
      double total = 0;
      for_each_joint(set, i, [&](size_t joint, double weight) {
        if (joint >= joints.size()) return;
        sum += weight * joints[joint].point(to_double(positions[i]));
        total += weight;
      });
      if (total > 0) extend(box, 1 / total * sum);
    }
  }
}

/// Upper bound of the vertices moved one by one; beyond it, the corners of the mesh's box are moved.
constexpr uint64_t most_moved_vertices = 10'000'000;

}  // namespace

Scene read_scene(Views& views) {
  const Json& document = views.document().json;
  const Json& nodes = array_of(document, "nodes");
  const std::vector<Affine> worlds = world_maps(document);
  Scene scene;
  scene.nodes = nodes.size();
  scene.instances.resize(array_of(document, "meshes").size());
  const Json& skins = array_of(document, "skins");
  for (size_t s = 0; s < skins.size(); ++s)
    scene.skins.push_back(skin_maps(views, skins[s], worlds, place("skins", s)));
  uint64_t count = 0;
  for (uint32_t n = 0; n < nodes.size(); ++n) {
    const std::string where = place("nodes", n);
    const auto mesh = index_member(nodes[n], "mesh", where);
    if (!mesh) continue;
    (void)element_of(document, "meshes", *mesh, where);
    const auto skin = index_member(nodes[n], "skin", where);
    if (skin) (void)element_of(document, "skins", *skin, where);
    for (const Affine& map : instance_maps(views, nodes[n], where)) {
      require_within(++count, most_instances, "showings of meshes", "Use fewer nodes.");
      scene.instances[*mesh].push_back({worlds[n] * map, skin});
    }
  }
  if (count == 0)
    for (auto& of_mesh : scene.instances) of_mesh.emplace_back();
  return scene;
}

std::vector<std::vector<Affine>> maps_of(const Scene& scene, uint32_t mesh, const MeshGeometry& geometry) {
  std::vector<std::vector<Affine>> maps;
  for (const Instance& instance : scene.instances[mesh]) {
    if (!instance.skin) {
      maps.push_back({instance.map});
      continue;
    }
    const std::vector<Affine>& joints = scene.skins[*instance.skin];
    std::set<size_t> used;
    for (const VertexSet& set : geometry.sets)
      for (uint64_t i = 0; i < set.count; ++i)
        for_each_joint(set, i, [&](size_t joint, double) {
          if (joint < joints.size()) used.insert(joint);
        });
    std::vector<Affine>& of_joints = maps.emplace_back();
    for (const size_t joint : used) of_joints.push_back(joints[joint]);
    if (of_joints.empty()) of_joints.push_back(instance.map);
  }
  return maps;
}

void extend_box(Box& box, const Scene& scene, uint32_t mesh, const MeshGeometry& geometry) {
  uint64_t vertices = 0;
  Buffer<Vec3f> points;
  for (const VertexSet& set : geometry.sets) {
    const Buffer<Vec3f> positions = vertex_positions(set);
    points.insert(points.end(), positions.begin(), positions.end());
    vertices += set.count;
  }
  if (vertices * scene.instances[mesh].size() > most_moved_vertices) {
    const Box own = bounding_box(points);
    points.clear();
    for (unsigned corner = 0; corner < 8; ++corner)
      points.push_back({(corner & 1U) != 0 ? own.max.x : own.min.x, (corner & 2U) != 0 ? own.max.y : own.min.y,
                        (corner & 4U) != 0 ? own.max.z : own.min.z});
  }
  for (const Instance& instance : scene.instances[mesh]) {
    if (instance.skin) {
      extend_by_skin(box, scene.skins[*instance.skin], geometry);
      continue;
    }
    for (const Vec3f& p : points) extend(box, instance.map.point(to_double(p)));
  }
}

}  // namespace papilio::proto::gltf
