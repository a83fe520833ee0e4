#include "proto/shared_mesh.h"

#include <algorithm>
#include <numeric>

#include "proto/draco_reader.h"
#include "proto/error_translation.h"

namespace papilio::proto {
namespace {

uint64_t bytes_of(const Mesh& mesh) {
  const Topology& t = mesh.topology;
  uint64_t words = t.origin.size() + t.twin.size() + t.edge.size() + t.half_edge.size() + t.pinched.size() +
                   3 * mesh.positions.size() + mesh.attributes.point.size();
  for (const Attribute& attribute : mesh.attributes.attributes) words += 2 * attribute.values.size();
  return 4 * words + t.kind.size();
}

}  // namespace

DecodedMesh decode_mesh(std::string_view draco, const Limits& limits) {
  DecodedMesh decoded;
  translate_errors([&] {
    FormattedMesh input = read_draco(draco, limits);
    decoded.mesh = build_mesh(input, &decoded.found, rounding_gap);
    decoded.attributes = attribute_encoding(decoded.mesh, std::move(input.format));
  });
  decoded.box = quantization_box(decoded.mesh.positions);
  return decoded;
}

SharedMesh::SharedMesh(std::string_view draco, const Limits& limits, uint64_t byte_budget)
    : decoded_(decode_mesh(draco, limits)), budget_(byte_budget) {}

std::shared_ptr<const papilio::PreparedMesh> SharedMesh::for_rules_of(const Options& options) const {
  if (CoreMesh found = find(options)) return found;
  // Computed outside the lock: concurrent first requests both compute it, and neither waits for the other.
  auto made = std::make_shared<const papilio::PreparedMesh>(decoded_.mesh, options, budget_);
  const std::lock_guard lock(access_);
  recent_.insert(recent_.begin(), made);
  return made;
}

SharedMesh::CoreMesh SharedMesh::find(const Options& options) const {
  const std::lock_guard lock(access_);
  const auto found = std::ranges::find_if(recent_, [&](const CoreMesh& mesh) { return mesh->suits(options); });
  if (found != recent_.end()) std::rotate(recent_.begin(), found, found + 1);
  uint64_t bytes = 0;
  const auto beyond =
      std::ranges::find_if(recent_, [&](const CoreMesh& mesh) { return (bytes += mesh->bytes()) > budget_; });
  const bool suits = found != recent_.end();
  if (beyond != recent_.end()) recent_.erase(std::max(beyond, recent_.begin() + (suits ? 1 : 0)), recent_.end());
  return suits ? recent_.front() : nullptr;
}

uint64_t SharedMesh::bytes() const {
  const std::lock_guard lock(access_);
  return std::accumulate(recent_.begin(), recent_.end(), bytes_of(decoded_.mesh),
                         [](uint64_t sum, const CoreMesh& mesh) { return sum + mesh->bytes(); });
}

}  // namespace papilio::proto
