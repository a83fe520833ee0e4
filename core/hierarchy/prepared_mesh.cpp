#include "papilio/prepared_mesh.h"

#include <utility>

#include "base/memory_guard.h"
#include "criteria/view_culling.h"
#include "hierarchy/detail_levels.h"
#include "hierarchy/prepared_state.h"
#include "mesh/shape.h"

namespace papilio {
namespace {

uint64_t bytes_of(const KeptLevels& levels) {
  uint64_t bytes = 0;
  for (const auto& level : levels) bytes += level->bytes();
  return bytes;
}

}  // namespace

PreparedMesh::State::State(Mesh coarse, const Options& rules, uint64_t byte_budget)
    : rules_{.tension = rules.tension, .shape = rules.shape, .w = rules.w, .crease_angle = rules.crease_angle},
      budget_(byte_budget) {
  check_options(rules_);
  guard_memory([&] {
    shape_ = mark_shape(coarse, rules_);
    auto level = std::make_shared<HierarchyLevel>(coarsest_level(std::move(coarse)));
    level->longest = longest_edges(level->mesh);
    level->trial = try_level(*level, level->mesh, rules_, {.features = &level->features});
    level->trial.keep();
    kept_ = {std::move(level)};
    bytes_ = bytes_of(kept_);
  });
}

uint64_t PreparedMesh::State::bytes() const {
  const Lock lock(access_);
  return bytes_;
}

KeptLevels PreparedMesh::State::kept() const {
  const Lock lock(access_);
  return kept_;
}

void PreparedMesh::State::keep(KeptLevels levels) const {
  while (levels.size() > 1 && bytes_of(levels) > budget_) levels.pop_back();
  const uint64_t bytes = bytes_of(levels);
  const Lock lock(access_);
  kept_.swap(levels);  // the old levels are freed after the lock
  bytes_ = bytes;
}

PreparedMesh::PreparedMesh(Mesh coarse, const Options& rules, uint64_t byte_budget)
    : state_(std::make_unique<const State>(std::move(coarse), rules, byte_budget)) {}
PreparedMesh::~PreparedMesh() = default;

const Mesh& PreparedMesh::coarse() const { return state_->kept()[0]->mesh; }

bool PreparedMesh::suits(const Options& options) const {
  const Options& rules = state_->rules();
  return options.tension == rules.tension && options.shape == rules.shape && options.w == rules.w &&
         options.crease_angle == rules.crease_angle;
}

uint64_t PreparedMesh::bytes() const { return state_->bytes(); }

}  // namespace papilio
