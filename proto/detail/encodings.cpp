#include "proto/detail/encodings.h"

#include <algorithm>
#include <future>
#include <numeric>
#include <system_error>

#include "proto/detail/base_coder.h"
#include "proto/detail/packed_reader.h"
#include "proto/detail/packed_writer.h"

namespace papilio::proto::detail {
namespace {

/// Upper bound of a base vertex's move by its grid, in target RMS distances. On five pairs of model and distance, files
/// were 2 to 15 % smaller than with 0.25, and at most 1.3 % larger than with the best of 0.25, 0.5, 1, 2 and 4.
constexpr double base_move = 1;
/// The same along the surface, where moves leave the distance as it is. Files of three models were 2 to 5 % smaller.
constexpr double base_slide = 8;

}  // namespace

Encodings::Encodings(const TriangleMesh& surface, const gltf::Materials& materials, const PackOptions& options,
                     size_t most)
    : surface_(surface),
      materials_(materials),
      options_(options),
      diagonal_(bounding_box(surface.positions).diagonal()),
      shares_(std::max(most, size_t{1})) {}

std::vector<Encoding> Encodings::encode(std::span<const double> distances) {
  std::vector<Encoding> made(distances.size());
  const size_t at_once = static_cast<size_t>(std::max(options_.jobs, 1));
  for (size_t first = 0; first < distances.size(); first += at_once) {
    const size_t end = std::min(first + at_once, distances.size());
    std::vector<std::future<void>> others;  // their destructors wait
    others.reserve(at_once);
    const auto encode_one = [&](size_t i) { made[i] = encode_at(distances[i], count_ + i); };
    std::vector<size_t> own{first};
    for (size_t i = first + 1; i < end; ++i) {
      try {
        others.push_back(std::async(std::launch::async, encode_one, i));
      } catch (const std::system_error&) {
        own.push_back(i);  // the system has no more threads
      }
    }
    for (const size_t i : own) encode_one(i);
    for (std::future<void>& other : others) other.get();
  }
  count_ += distances.size();
  return made;
}

Encoding Encodings::encode_at(double rms, size_t number) {
  DracoBaseCoder coder(base_move * rms * diagonal_, base_slide * rms * diagonal_);
  const DetailOptions options{.rms = rms,
                              .face_limit = options_.face_limit,
                              .piece_bytes = options_.piece_bytes,
                              .cancelled = options_.cancelled,
                              .on_progress = [this, number](double share) { show(number, share); }};
  const EncodedDetail encoded = encode_detail(
      surface_, options,
      [&](const TriangleMesh& base, std::span<const Vec3d> normals) { return coder.code(base, normals); });
  Encoding made{
      .wanted_rms = rms, .folds = encoded.folds, .parted = encoded.parted, .folded_area = encoded.folded_area};
  made.glb = write_packed(encoded, coder.streams_of(encoded.base.triangles), materials_);
  made.model = read_packed(made.glb, {.limits = {face_count_limit, face_count_limit, face_count_limit}});
  show(number, 1);
  return made;
}

void Encodings::show(size_t number, double share) {
  if (!options_.on_progress) return;
  const std::lock_guard lock(access_);
  if (number >= shares_.size()) return;
  shares_[number] = std::max(shares_[number], share);
  options_.on_progress(std::accumulate(shares_.begin(), shares_.end(), 0.0) / static_cast<double>(shares_.size()));
}

}  // namespace papilio::proto::detail
