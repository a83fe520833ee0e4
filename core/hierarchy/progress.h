#pragma once

#include <algorithm>
#include <string>

#include "papilio/refine.h"

namespace papilio {

/// Progress of a scheme: cancellation, limits and reports of levels. refine() reports the last level.
class Progress {
 public:
  /// Refers to both arguments, which must outlive this.
  Progress(const Options& options, const Hooks& hooks) : options_(options), hooks_(hooks) {}
  Progress(const Options& options, Hooks&& hooks) = delete;

  /// Returns the upper bound of the threads at work.
  [[nodiscard]] int threads() const { return hooks_.threads; }
  /// Returns the function that tells whether to stop; may be empty.
  [[nodiscard]] const std::function<bool()>& cancelled() const { return hooks_.cancelled; }
  [[nodiscard]] bool reports_levels() const { return static_cast<bool>(hooks_.on_level); }
  /// Reports a level that is not the last.
  void report(int level, const Mesh& mesh) const {
    if (hooks_.on_level) hooks_.on_level({level, mesh, false});
  }
  void report_last(int level, const Mesh& mesh) const {
    if (hooks_.on_level) hooks_.on_level({level, mesh, true});
  }
  /// Throws `Error` cancelled if the caller asked to stop.
  void poll() const {
    if (hooks_.cancelled && hooks_.cancelled()) throw Error(Fault::cancelled, "The caller asked to stop.");
  }
  /// Returns whether a level is within the limits.
  [[nodiscard]] bool has_room(uint64_t faces, uint64_t bytes) const {
    return faces <= face_limit() && (options_.memory_limit == 0 || bytes <= options_.memory_limit);
  }
  /// Throws `Error` result_too_large, with the number, if the level exceeds a limit.
  void require_room(uint64_t faces, uint64_t bytes, int level) const {
    if (has_room(faces, bytes)) return;
    const std::string what =
        faces > face_limit()
            ? "have " + std::to_string(faces) + " faces; the limit is " + std::to_string(face_limit())
            : "take " + mebibytes(bytes) + " of memory; the limit is " + mebibytes(options_.memory_limit);
    throw Error(Fault::result_too_large, "Level " + std::to_string(level) + " would " + what +
                                             ". Ask for fewer levels or refine less of the mesh.");
  }
  /// Returns whether the refinement stops before the level, which exceeds a limit (`Options::stop_at_limits`).
  [[nodiscard]] bool ends_before(uint64_t faces, uint64_t bytes) const {
    return options_.stop_at_limits && !has_room(faces, bytes);
  }

 private:
  [[nodiscard]] uint64_t face_limit() const { return std::min(options_.face_limit, face_count_limit); }
  static std::string mebibytes(uint64_t bytes) { return std::to_string(bytes >> 20) + " MiB"; }

  const Options& options_;
  const Hooks& hooks_;
};

}  // namespace papilio
