#include "hierarchy/repair.h"

#include <algorithm>
#include <array>
#include <limits>

#include "hierarchy/move_bounds.h"

namespace papilio {
namespace {

/// Error of a candidate that is split at any threshold.
constexpr float largest_error = std::numeric_limits<float>::max();
/// Share of the allowed distance up to which sums of moves may be bounded loosely.
constexpr double share_known = 1.0 / 64;

}  // namespace

Splits splits_of(const std::vector<LevelChoice>& choices) {
  Splits splits;
  for (const LevelChoice& choice : choices) splits.push_back(choice.split_edges);
  return splits;
}

void set_splits(std::vector<LevelChoice>& choices, const Splits& splits) {
  for (size_t k = 0; k < choices.size(); ++k) {
    choices[k].split_nothing();
    if (k < splits.size()) choices[k].split_first(splits[k]);
  }
}

Repair::Repair(std::vector<LevelChoice>& choices, float threshold, AllowedDistance allowed, int level_count,
               const Progress& progress)
    : choices_(choices),
      threshold_(threshold),
      check_(choices, level_count, std::move(allowed), share_known, progress) {
  for (const LevelChoice& choice : choices) near_.emplace_back(choice.level->mesh.topology.face_count(), 0);
}

bool Repair::add_candidates() {
  const Buffer<LevelFace> far = check_.far_faces(near_);
  is_complete_ = far.empty();
  before_ = splits_of(choices_);
  bool has_any = false;
  for (const LevelFace& face : far) has_any |= add_candidates(face);
  return has_any;
}

bool Repair::add_candidates(const LevelFace& face) {
  constexpr double share_of_largest = 0.75;
  LevelChoice& choice = choices_[face.level];
  const uint32_t* edge = &choice.level->mesh.topology.edge[size_t{3} * face.face];
  std::array<double, 3> move{-1, -1, -1};
  for (uint32_t i = 0; i < 3; ++i)
    if (choice.region.has_edge[edge[i]] != 0 && choice.split[edge[i]] == 0) move[i] = move_bound(choice, edge[i], 0);
  const double largest = *std::ranges::max_element(move);
  if (largest < 0) return false;
  for (uint32_t i = 0; i < 3; ++i) {
    if (move[i] < share_of_largest * largest) continue;
    float& error = choice.error[edge[i]];
    if (error < threshold_) choice.candidates.push_back(edge[i]);
    error = largest_error;
  }
  return true;
}

void Repair::look_again() {
  for (size_t k = 0; k < choices_.size(); ++k) {
    const LevelChoice& choice = choices_[k];
    const Topology& mesh = choice.level->mesh.topology;
    Marks has_changed = choice.split;
    for (EdgeId e : before_[k]) has_changed[e] ^= 1U;  // a split that only kept slivers away may be gone
    Buffer<uint8_t> touched(mesh.vertex_count, 0);
    const auto touch = [&](EdgeId e) {
      touched[mesh.origin[mesh.half_edge[e]]] |= has_changed[e];
      touched[mesh.tip(mesh.half_edge[e])] |= has_changed[e];
    };
    for (EdgeId e : choice.split_edges) touch(e);
    for (EdgeId e : before_[k]) touch(e);
    for (FaceId f : choice.region.faces) {
      if (!is_touched(mesh, touched, f)) continue;
      near_[k][f] = 0;
      if (k > 0) near_[k - 1][choice.level->parent_of(f)] = 0;
    }
  }
}

}  // namespace papilio
