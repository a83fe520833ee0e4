#pragma once

#include <cstddef>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "proto/detail/pack.h"

namespace papilio::proto::detail {

/// Packed model of a surface, encoded for an RMS distance.
struct Encoding {
  double wanted_rms = 0;
  std::string glb{};
  PackedModel model{};             ///< model read back from the file
  uint32_t folds = 0, parted = 0;  ///< `EncodedDetail::folds` and `parted`
  double folded_area = 0;          ///< `EncodedDetail::folded_area`
};

/// Encoder of one surface at several distances. Encodings do not depend on each other or on the threads.
class Encodings {
 public:
  /// Refers to all arguments, which must outlive this. `materials`: argument of write_packed(). `most`: upper bound of
  /// the encodings, for the progress.
  Encodings(const TriangleMesh& surface, const gltf::Materials& materials, const PackOptions& options, size_t most);

  /// Encodes at each distance, up to `PackOptions::jobs` at once. Throws `Error` as encode_detail().
  [[nodiscard]] std::vector<Encoding> encode(std::span<const double> distances);
  /// Returns the number of encodings made so far.
  [[nodiscard]] size_t count() const { return count_; }

 private:
  [[nodiscard]] Encoding encode_at(double rms, size_t number);
  void show(size_t number, double share);

  const TriangleMesh& surface_;
  const gltf::Materials& materials_;
  const PackOptions& options_;
  double diagonal_;
  size_t count_ = 0;
  std::mutex access_;           ///< guards `shares_` and calls of `PackOptions::on_progress`
  std::vector<double> shares_;  ///< share done of each encoding
};

}  // namespace papilio::proto::detail
