#pragma once

#include <algorithm>
#include <string>

#include "papilio/refine.h"

namespace papilio {

/// What a scheme asks and tells while it works: cancellation, limits, levels. The last level is told by refine().
class Progress {
 public:
  /// Both must outlive this.
  Progress(const Options& options, const Hooks& hooks) : options_(options), hooks_(hooks) {}
  Progress(const Options& options, Hooks&& hooks) = delete;

  /// How many may work at once.
  [[nodiscard]] int threads() const { return hooks_.threads; }
  /// Whether to stop; may be empty.
  [[nodiscard]] const std::function<bool()>& cancelled() const { return hooks_.cancelled; }
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
  /// Whether a level of so many faces and bytes is within the limits.
  [[nodiscard]] bool has_room(uint64_t faces, uint64_t bytes) const {
    return faces <= face_limit() && (options_.memory_limit == 0 || bytes <= options_.memory_limit);
  }
  /// Throws `Error` result_too_large, with the number, when the level passes a limit.
  void require_room(uint64_t faces, uint64_t bytes, int level) const {
    if (has_room(faces, bytes)) return;
    const std::string what =
        faces > face_limit()
            ? "have " + std::to_string(faces) + " faces; the limit is " + std::to_string(face_limit())
            : "take " + mebibytes(bytes) + " of memory; the limit is " + mebibytes(options_.memory_limit);
    throw Error(Fault::result_too_large, "Level " + std::to_string(level) + " would " + what +
                                             ". Ask for fewer levels or refine less of the mesh.");
  }
  /// Whether the refinement ends before the level, because it passes a limit and the options ask for that.
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
