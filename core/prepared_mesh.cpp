#include "prepared_mesh.h"

#include "crease.h"
#include "levels.h"
#include "memory_guard.h"
#include "transition.h"

namespace papilio {
namespace {

uint64_t bytes_of(const KeptLevels& levels) {
  uint64_t bytes = 0;
  for (const auto& level : levels) bytes += level->bytes();
  return bytes;
}

}  // namespace

PreparedMesh::PreparedMesh(Mesh coarse, const Options& rules, uint64_t byte_budget)
    : rules_{.tension = rules.tension, .w = rules.w, .crease_angle = rules.crease_angle}, budget_(byte_budget) {
  check_options(rules_);
  guard_memory([&] {
    mark_creases(coarse, rules_.crease_angle);
    smallest_angle_ = smallest_angle(coarse);
    auto level = std::make_shared<HierarchyLevel>(coarsest_level(std::move(coarse)));
    level->longest = longest_edges(level->mesh);
    level->trial = try_split(level->mesh, rules_, complete_edges(*level), {.features = &level->features});
    level->trial.keep_more(level->mesh.topology);
    kept_ = {std::move(level)};
    bytes_ = bytes_of(kept_);
  });
}

const Mesh& PreparedMesh::coarse() const { return kept()[0]->mesh; }

bool PreparedMesh::suits(const Options& options) const {
  return options.tension == rules_.tension && options.w == rules_.w && options.crease_angle == rules_.crease_angle;
}

uint64_t PreparedMesh::bytes() const {
  const std::lock_guard lock(access_);
  return bytes_;
}

KeptLevels PreparedMesh::kept() const {
  const std::lock_guard lock(access_);
  return kept_;
}

void PreparedMesh::keep(KeptLevels levels) const {
  while (levels.size() > 1 && bytes_of(levels) > budget_) levels.pop_back();
  const uint64_t bytes = bytes_of(levels);
  const std::lock_guard lock(access_);
  kept_.swap(levels);  // what was kept is given back after the lock
  bytes_ = bytes;
}

}  // namespace papilio
