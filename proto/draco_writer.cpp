#include "proto/draco_writer.h"

#include <draco/core/draco_version.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "proto/draco_attributes.h"
#include "proto/edgebreaker/writer.h"
#include "proto/output_attribute.h"
#include "proto/problem.h"

namespace papilio::proto {
namespace {

constexpr double smallest_range = 1e-30;  // below, steps per unit overflow in Draco

}  // namespace

AttributeEncoding::Grid grid_of(const Attribute& attribute) {
  AttributeEncoding::Grid grid;
  double range = 0;
  for (uint32_t i = 0; i < attribute.components; ++i) {
    double low = attribute.values[i];
    double high = low;
    for (size_t k = i; k < attribute.values.size(); k += attribute.components) {
      low = std::min(low, attribute.values[k]);
      high = std::max(high, attribute.values[k]);
    }
    grid.origin.push_back(static_cast<float>(low));
    range = std::max(range, high - low);
  }
  if (range < smallest_range) range = 1;  // all values equal the origin
  if (range < static_cast<double>(std::numeric_limits<float>::max())) grid.range = static_cast<float>(range);
  return grid;
}

AttributeEncoding attribute_encoding(const Mesh& coarse, MeshFormat format) {
  AttributeEncoding encoding{std::move(format), {}};
  for (const Attribute& attribute : coarse.attributes.attributes) encoding.grids.push_back(grid_of(attribute));
  return encoding;
}

std::string write_draco(const Mesh& mesh, const QuantizationBox& box, const OutputOptions& options,
                        const AttributeEncoding& attributes, const std::function<void()>& poll) {
  return edgebreaker::write(mesh, box, options, attributes.format.position_id, output_attributes(mesh, attributes),
                            poll);
}

std::string write_draco_exact(const TriangleMesh& triangles, const MeshFormat& format) {
  const Mesh mesh = build_mesh(triangles);
  std::vector<OutputAttribute> attributes;
  if (!format.attributes.empty()) {
    const VertexPoints points(mesh);
    for (size_t a = 0; a < format.attributes.size(); ++a)
      attributes.push_back(exact_attribute(mesh.attributes.attributes[a], format.attributes[a], points));
  }
  return edgebreaker::write_exact(mesh, format.position_id, attributes);
}

std::string_view draco_version() { return draco::kDracoVersion; }

}  // namespace papilio::proto
