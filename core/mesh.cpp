#include "mesh.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <stdexcept>

#include "attributes.h"
#include "error.h"
#include "fan.h"
#include "weld.h"

namespace papilio {
namespace {

void check(const TriangleMesh& input) {
  const size_t points = input.positions.size();
  if (points >= none) throw Error(Fault::index_out_of_range, "The mesh has more points than 32 bits can number.");
  if (input.triangles.size() > face_count_limit)
    throw Error(Fault::result_too_large, "The mesh has more than 2^30 faces. Send fewer.");
  for (size_t f = 0; f < input.triangles.size(); ++f)
    for (uint32_t p : input.triangles[f])
      if (p >= points)
        throw Error(Fault::index_out_of_range, "Face " + std::to_string(f) + " names point " + std::to_string(p) +
                                                   ", but there are only " + std::to_string(points) + " points.");
  for (size_t p = 0; p < points; ++p) {
    const Vec3f v = input.positions[p];
    const auto usable = [](float c) { return std::abs(c) <= coordinate_limit; };  // false for NaN
    if (!usable(v.x) || !usable(v.y) || !usable(v.z))
      throw Error(Fault::not_finite, "Point " + std::to_string(p) +
                                         " has a coordinate that is NaN, infinite or beyond 1e18. Repair or rescale "
                                         "the mesh.");
  }
}

/// Half-edges sorted into edges: a run of half-edges between the same two vertices each.
struct EdgeRuns {
  std::vector<uint32_t> half_edges;  ///< [H] ordered by lower vertex, then higher vertex, then half-edge
  std::vector<uint32_t> starts;      ///< where each run starts; one more at the end
};

EdgeRuns sort_into_edges(const Topology& mesh) {
  const uint32_t count = mesh.half_edge_count();
  const auto lower = [&](uint32_t h) { return std::min(mesh.origin[h], mesh.tip(h)); };
  const auto higher = [&](uint32_t h) { return std::max(mesh.origin[h], mesh.tip(h)); };

  std::vector<uint32_t> bucket(mesh.vertex_count + 1, 0);
  for (uint32_t h = 0; h < count; ++h) ++bucket[lower(h) + 1];
  for (uint32_t v = 0; v < mesh.vertex_count; ++v) bucket[v + 1] += bucket[v];

  EdgeRuns runs;
  runs.half_edges.resize(count);
  std::vector<uint32_t> fill(bucket.begin(), bucket.end() - 1);
  for (uint32_t h = 0; h < count; ++h) runs.half_edges[fill[lower(h)]++] = h;

  runs.starts.reserve(count / 2 + 1);
  for (uint32_t v = 0; v < mesh.vertex_count; ++v) {
    const auto begin = runs.half_edges.begin() + bucket[v];
    const auto end = runs.half_edges.begin() + bucket[v + 1];
    std::sort(begin, end,
              [&](uint32_t a, uint32_t b) { return higher(a) != higher(b) ? higher(a) < higher(b) : a < b; });
    for (auto h = begin; h != end; ++h)
      if (h == begin || higher(*h) != higher(*(h - 1)))
        runs.starts.push_back(static_cast<uint32_t>(h - runs.half_edges.begin()));
  }
  runs.starts.push_back(count);
  return runs;
}

/// Drops each face that has the vertices and orientation of an earlier one. Only faces at edges that two
/// half-edges run along in one direction can repeat. Returns how many were dropped. `corner_point` [H] or empty.
uint32_t drop_repeated_faces(Topology& mesh, const EdgeRuns& runs, std::vector<uint32_t>& corner_point) {
  struct Candidate {
    Triangle rotated;  ///< starting at its lowest vertex
    uint32_t face;
  };
  std::vector<Candidate> candidates;
  for (size_t r = 0; r + 1 < runs.starts.size(); ++r) {
    const uint32_t begin = runs.starts[r];
    const uint32_t end = runs.starts[r + 1];
    uint32_t forward = 0;
    for (uint32_t k = begin; k < end; ++k)
      forward += mesh.origin[runs.half_edges[k]] < mesh.tip(runs.half_edges[k]) ? 1 : 0;
    if (forward < 2 && end - begin - forward < 2) continue;
    for (uint32_t k = begin; k < end; ++k) {
      uint32_t h = Topology::face(runs.half_edges[k]) * 3;
      for (int turn = 0; turn < 2 && mesh.origin[h] > std::min(mesh.tip(h), mesh.apex(h)); ++turn) ++h;
      candidates.push_back({{mesh.origin[h], mesh.tip(h), mesh.apex(h)}, Topology::face(h)});
    }
  }
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return a.rotated != b.rotated ? a.rotated < b.rotated : a.face < b.face;
  });
  std::vector<bool> repeated;
  uint32_t dropped = 0;
  for (size_t c = 1; c < candidates.size(); ++c) {
    if (candidates[c].rotated != candidates[c - 1].rotated || candidates[c].face == candidates[c - 1].face) continue;
    if (repeated.empty()) repeated.resize(mesh.face_count());
    if (!repeated[candidates[c].face]) ++dropped;
    repeated[candidates[c].face] = true;
  }
  if (dropped == 0) return 0;
  uint32_t kept = 0;
  for (uint32_t f = 0; f < repeated.size(); ++f) {
    if (repeated[f]) continue;
    std::copy_n(mesh.origin.begin() + 3 * f, 3, mesh.origin.begin() + 3 * kept);
    if (!corner_point.empty()) std::copy_n(corner_point.begin() + 3 * f, 3, corner_point.begin() + 3 * kept);
    ++kept;
  }
  mesh.origin.resize(size_t{3} * kept);
  if (!corner_point.empty()) corner_point.resize(mesh.origin.size());
  return dropped;
}

void connect(Topology& mesh, const EdgeRuns& runs, BuildReport& report) {
  const uint32_t count = mesh.half_edge_count();
  // Edges are numbered in the order of their first half-edge, so that they lie in memory as the faces do.
  std::vector<uint32_t> run_of(count, none);
  for (uint32_t r = 0; r + 1 < runs.starts.size(); ++r) run_of[runs.half_edges[runs.starts[r]]] = r;

  mesh.twin.assign(count, none);
  mesh.edge.resize(count);
  mesh.half_edge.reserve(runs.starts.size() - 1);
  mesh.kind.reserve(runs.starts.size() - 1);
  for (uint32_t first = 0; first < count; ++first) {
    if (run_of[first] == none) continue;
    const uint32_t begin = runs.starts[run_of[first]];
    const uint32_t size = runs.starts[run_of[first] + 1] - begin;
    const uint32_t second = size == 2 ? runs.half_edges[begin + 1] : none;
    EdgeKind kind = EdgeKind::shared;
    if (size == 1) {
      kind = EdgeKind::boundary;
      ++report.boundary_edges;
    } else if (size > 2) {
      ++report.non_manifold_edges;
    } else if (mesh.origin[first] == mesh.origin[second]) {
      ++report.misoriented_edges;
    } else {
      kind = EdgeKind::smooth;
      mesh.twin[first] = second;
      mesh.twin[second] = first;
    }
    for (uint32_t k = 0; k < size; ++k) mesh.edge[runs.half_edges[begin + k]] = mesh.edge_count();
    mesh.half_edge.push_back(first);
    mesh.kind.push_back(kind);
  }
}

}  // namespace

TriangleMesh Mesh::triangles() const {
  TriangleMesh out;
  const Array<uint32_t>& corners = attributes.empty() ? topology.origin : attributes.point;
  out.triangles.resize(topology.face_count());
  for (uint32_t f = 0; f < topology.face_count(); ++f)
    std::copy_n(corners.begin() + size_t{3} * f, 3, out.triangles[f].begin());
  if (attributes.empty()) {
    out.positions = positions;
    return out;
  }
  out.attributes = attributes.attributes;
  out.positions.resize(attributes.point_count);
  for (uint32_t h = 0; h < topology.half_edge_count(); ++h)
    out.positions[attributes.point[h]] = positions[topology.origin[h]];
  return out;
}

namespace {

Mesh build(const TriangleMesh& input, BuildReport* report) {
  check(input);
  BuildReport found;
  Mesh mesh;
  Topology& topology = mesh.topology;
  std::vector<uint32_t> corner_point;
  topology.origin = weld(input, mesh.positions, found, corner_point);
  topology.vertex_count = static_cast<uint32_t>(mesh.positions.size());

  EdgeRuns runs = sort_into_edges(topology);
  found.repeated_faces = drop_repeated_faces(topology, runs, corner_point);
  if (found.repeated_faces > 0) runs = sort_into_edges(topology);
  if (topology.origin.empty()) {
    throw Error(Fault::no_faces, input.triangles.empty()
                                     ? "The mesh has no faces. Send a triangle mesh."
                                     : "Every face of the mesh has two corners in one place, so there is no surface "
                                       "to refine. Check the mesh's scale and precision.");
  }
  connect(topology, runs, found);
  topology.pinched = find_pinched(topology);
  mesh.attributes = gather_attributes(input, topology, corner_point);
  found.pinched_vertices = static_cast<uint32_t>(topology.pinched.size());
  if (report != nullptr) *report = found;
  return mesh;
}

}  // namespace

Mesh build_mesh(const TriangleMesh& input, BuildReport* report) {
  try {
    return build(input, report);
  } catch (const std::bad_alloc&) {
    throw Error(Fault::out_of_memory, "There is not enough memory for this mesh. Send a smaller one.");
  } catch (const std::length_error&) {
    throw Error(Fault::out_of_memory, "There is not enough memory for this mesh. Send a smaller one.");
  }
}

std::vector<uint32_t> find_pinched(const Topology& mesh) {
  std::vector<uint32_t> corners(mesh.vertex_count, 0);
  std::vector<uint32_t> first(mesh.vertex_count, none);
  for (uint32_t h = mesh.half_edge_count(); h-- > 0;) {
    ++corners[mesh.origin[h]];
    first[mesh.origin[h]] = h;
  }
  std::vector<uint32_t> pinched;  // the fan of one corner leaves out another
  Fan fan;
  for (uint32_t v = 0; v < mesh.vertex_count; ++v) {
    collect_fan(mesh, first[v], fan);
    if (fan.valence() != corners[v]) pinched.push_back(v);
  }
  return pinched;
}

Topology connect_faces(Array<uint32_t> origin, uint32_t vertex_count) {
  Topology mesh;
  mesh.origin = std::move(origin);
  mesh.vertex_count = vertex_count;
  BuildReport report;
  connect(mesh, sort_into_edges(mesh), report);
  mesh.pinched = find_pinched(mesh);
  return mesh;
}

Box bounding_box(std::span<const Vec3f> positions) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  Box box{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
  for (const Vec3f& p : positions) {
    box.min = {std::min(box.min.x, p.x), std::min(box.min.y, p.y), std::min(box.min.z, p.z)};
    box.max = {std::max(box.max.x, p.x), std::max(box.max.y, p.y), std::max(box.max.z, p.z)};
  }
  return box;
}

double Box::diagonal() const { return min.x <= max.x ? length(to_double(max) - to_double(min)) : 0; }

}  // namespace papilio
