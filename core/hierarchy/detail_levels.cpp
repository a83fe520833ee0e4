#include "hierarchy/detail_levels.h"

#include <algorithm>

#include "mesh/normals.h"
#include "papilio/detail.h"

namespace papilio {

Trial try_level(const HierarchyLevel& level, const Mesh& coarse, const Options& options, const TrialContext& context,
                const std::function<bool()>& cancelled) {
  if (level.detail_levels == 0) return try_split(level.mesh, options, context);
  const std::span<const Vec3f> vertices =
      coarse.detail->new_vertices(coarse.detail->level_count() - level.detail_levels, cancelled);
  Trial trial{.normals = face_normals(level.mesh, context.threads)};
  trial.made.resize_for_overwrite(level.mesh.topology.edge_count());
  if (level.is_whole) {
    std::ranges::copy(vertices, trial.made.begin());
  } else {
    for (EdgeId e = 0; e < trial.made.size(); ++e) trial.made[e] = vertices[level.in_whole.edge[e]];
  }
  return trial;
}

namespace {

/// Returns a span of arrays as a span of their elements.
template <size_t Components>
std::span<const float> numbers_of(std::span<const std::array<float, Components>> values) {
  return values.empty() ? std::span<const float>{} : std::span(values[0].data(), values.size() * Components);
}

}  // namespace

void add_values_of_detail(const Mesh& mesh, const Detail& detail, int number, std::span<const uint32_t> parent,
                          Displacements& displaced, const std::function<bool()>& cancelled) {
  const std::vector<Attribute>& attributes = mesh.attributes.attributes;
  const auto add = [&](uint32_t components, std::span<const float> given) {
    if (given.empty()) return;
    for (auto a = static_cast<uint32_t>(attributes.size()); a-- > 0;) {
      if (attributes[a].components != components || attributes[a].unit_length) continue;
      displaced.push_back({a, {}, given, components, parent});
      return;
    }
  };
  add(2, numbers_of(detail.new_texcoords(number, cancelled)));
  add(3, numbers_of(detail.new_colours(number, cancelled)));
}

DecodedSize decoded_size(const Mesh& coarse, int level, const MemoryPlan& plan) {
  const uint64_t faces = uint64_t{coarse.topology.face_count()} << (2 * level);
  return {faces, plan.made(faces, level, 0)};
}

double largest_move_below(const Mesh& coarse, int first, const Options& options, const MemoryPlan& plan,
                          const Progress& progress) {
  double largest = 0;
  if (!coarse.detail) return largest;
  const int levels = std::min(options.levels, coarse.detail->level_count());
  for (int level = first; level < levels; ++level) {
    const DecodedSize size = decoded_size(coarse, level + 1, plan);
    if (!progress.has_room(size.faces, size.bytes)) break;
    largest = std::max(largest, coarse.detail->largest_move(level, progress.cancelled()));
  }
  return largest;
}

}  // namespace papilio
