#include "proto/prepared_mesh.h"

#include <algorithm>
#include <numeric>

#include "proto/draco_reader.h"
#include "proto/wire_words.h"

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
  in_words_of_the_wire([&] {
    FormattedMesh input = read_draco(draco, limits);
    decoded.mesh = build_mesh(input, &decoded.found);
    decoded.attributes = attribute_encoding(decoded.mesh, std::move(input.format));
  });
  decoded.box = quantization_box(decoded.mesh.positions);
  return decoded;
}

PreparedMesh::PreparedMesh(std::string_view draco, const Limits& limits, uint64_t byte_budget)
    : decoded_(decode_mesh(draco, limits)), budget_(byte_budget) {}

std::shared_ptr<const papilio::PreparedMesh> PreparedMesh::under_rules_of(const Options& options) const {
  if (UnderRules found = find(options)) return found;
  // Made outside of the lock: two that come at once both make it, and neither waits for the other.
  auto made = std::make_shared<const papilio::PreparedMesh>(decoded_.mesh, options, budget_);
  const std::lock_guard lock(access_);
  in_use_.insert(in_use_.begin(), made);
  return made;
}

PreparedMesh::UnderRules PreparedMesh::find(const Options& options) const {
  const std::lock_guard lock(access_);
  const auto found = std::ranges::find_if(in_use_, [&](const UnderRules& mesh) { return mesh->suits(options); });
  if (found != in_use_.end()) std::rotate(in_use_.begin(), found, found + 1);
  uint64_t bytes = 0;
  const auto beyond =
      std::ranges::find_if(in_use_, [&](const UnderRules& mesh) { return (bytes += mesh->bytes()) > budget_; });
  const bool suits = found != in_use_.end();
  if (beyond != in_use_.end()) in_use_.erase(std::max(beyond, in_use_.begin() + (suits ? 1 : 0)), in_use_.end());
  return suits ? in_use_.front() : nullptr;
}

uint64_t PreparedMesh::bytes() const {
  const std::lock_guard lock(access_);
  return std::accumulate(in_use_.begin(), in_use_.end(), bytes_of(decoded_.mesh),
                         [](uint64_t sum, const UnderRules& mesh) { return sum + mesh->bytes(); });
}

}  // namespace papilio::proto
