#include "mesh/attributes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>

#include "base/sort.h"
#include "papilio/error.h"

namespace papilio {
void check_attributes(const TriangleMesh& input) {
  for (size_t a = 0; a < input.attributes.size(); ++a) {
    const Attribute& attribute = input.attributes[a];
    if (attribute.values.size() != input.positions.size() * attribute.components)
      throw Error(Fault::index_out_of_range,
                  "Attribute " + std::to_string(a) + " has not as many values as the mesh has points.");
    if (!std::ranges::all_of(attribute.values, [](double v) { return std::isfinite(v); }))
      throw Error(Fault::not_finite, "Attribute " + std::to_string(a) +
                                         " (the first besides positions is 0) has a value that is NaN or infinite. "
                                         "Repair the mesh, or leave the attribute out.");
  }
}

namespace {

/// Compares the values of two points in lexicographic order; returns -1, 0 or 1.
int compare(const std::vector<Attribute>& attributes, uint32_t p, uint32_t q) {
  for (const Attribute& attribute : attributes) {
    const auto a = values_of(attribute, p);
    const auto b = values_of(attribute, q);
    for (size_t i = 0; i < a.size(); ++i)
      if (a[i] != b[i]) return a[i] < b[i] ? -1 : 1;
  }
  return 0;
}

/// Returns, for each point of the input, the lowest point of its vertex with equal values; `none` for points without
/// corners.
Buffer<uint32_t> merge_equal_points(const TriangleMesh& input, const Topology& mesh,
                                    const std::vector<uint32_t>& corner_point) {
  Buffer<uint32_t> vertex(input.positions.size(), none);
  Buffer<uint32_t> points;
  for (HalfEdgeId h = 0; h < mesh.half_edge_count(); ++h) {
    const uint32_t p = corner_point[h];
    if (vertex[p] == none) points.push_back(p);
    vertex[p] = mesh.origin[h];
  }
  sort_range(points, [&](uint32_t p, uint32_t q) {
    if (vertex[p] != vertex[q]) return vertex[p] < vertex[q];
    const int order = compare(input.attributes, p, q);
    return order != 0 ? order < 0 : p < q;
  });
  Buffer<uint32_t> same(input.positions.size(), none);
  for (size_t i = 0; i < points.size(); ++i) {
    const uint32_t p = points[i];
    const bool repeats =
        i > 0 && vertex[points[i - 1]] == vertex[p] && compare(input.attributes, points[i - 1], p) == 0;
    same[p] = repeats ? same[points[i - 1]] : p;
  }
  return same;
}

void append_mean(Attribute& attribute, uint32_t p, uint32_t q) {
  const size_t begin = attribute.values.size();
  double size = 0;
  for (uint32_t i = 0; i < attribute.components; ++i) {
    const double mean = 0.5 * values_of(attribute, p)[i] + 0.5 * values_of(attribute, q)[i];  // the sum may overflow
    attribute.values.push_back(mean);
    size += mean * mean;
  }
  if (!attribute.unit_length || size == 0) return;
  for (uint32_t i = 0; i < attribute.components; ++i) attribute.values[begin + i] /= std::sqrt(size);
}

}  // namespace

PointAttributes gather_attributes(const TriangleMesh& input, const Topology& mesh,
                                  const std::vector<uint32_t>& corner_point) {
  check_attributes(input);
  PointAttributes out;
  if (input.attributes.empty()) return out;
  const Buffer<uint32_t> same = merge_equal_points(input, mesh, corner_point);
  for (const Attribute& attribute : input.attributes)
    out.attributes.push_back({attribute.components,
                              attribute.unit_length,
                              {},
                              attribute.is_smoothing_group,
                              attribute.is_displacement && attribute.components == 3});

  Buffer<uint32_t> number(input.positions.size(), none);
  out.point.reserve(corner_point.size());
  for (uint32_t p : corner_point) {
    uint32_t& n = number[same[p]];
    if (n == none) {
      n = out.point_count++;
      for (size_t a = 0; a < out.attributes.size(); ++a) {
        const auto values = values_of(input.attributes[a], p);
        out.attributes[a].values.insert(out.attributes[a].values.end(), values.begin(), values.end());
      }
    }
    out.point.push_back(n);
  }
  return out;
}

Buffer<uint32_t> split_points(const Topology& mesh, const Marks& split, const IndexRange& faces,
                              PointAttributes& attributes, const Displacements& displaced) {
  Buffer<uint32_t> made(mesh.half_edge_count(), none);
  const Buffer<uint32_t>& point = attributes.point;
  const auto split_half_edge = [&](HalfEdgeId h) {
    if (split[mesh.edge[h]] == 0) return;
    const uint32_t p = point[h];
    const uint32_t q = point[h.next()];
    const HalfEdgeId t = mesh.twin[h];
    if (t != none && t < h && made[t] != none && !is_seam(mesh, attributes, h)) {
      made[h] = made[t];
      return;
    }
    made[h] = attributes.point_count++;
    for (Attribute& attribute : attributes.attributes) append_mean(attribute, p, q);
    for (const Displacement& displacement : displaced) {
      std::vector<double>& values = attributes.attributes[displacement.attribute].values;
      if (!displacement.given.empty())
        std::ranges::copy(displacement.given_at(h), values.end() - displacement.components);
      else if (const Vec3d at = displacement.at[mesh.edge[h]]; is_known(at))
        std::ranges::copy(std::array{at.x, at.y, at.z}, values.end() - 3);
    }
  };
  for (uint32_t i = 0; i < faces.size(); ++i)
    for (HalfEdgeId h = 3 * faces[i]; h < 3 * faces[i] + 3; ++h) split_half_edge(h);
  return made;
}

}  // namespace papilio
