#pragma once

#include <algorithm>
#include <string>

#include "refine.h"

namespace papilio {

/// What a scheme asks and tells while it works: cancellation, limits, levels. The last level is told by refine().
class Progress {
 public:
  Progress(const Options& options, const Hooks& hooks) : options_(options), hooks_(hooks) {}

  /// How many may work at once.
  [[nodiscard]] int threads() const { return hooks_.threads; }
  [[nodiscard]] bool wants_levels() const { return static_cast<bool>(hooks_.on_level); }
  /// A level that is not the last.
  void report(int level, const Mesh& mesh) const {
    if (hooks_.on_level) hooks_.on_level({level, mesh, false});
  }
  void report_last(int level, const Mesh& mesh) const {
    if (hooks_.on_level) hooks_.on_level({level, mesh, true});
  }
  /// Throws `Error` cancelled.
  void poll() const {
    if (hooks_.cancelled && hooks_.cancelled()) throw Error(Fault::cancelled, "The caller asked to stop.");
  }
  /// Throws `Error` result_too_large when a level of so many faces is not allowed.
  void require_room(uint64_t faces, int level) const {
    const uint64_t limit = std::min(options_.face_limit, face_count_limit);
    if (faces > limit)
      throw Error(Fault::result_too_large, "Level " + std::to_string(level) + " would have " + std::to_string(faces) +
                                               " faces; the limit is " + std::to_string(limit) +
                                               ". Ask for fewer levels or refine less of the mesh.");
  }
  /// Whether so many faces are certain to pass both of the others.
  [[nodiscard]] bool has_plenty(uint64_t faces, uint64_t bytes_per_face) const {
    return faces <= std::min(options_.face_limit, face_count_limit) &&
           (options_.memory_limit == 0 || faces * bytes_per_face <= options_.memory_limit);
  }
  /// Throws `Error` result_too_large when the level's arrays, so many faces of them, take too much memory.
  void require_memory(uint64_t faces, uint64_t bytes_per_face, int level) const {
    const uint64_t bytes = faces * bytes_per_face;
    if (options_.memory_limit > 0 && bytes > options_.memory_limit)
      throw Error(Fault::result_too_large, "Level " + std::to_string(level) + " would take " +
                                               std::to_string(bytes >> 20) + " MiB of memory; the limit is " +
                                               std::to_string(options_.memory_limit >> 20) +
                                               " MiB. Ask for fewer levels or refine less of the mesh.");
  }

 private:
  const Options& options_;
  const Hooks& hooks_;
};

}  // namespace papilio
