#include "proto/detail/find_packed.h"

#include <algorithm>
#include <utility>

#include "proto/detail/packed_reader.h"
#include "proto/detail/turned_detail.h"
#include "proto/gltf/container.h"
#include "proto/gltf/scene_description.h"
#include "proto/problem.h"

namespace papilio::proto::detail {
namespace {

std::shared_ptr<const Detail> detail_of(PackedModel model) {
  std::vector<DetailStream> streams;
  streams.reserve(model.levels.size());
  for (PackedLevel& level : model.levels) streams.push_back(std::move(level.stream));
  return stream_detail({std::move(model.base), std::move(streams)});
}

}  // namespace

std::optional<PackedModel> find_packed(std::string_view bytes, const Limits& limits) {
  if (!gltf::is_glb(bytes) || !is_packed(bytes)) return std::nullopt;
  ReadOptions options{.limits = limits};
  options.limits.max_output_faces = face_count_limit;  // each refinement has its own limit
  const uint64_t faces = gltf::declared_faces(bytes);
  while (options.levels > 0 && faces > face_count_limit >> (2 * options.levels)) --options.levels;
  try {
    return read_packed(bytes, options);
  } catch (const Problem& problem) {
    if (problem.code() == Code::mesh_unsupported) return std::nullopt;
    throw;
  }
}

void attach_levels(Mesh& base, PackedModel model) { base.attach_detail(detail_of(std::move(model))); }

void attach_levels_turned_over(Mesh& base, PackedModel model) {
  base.attach_detail(turned_over(detail_of(std::move(model))));
}

void end_with_detail(Options& options, const Mesh& mesh) {
  if (options.stop_at_limits && mesh.detail) options.levels = std::min(options.levels, mesh.detail->level_count());
}

}  // namespace papilio::proto::detail
