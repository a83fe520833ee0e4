#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "proto/limits.h"

namespace papilio::server {

/// A mesh that the server has for trying things out.
struct Sample {
  std::string name;  ///< 1 to 64 of [A-Za-z0-9._-]
  uint64_t vertices = 0, faces = 0;
  std::shared_ptr<const std::string> draco;
};

/// All of them: two that are made by program (models.h), and the operator's own. Held in memory, never changed: threads
/// may share one object.
class Samples {
 public:
  /// `folder`: its .drc files become samples under their names without .drc; empty: none. Throws std::runtime_error,
  /// naming the file, where one is no mesh that this server would refine, or has a name that no sample can have.
  Samples(const std::string& folder, const proto::Limits& limits);

  /// The generated ones first, then the others by their names.
  [[nodiscard]] std::span<const Sample> all() const { return samples_; }
  /// Null where there is none of this name.
  [[nodiscard]] const Sample* find(std::string_view name) const;

 private:
  std::vector<Sample> samples_;
};

}  // namespace papilio::server
