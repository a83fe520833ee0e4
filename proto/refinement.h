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
#include "proto/prepared_mesh.h"

// The whole way from a Draco mesh to a refined Draco mesh. Server and client both go it, so local and remote
// results are the same bytes.

namespace papilio::proto {

/// Milliseconds spent in each stage so far.
struct StageTimes {
  double decode = 0, refine = 0, encode = 0;
};

/// What is known of a mesh on its way out.
struct Statistics {
  int level = 0;  ///< 0: the coarse mesh
  uint64_t vertices = 0, faces = 0;
  std::optional<StopReason> stop_reason;  ///< known with the last level, and so are the errors
  double error = 0;                       ///< the largest deviation left, as a share of the coarse mesh's diagonal
  std::optional<double> error_pixels{};   ///< the same in pixels, where there is a view
  std::string unreached{};                ///< targets that were not reached, in words (unreached.h)
  BuildReport found{};                    ///< in the coarse mesh
  StageTimes times;
};

/// A mesh and its statistics.
struct EncodedLevel {
  std::string draco;
  Statistics statistics;
};

/// How the caller takes part; both functions may be empty.
struct RefinementHooks {
  /// Every level encoded, the coarse one first, as it is made. Without it only the last is encoded. May throw
  /// to stop. With more than one thread a level is encoded, and this is called, beside the making of the next: one call
  /// at a time, but not always from the thread that runs it all, and while `cancelled` may be asked.
  std::function<void(const EncodedLevel&)> on_level{};
  /// Asked every few milliseconds: one call at a time, but not always from the thread that runs it all. It may wait, so
  /// that other work goes first: the time limit does not count that.
  std::function<bool()> cancelled{};
  int threads = 1;  ///< at most so many work on it at once
};

/// One refinement: decoded and checked when it is made, carried out by `run`.
class Refinement {
 public:
  /// Throws `Problem`, also where it is certain from the start that the result would pass a limit.
  Refinement(std::string_view draco, const Parameters& parameters, const Limits& limits);
  /// The same answers, to the byte, of a mesh that is refined more than once.
  Refinement(std::shared_ptr<const PreparedMesh> prepared, const Parameters& parameters, const Limits& limits);

  [[nodiscard]] uint32_t coarse_faces() const { return coarse().mesh.topology.face_count(); }
  [[nodiscard]] uint32_t coarse_vertices() const { return coarse().mesh.topology.vertex_count; }
  [[nodiscard]] const BuildReport& found() const { return coarse().found; }

  /// Refines and encodes; call once. Returns the last level. Throws `Problem`, and what the hooks throw.
  [[nodiscard]] EncodedLevel run(const RefinementHooks& hooks = {});

 private:
  Refinement(const Parameters& parameters, const Limits& limits);
  /// Once the coarse mesh is there. Throws `Problem` where the result is certain to pass a limit.
  void set_options(const Parameters& parameters, const Limits& limits);
  [[nodiscard]] const DecodedMesh& coarse() const { return prepared_ ? prepared_->decoded() : decoded_; }
  EncodedLevel run_core(const RefinementHooks& hooks);
  /// `times`: what was spent before.
  [[nodiscard]] EncodedLevel encode(const Mesh& mesh, int level, StageTimes times,
                                    const std::function<void()>& poll) const;
  void require_time() const;
  Result refine_coarse(const Hooks& hooks);

  Options options_;
  OutputOptions output_;
  DecodedMesh decoded_;                           ///< unless it is
  std::shared_ptr<const PreparedMesh> prepared_;  ///< prepared
  StageTimes times_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::atomic<std::chrono::steady_clock::duration> waited_{};  ///< in `RefinementHooks::cancelled`
  int most_seconds_;
};

/// "converged", "levels", "budget", "limits".
[[nodiscard]] std::string_view stop_reason_name(StopReason reason);
/// The other way round; nothing for any other text.
[[nodiscard]] std::optional<StopReason> stop_reason_named(std::string_view name);

/// The statistics as header fields: Papilio-Vertices, -Faces, -Levels, -Stop-Reason, -Error, -Error-Pixels, -Found
/// (defects of the mesh, "non_manifold_edges=2, ...", if there are any) and Server-Timing.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> statistics_headers(const Statistics& statistics);
/// The same as a JSON object: vertices, faces, levels, stop_reason, error, error_pixels, unreached, found {...},
/// milliseconds {decode, refine, encode}.
[[nodiscard]] std::string statistics_json(const Statistics& statistics);

}  // namespace papilio::proto
