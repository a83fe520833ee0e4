#include "server/work.h"

#include <algorithm>

#include "papilio/refine.h"

namespace papilio::server {
namespace {

constexpr uint64_t per_coarse_face = 16;    ///< work of decoding and checking a face
constexpr uint64_t per_adaptive_face = 16;  ///< work of selecting, refining and encoding a face
constexpr uint64_t usual_growth = 16;       ///< faces of an adaptive result for one coarse face

bool is_uniform(Options options) {
  options.scheme = Scheme::red_green;
  options.levels = std::max(1, options.levels);
  return !uses_hierarchy(options);
}

}  // namespace

Work predicted_work(uint64_t coarse_faces, const Options& options, const proto::Limits& limits) {
  const uint64_t decoding = coarse_faces * per_coarse_face;
  if (options.levels == 0) return {decoding, decoding};
  uint64_t uniform = coarse_faces;
  for (int level = 0; level < options.levels; ++level) uniform *= 4;
  if (is_uniform(options)) {
    const uint64_t work =
        uniform <= limits.max_output_faces ? decoding + uniform : decoding;  // larger results are refused
    return {work, work};
  }
  uint64_t most = std::min(uniform, limits.max_output_faces);
  if (options.max_faces > 0) most = std::min(most, options.max_faces);
  const uint64_t expected = std::min(most, coarse_faces * usual_growth);
  return {decoding + expected * per_adaptive_face, decoding + most * per_adaptive_face};
}

}  // namespace papilio::server
