#include "simplify/simplify_check.h"

#include <algorithm>
#include <array>
#include <iterator>

#include "base/disjoint_sets.h"
#include "base/sort.h"
#include "mesh/normals.h"

namespace papilio {
namespace {

using Edge = std::array<uint32_t, 2>;

/// Returns the half-edges without a twin as sorted pairs (origin, tip), with vertices mapped by `number`.
template <class Number>
std::vector<Edge> open_half_edges(const Topology& mesh, const Number& number) {
  std::vector<Edge> open;
  for (uint32_t h = 0; h < mesh.half_edge_count(); ++h)
    if (mesh.twin[h] == none) open.push_back({number(mesh.origin[h]), number(mesh.tip(h))});
  sort_range(open);
  return open;
}

template <class Number>
std::vector<uint32_t> pinched_vertices(const Topology& mesh, const Number& number) {
  std::vector<uint32_t> pinched;
  for (uint32_t v : mesh.pinched) pinched.push_back(number(v));
  return pinched;
}

/// Returns whether the face shares two edges with a neighbour, and so lies on it.
bool is_folded(const Topology& mesh, uint32_t face) {
  const auto neighbour = [&](uint32_t h) { return mesh.twin[h] == none ? none : Topology::face(mesh.twin[h]); };
  const Triangle n{neighbour(3 * face), neighbour(3 * face + 1), neighbour(3 * face + 2)};
  return (n[0] != none && (n[0] == n[1] || n[0] == n[2])) || (n[1] != none && n[1] == n[2]);
}

/// Returns, sorted, the faces that have no normal, are folded, or are flipped: turned against the vertex normals of the
/// mesh before at each corner. Each starts at its lowest vertex.
template <class Number>
std::vector<Triangle> bad_faces(const Mesh& mesh, const Number& number, const Buffer<Vec3f>& vertex_normals) {
  const Topology& topology = mesh.topology;
  const Buffer<Vec3f> normals = face_normals(mesh);
  std::vector<Triangle> bad;
  for (uint32_t f = 0; f < topology.face_count(); ++f) {
    Triangle t{};
    for (uint32_t i = 0; i < 3; ++i) t[i] = number(topology.origin[3 * f + i]);
    const bool flipped = std::ranges::all_of(t, [&](uint32_t v) { return dot(normals[f], vertex_normals[v]) < 0; });
    if (has_normal(normals[f]) && !flipped && !is_folded(topology, f)) continue;
    std::rotate(t.begin(), std::ranges::min_element(t), t.end());
    bad.push_back(t);
  }
  sort_range(bad);
  return bad;
}

/// Returns one vertex of each component that has no vertex left.
std::vector<uint32_t> lost_components(const Topology& before, const std::vector<uint32_t>& kept) {
  DisjointSets components(before.vertex_count);
  for (uint32_t h = 0; h < before.half_edge_count(); ++h) components.join(before.origin[h], before.tip(h));
  std::vector<bool> alive(before.vertex_count);
  for (uint32_t v : kept) alive[components.find(v)] = true;
  std::vector<uint32_t> lost;
  for (uint32_t v = 0; v < before.vertex_count; ++v)
    if (components.find(v) == v && !alive[v]) lost.push_back(v);
  return lost;
}

void append(std::vector<uint32_t>& faults, uint32_t vertex) { faults.push_back(vertex); }

template <size_t N>
void append(std::vector<uint32_t>& faults, const std::array<uint32_t, N>& vertices) {
  faults.insert(faults.end(), vertices.begin(), vertices.end());
}

/// Appends the elements that are in only one of two sorted lists.
template <class Item>
void append_difference(const std::vector<Item>& before, const std::vector<Item>& after, std::vector<uint32_t>& faults) {
  std::vector<Item> difference;
  std::ranges::set_symmetric_difference(before, after, std::back_inserter(difference));
  for (const Item& item : difference) append(faults, item);
}

}  // namespace

std::vector<uint32_t> find_faults(const Mesh& before, const Collapsed& after, const std::function<void()>& poll) {
  const auto same = [](uint32_t v) { return v; };
  const auto old = [&](uint32_t v) { return after.vertex[v]; };
  std::vector<uint32_t> faults = lost_components(before.topology, after.vertex);
  poll();
  append_difference(open_half_edges(before.topology, same), open_half_edges(after.mesh.topology, old), faults);
  append_difference(pinched_vertices(before.topology, same), pinched_vertices(after.mesh.topology, old), faults);
  poll();

  const Buffer<Vec3f> normals = vertex_normals(before);
  poll();
  const std::vector<Triangle> bad_before = bad_faces(before, same, normals);
  poll();
  for (const Triangle& face : bad_faces(after.mesh, old, normals))
    if (!std::ranges::binary_search(bad_before, face)) append(faults, face);
  return faults;
}

}  // namespace papilio
