#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "papilio/refine.h"
#include "proto/limits.h"
#include "proto/parameters.h"
#include "proto/shared_mesh.h"

// The pipeline from a Draco mesh, or a packed model, to a refined Draco mesh. Server and client share it, so local and
// remote results are byte-identical.

namespace papilio::proto {

/// Milliseconds spent in each stage so far.
struct StageTimes {
  double decode = 0, refine = 0, encode = 0;
};

/// Statistics of an encoded mesh.
struct Statistics {
  int level = 0;  ///< 0: the coarse mesh
  uint64_t vertices = 0, faces = 0;
  std::optional<StopReason> stop_reason;  ///< set for the last level only, like `error`
  double error = 0;                       ///< sum of Result::error and the error of the encoding's grid
  std::optional<double> error_pixels{};   ///< largest remaining deviation in pixels, with a view
  std::string unreached{};                ///< description of unreached targets (unreached.h)
  std::string shape{};                    ///< shapes found on the mesh (shape_text()); set for the last level only
  BuildReport found{};                    ///< findings in the coarse mesh
  StageTimes times;
};

/// Mesh as Draco, or scene as .glb, and its statistics.
struct EncodedLevel {
  std::string bytes;
  Statistics statistics;
};

/// Callbacks and threads of the caller. Both functions may be empty.
struct RefinementHooks {
  /// Receives every encoded level, coarse first; if empty, only the last is encoded. May throw to stop. With several
  /// threads a level is encoded and handed over while the next is refined. Calls do not overlap, but may come from
  /// another thread and concurrently with `cancelled`.
  std::function<void(const EncodedLevel&)> on_level{};
  /// Returns whether to stop; called every few milliseconds. Calls do not overlap, but may come from another thread. It
  /// may block in favour of other work; the time limit does not count that.
  std::function<bool()> cancelled{};
  int threads = 1;  ///< maximum number of threads
};

/// One refinement. The constructor decodes and checks, run() refines.
class Refinement {
 public:
  /// Decodes and checks the argument of decode_mesh(). Throws `Problem`, also if the result is certain to exceed a
  /// limit.
  Refinement(std::string_view bytes, const Parameters& parameters, const Limits& limits);
  /// Refines a cached mesh. Results are byte-identical to those from a stream.
  Refinement(std::shared_ptr<const SharedMesh> shared, const Parameters& parameters, const Limits& limits);

  [[nodiscard]] uint32_t coarse_faces() const { return coarse().mesh.topology.face_count(); }
  [[nodiscard]] uint32_t coarse_vertices() const { return coarse().mesh.topology.vertex_count; }
  [[nodiscard]] const BuildReport& found() const { return coarse().found; }

  /// Refines and encodes; call once. Returns the last level. Throws `Problem`, and what the hooks throw.
  [[nodiscard]] EncodedLevel run(const RefinementHooks& hooks = {});

 private:
  Refinement(const Parameters& parameters, const Limits& limits);
  /// Sets the options from the coarse mesh. Throws `Problem` if the result is certain to exceed a limit.
  void set_options(const Parameters& parameters, const Limits& limits);
  [[nodiscard]] const DecodedMesh& coarse() const { return shared_ ? shared_->decoded() : decoded_; }
  EncodedLevel run_core(const RefinementHooks& hooks);
  /// Encodes a level. `times`: time spent before.
  [[nodiscard]] EncodedLevel encode(const Mesh& mesh, int level, StageTimes times,
                                    const std::function<void()>& poll) const;
  /// Returns a copy of a level with normals of its own surface; nothing if the level itself is encoded.
  [[nodiscard]] std::optional<Mesh> with_normals(const Mesh& mesh, int level) const;
  void require_time() const;
  Result refine_coarse(const Hooks& hooks);

  Options options_;        ///< options of the core; their tolerance is what the encoding's grid leaves
  double tolerance_;       ///< requested tolerance
  double grid_error_ = 0;  ///< distance by which the grid moves positions, a share of the diagonal
  OutputOptions output_;
  /// Whether a mesh without normals gets them: by request, or because the original of a packed model had some.
  bool adds_normals_;
  AttributeEncoding encoding_;                ///< encoding of all levels
  DecodedMesh decoded_;                       ///< unused with `shared_`
  std::shared_ptr<const SharedMesh> shared_;  ///< null: `decoded_` is used
  StageTimes times_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::atomic<std::chrono::steady_clock::duration> waited_{};  ///< time in `RefinementHooks::cancelled`
  int most_seconds_;
};

/// Returns "converged", "levels", "budget" or "limits".
[[nodiscard]] std::string_view stop_reason_name(StopReason reason);
/// Returns the reason of a name; nothing for other text.
[[nodiscard]] std::optional<StopReason> stop_reason_named(std::string_view name);

/// Formats statistics as header fields: Papilio-Vertices, -Faces, -Levels, -Stop-Reason, -Error, -Error-Pixels,
/// -Unreached (if any target is), -Shape, -Found (defects of the mesh, "non_manifold_edges=2, ...", if there are any)
/// and Server-Timing.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> statistics_headers(const Statistics& statistics);
/// Formats the shapes found on a mesh: "mechanical: 7 of 11 components, 340 creases", "organic: 3 components", "plain".
/// Smoothing groups append ", 24 marked by smoothing groups".
[[nodiscard]] std::string shape_text(const ShapeReport& shape);
/// Formats statistics as a JSON object: vertices, faces, levels, stop_reason, error, error_pixels, unreached, shape,
/// found {...}, milliseconds {decode, refine, encode}.
[[nodiscard]] std::string statistics_json(const Statistics& statistics);

}  // namespace papilio::proto
