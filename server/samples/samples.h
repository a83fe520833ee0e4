#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "proto/limits.h"

namespace papilio::server {

/// Sample mesh of the server.
struct Sample {
  std::string name;  ///< name: 1 to 64 of [A-Za-z0-9._-]
  uint64_t vertices = 0, faces = 0;
  std::shared_ptr<const std::string> draco;
};

/// Generated samples (models.h) and the operator's own, in memory. Immutable and thread-safe.
class Samples {
 public:
  /// Reads the .drc files of `folder` as samples under their names without .drc; empty: none. Throws
  /// std::runtime_error, with the file, for a mesh that this server would refuse, or an invalid name.
  Samples(const std::string& folder, const proto::Limits& limits);

  /// Returns all samples: the generated ones first, then the others by name.
  [[nodiscard]] std::span<const Sample> all() const { return samples_; }
  /// Returns the sample of a name; null if there is none.
  [[nodiscard]] const Sample* find(std::string_view name) const;

 private:
  std::vector<Sample> samples_;
};

}  // namespace papilio::server
