#include "proto/prepared_meshes.h"

#include <algorithm>
#include <numeric>

#include "papilio/detail.h"

namespace papilio::proto {

std::shared_ptr<const PreparedMesh> PreparedMeshes::for_rules_of(const Mesh& coarse, const Options& options) const {
  if (Prepared found = find(options)) return found;
  // Computed outside the lock: concurrent first requests both compute it, and neither waits for the other.
  auto made = std::make_shared<const PreparedMesh>(coarse, options, budget_);
  const std::lock_guard lock(access_);
  recent_.insert(recent_.begin(), made);
  return made;
}

PreparedMeshes::Prepared PreparedMeshes::find(const Options& options) const {
  const std::lock_guard lock(access_);
  const auto found = std::ranges::find_if(recent_, [&](const Prepared& mesh) { return mesh->suits(options); });
  if (found != recent_.end()) std::rotate(recent_.begin(), found, found + 1);
  uint64_t bytes = 0;
  const auto beyond =
      std::ranges::find_if(recent_, [&](const Prepared& mesh) { return (bytes += mesh->bytes()) > budget_; });
  const bool suits = found != recent_.end();
  if (beyond != recent_.end()) recent_.erase(std::max(beyond, recent_.begin() + (suits ? 1 : 0)), recent_.end());
  return suits ? recent_.front() : nullptr;
}

uint64_t PreparedMeshes::bytes() const {
  const std::lock_guard lock(access_);
  return std::accumulate(recent_.begin(), recent_.end(), uint64_t{0},
                         [](uint64_t sum, const Prepared& mesh) { return sum + mesh->bytes(); });
}

uint64_t bytes_of(const Mesh& mesh) {
  const Topology& t = mesh.topology;
  uint64_t words = t.origin.size() + t.twin.size() + t.edge.size() + t.half_edge.size() + t.pinched.size() +
                   3 * mesh.positions.size() + mesh.attributes.point.size();
  for (const Attribute& attribute : mesh.attributes.attributes) words += 2 * attribute.values.size();
  return 4 * words + t.kind.size() + (mesh.detail ? mesh.detail->bytes() : 0);
}

}  // namespace papilio::proto
