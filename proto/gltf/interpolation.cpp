#include "proto/gltf/interpolation.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "proto/gltf/joint_weights.h"

namespace papilio::proto::gltf {
namespace {

using Vertices = RefinedVertices;

void copy_element(const Elements& from, uint32_t index, Elements& to, uint64_t at) {
  const std::string_view bytes = from.element(index);
  std::memcpy(&to.bytes[at * bytes.size()], bytes.data(), bytes.size());
}

double mean(const Elements& input, const Combination& of, uint32_t component) {
  double sum = 0;
  for (size_t i = 0; i < 3; ++i)
    if (of.weight[i] != 0) sum += of.weight[i] * input.number(of.vertex[i], component);
  return sum;
}

Elements interpolate(const Elements& input, const Vertices& vertices) {
  Elements out = zero_elements(input.format, vertices.size());
  for (size_t i = 0; i < vertices.size(); ++i) {
    const Combination& of = vertices[i].of;
    if (of.is_original())
      copy_element(input, of.vertex[0], out, i);
    else
      for (uint32_t c = 0; c < input.format.components; ++c) out.set_number(i, c, mean(input, of, c));
  }
  return out;
}

Elements take_nearest(const Elements& input, const Vertices& vertices) {
  Elements out = zero_elements(input.format, vertices.size());
  for (size_t i = 0; i < vertices.size(); ++i) copy_element(input, vertices[i].of.nearest(), out, i);
  return out;
}

std::array<double, 3> numbers_of(Vec3d v) { return {v.x, v.y, v.z}; }

/// Returns whether the type can store the vectors of all vertices.
template <class VectorOf>
bool holds_vectors(const ElementFormat& format, const Vertices& vertices, const VectorOf& vector_of) {
  if (format.type == ComponentType::float32) return true;
  const double low = lowest_number(format.type) - 0.5;
  const double high = highest_number(format.type) + 0.5;
  const auto fits = [&](double number) { return number / format.unit() > low && number / format.unit() < high; };
  for (size_t i = 0; i < vertices.size(); ++i)
    if (!std::ranges::all_of(numbers_of(vector_of(vertices[i])), fits)) return false;
  return true;
}

Vec3d position_of(const RefinedVertex& vertex) { return to_double(vertex.position); }

auto displacement_of(const RefinedTarget& target) {
  return [&target](const RefinedVertex& vertex) { return target.displacement[vertex.point]; };
}

/// Returns whether the vectors of elements_of(set) have one format in all sets, which can store the new vectors.
template <class ElementsOf, class VectorOf>
bool keep_format(const std::vector<Vertices>& vertices, const ElementsOf& elements_of, const VectorOf& vector_of) {
  const Elements* first = nullptr;
  for (size_t s = 0; s < vertices.size(); ++s) {
    const Elements* elements = elements_of(s);
    if (elements == nullptr) continue;
    if (first == nullptr) first = elements;
    if (elements->format != first->format || !holds_vectors(elements->format, vertices[s], vector_of)) return false;
  }
  return true;
}

/// Returns positions or displacements. Vertices of the input keep their bytes if the format is kept.
template <class VectorOf>
Elements vector_elements(const Elements& input, const Vertices& vertices, bool keeps_format,
                         const VectorOf& vector_of) {
  const ElementFormat format = keeps_format ? input.format : ElementFormat{ComponentType::float32, 3, false};
  Elements out = zero_elements(format, vertices.size());
  for (size_t i = 0; i < vertices.size(); ++i) {
    if (format == input.format && vertices[i].of.is_original()) {
      copy_element(input, vertices[i].of.vertex[0], out, i);
      continue;
    }
    const auto numbers = numbers_of(vector_of(vertices[i]));
    for (uint32_t c = 0; c < 3; ++c) out.set_number(i, c, numbers[c] / out.format.unit());
  }
  return out;
}

Elements normal_elements(const ElementFormat& format, const Vertices& vertices) {
  Elements out = zero_elements(format, vertices.size());
  for (size_t i = 0; i < vertices.size(); ++i) {
    const auto numbers = numbers_of(vertices[i].normal);
    for (uint32_t c = 0; c < 3; ++c) out.set_number(i, c, numbers[c] / format.unit());
  }
  return out;
}

/// Returns the direction of `tangent` in the plane perpendicular to `normal`; `tangent` itself if there is none.
Vec3d perpendicular(Vec3d tangent, Vec3d normal) {
  const Vec3d flat = tangent - dot(tangent, normal) * normal;
  const double size = length(flat);
  if (size > 0) return 1 / size * flat;
  const double whole = length(tangent);
  return whole > 0 ? 1 / whole * tangent : Vec3d{1, 0, 0};
}

Elements tangent_elements(const Elements& input, const Vertices& vertices, bool has_normals) {
  Elements out = zero_elements(input.format, vertices.size());
  const double unit = input.format.unit();
  for (size_t i = 0; i < vertices.size(); ++i) {
    const Combination& of = vertices[i].of;
    const Vec3d sum{mean(input, of, 0), mean(input, of, 1), mean(input, of, 2)};
    const auto numbers = numbers_of(perpendicular(sum, has_normals ? vertices[i].normal : Vec3d{}));
    for (uint32_t c = 0; c < 3; ++c) out.set_number(i, c, numbers[c] / unit);
    const double side = mean(input, of, 3) < 0 ? -1 : 1;
    out.set_number(i, 3, side / unit);
  }
  return out;
}

bool identifies(const VertexStream& stream) {
  const ElementFormat& format = stream.elements.format;
  if (stream.semantic.starts_with("_FEATURE_ID_")) return true;
  return stream.semantic.starts_with("_") && format.type != ComponentType::float32 && !format.normalized;
}

Elements interpolate_stream(const VertexStream& stream, const Vertices& vertices, bool keeps_position_format,
                            bool has_normals) {
  const uint32_t components = stream.elements.format.components;
  if (stream.semantic == "POSITION")
    return vector_elements(stream.elements, vertices, keeps_position_format, position_of);
  if (stream.semantic == "NORMAL" && components == 3) return normal_elements(stream.elements.format, vertices);
  if (stream.semantic == "TANGENT" && components == 4) return tangent_elements(stream.elements, vertices, has_normals);
  return identifies(stream) ? take_nearest(stream.elements, vertices) : interpolate(stream.elements, vertices);
}

Elements interpolate_target(const VertexStream& stream, const Vertices& vertices, const RefinedTarget& target,
                            bool keeps_format) {
  const Elements& input = stream.elements;
  if (input.format.components == 3 && stream.semantic == "POSITION")
    return vector_elements(input, vertices, keeps_format, displacement_of(target));
  if (input.format.components != 3 || stream.semantic != "NORMAL" || target.turn.empty())
    return interpolate(input, vertices);
  Elements out = zero_elements(input.format, vertices.size());
  for (size_t i = 0; i < vertices.size(); ++i) {
    const auto numbers = numbers_of(target.turn[vertices[i].point]);
    for (uint32_t c = 0; c < 3; ++c) out.set_number(i, c, numbers[c] / input.format.unit());
  }
  return out;
}

}  // namespace

KeptFormats find_kept_formats(const MeshGeometry& geometry, const std::vector<Vertices>& vertices,
                              const std::vector<RefinedTarget>& targets) {
  KeptFormats kept;
  kept.positions = keep_format(
      vertices, [&](size_t s) { return find_vectors(geometry.sets[s].attributes, "POSITION"); }, position_of);
  for (size_t t = 0; t < targets.size(); ++t) {
    const auto displacements = [&](size_t s) {
      const auto& of_set = geometry.sets[s].targets;
      return t < of_set.size() ? find_vectors(of_set[t], "POSITION") : nullptr;
    };
    kept.displacements.push_back(keep_format(vertices, displacements, displacement_of(targets[t])));
  }
  return kept;
}

VertexSet interpolate_vertices(const VertexSet& input, const Vertices& vertices,
                               const std::vector<RefinedTarget>& targets, const KeptFormats& kept, bool adds_normals) {
  VertexSet out;
  out.count = vertices.size();
  const VertexStream* normals = input.find("NORMAL");
  const bool has_normals = normals != nullptr || adds_normals;
  for (const VertexStream& stream : input.attributes)
    if (!is_joint_stream(input, stream.semantic))
      out.attributes.push_back(
          {stream.semantic, stream.accessor, interpolate_stream(stream, vertices, kept.positions, has_normals)});
  for (VertexStream& stream : interpolate_joints(input, vertices)) out.attributes.push_back(std::move(stream));
  if (normals == nullptr && adds_normals)
    out.attributes.push_back({"NORMAL", std::nullopt, normal_elements({ComponentType::float32, 3, false}, vertices)});
  for (size_t t = 0; t < input.targets.size(); ++t) {
    auto& streams = out.targets.emplace_back();
    for (const VertexStream& stream : input.targets[t])
      streams.push_back(
          {stream.semantic, stream.accessor, interpolate_target(stream, vertices, targets[t], kept.displacements[t])});
  }
  return out;
}

}  // namespace papilio::proto::gltf
