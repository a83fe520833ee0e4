#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "detail/base_attributes.h"
#include "detail/base_curves.h"
#include "detail/base_lift.h"
#include "detail/base_points.h"
#include "detail/collapse_sequence.h"
#include "detail/encode_pieces.h"
#include "detail/encode_values.h"
#include "detail/error_weights.h"
#include "detail/folds.h"
#include "detail/manifold_surface.h"
#include "detail/original_surface.h"
#include "detail/outcome.h"
#include "detail/own_normals.h"
#include "detail/placement.h"
#include "detail/residual_fit.h"
#include "detail/slivers.h"
#include "detail/step_search.h"
#include "detail/surface_distance.h"
#include "papilio/detail.h"
#include "papilio/error.h"

namespace papilio {
namespace {

/// Sizes of bases that are tried differ by this factor.
constexpr double size_ratio = 1.5;
constexpr uint32_t least_base_faces = 40;
/// Faces of the first base, times the wanted distance. Most of those tried need about so many.
constexpr double faces_at_distance = 0.06;
/// Faces of the last level that is tried first, and of that which is tried last, times the wanted distance.
constexpr double least_last_faces = 7, most_last_faces = 50;
/// Levels are added until exact residuals leave at most this share of the wanted distance; then as long as that pays,
/// but none where they leave less than the second share.
constexpr double largest_floor_of_trial = 0.8, floor_of_enough_levels = 0.4;
/// Step, in wanted distances: to look how fine a level is, and where the search of the step begins.
constexpr double fine_step = 1, first_step = 4;
constexpr int step_trials = 3, step_trials_at_last = 4;
/// A distance in this range, of the wanted one, needs no other step.
constexpr double least_share = 0.96;
constexpr int turns_of_trial = 2, turns_at_last = 5;  // a level
constexpr double rate_weight = 2;
constexpr int weighting_passes = 3;
/// Of a surface whose distance is measured in a trial: so many a face of the original, within bounds.
constexpr uint32_t samples_a_face = 2, least_samples = 5'000, most_samples = 20'000;
constexpr uint32_t samples_at_last = 3;  ///< for each of a trial
/// Larger bases that are tried where more samples show that a distance is not reached.
constexpr int most_last_bases = 3;
/// A finer step is taken, by halves, while so many of the faces are turned over, it turns back this share of them, and
/// there are at most so many times the bytes. Thin bevels of a truck at .1 %: 4.6 % more bytes, half of the folds.
constexpr double least_folds = 0.005, least_turned_back = 0.1, most_growth = 1.06;
/// Faces of another sheet are told from turned ones where their own is within so many wanted distances.
constexpr double sheet_reach = 2;
/// Vertices are parted by at most this share of the wanted distance.
constexpr double parting_share = 0.1;
/// Slivers of so small a share of the wanted distance are removed. No base could drop them: they turn at random, and
/// unfold to nothing.
constexpr double sliver_share = 0.1;

void check(const DetailOptions& options) {
  if (!(options.rms >= 1e-6 && options.rms <= 0.1))
    throw Error(Fault::bad_option, "The distance must be 1e-6 to 0.1 of the diagonal.", "rms");
  if (!(options.texcoord_step > 0 && options.texcoord_step <= coordinate_limit))
    throw Error(Fault::bad_option, "The step of texture coordinates must be above 0.", "texcoord_step");
  if (options.piece_bytes == 0) throw Error(Fault::bad_option, "Pieces must have bytes.", "piece_bytes");
}

/// A base of one size with its levels.
struct Trial {
  const BaseMesh* base = nullptr;
  CodedBase coded;
  std::vector<uint8_t> curves;  ///< of the base, coded
  LiftedBase lifted;            ///< empty once the trial is over
  int most_levels = 0;
  struct Choice {
    int levels = 0;
    double floor = 0;  ///< distance with fine steps
    double step = 0;   ///< found
    Outcome outcome;   ///< with that step
  } chosen;
};

class DetailEncoder {
 public:
  DetailEncoder(const TriangleMesh& triangles, const DetailOptions& options, const BaseCoder& code_base)
      : options_(options),
        code_base_(code_base),
        wanted_(options.rms * bounding_box(triangles.positions).diagonal()),
        original_(prepare(triangles)),
        samples_of_trial_(
            std::clamp(samples_a_face * original_.mesh().topology.face_count(), least_samples, most_samples)),
        first_step_(first_step * wanted_) {}

  EncodedDetail run() {
    size_t at = find_weights();
    for (const int direction : {-1, 1}) at = best_size(at, direction);
    progress(0.8);
    const Trial* best = nullptr;
    std::optional<ResidualFit> best_fit;
    for (int tried = 0; tried < most_last_bases; ++tried) {
      Trial& last = trial(at);
      lift(last);
      std::optional<ResidualFit> fit =
          find_step(last, turns_at_last, samples_at_last * samples_of_trial_, step_trials_at_last);
      if (best == nullptr || is_better_result(last.chosen.outcome, best->chosen.outcome)) {
        best = &last;
        best_fit.emplace(std::move(*fit));
      }
      if (last.chosen.outcome.is_reached || at == 0) break;
      --at;
    }
    turn_faces_back(*best, best_fit);
    return finish(*best, *best_fit);
  }

 private:
  Mesh prepare(const TriangleMesh& triangles) {
    ManifoldSurface surface = manifold_surface(triangles, parting_share * wanted_);
    parted_ = surface.parted;
    Mesh mesh = remove_slivers(std::move(surface.mesh), sliver_share * wanted_);
    require_manifold(mesh);
    normals_ = mark_detail_curves(mesh);
    require_whole_parts(mesh);
    return mesh;
  }
  void poll() const {
    if (options_.cancelled && options_.cancelled()) throw Error(Fault::cancelled, "Encoding was cancelled.");
  }
  [[nodiscard]] std::function<void()> poller() const {
    return [this] { poll(); };
  }
  void progress(double share) const {
    if (options_.on_progress) options_.on_progress(share);
  }

  /// Simplifies the original to bases of all sizes, the largest first. Vertices have more weight where first attempts
  /// are far from the original. Returns the number of the size to begin with.
  size_t find_weights() {
    const uint32_t faces = original_.mesh().topology.face_count();
    std::vector<uint32_t> sizes;
    double size = faces / 8.0;
    while (size >= least_base_faces) {
      sizes.push_back(static_cast<uint32_t>(size));
      size /= size_ratio;
    }
    if (sizes.empty()) sizes.push_back(std::min(least_base_faces, faces));
    size_t start = 0;
    while (start + 1 < sizes.size() && sizes[start + 1] >= faces_at_distance / options_.rms) ++start;

    collapse(sizes, start + 1, {});
    start = std::min(start, bases_.size() - 1);
    Trial trial = start_trial(start);
    while (start > 0 && trial.chosen.floor > largest_floor_of_trial * wanted_) trial = start_trial(--start);

    std::vector<float> weights, best_weights;
    choose(trial);
    first_step_ = trial.chosen.step;
    Outcome best = trial.chosen.outcome;
    for (int pass = 1; pass <= weighting_passes; ++pass) {
      progress(0.4 * pass / weighting_passes);
      weigh_errors(original_, fit(trial, fine_step * wanted_, 0).surface(static_cast<size_t>(trial.chosen.levels)),
                   weights);
      collapse(sizes, start + 1, weights);
      trial = start_trial(std::min(start, bases_.size() - 1));
      choose(trial);
      if (!is_better(trial.chosen.outcome, best)) continue;
      best = trial.chosen.outcome;
      best_weights = weights;
    }
    collapse(sizes, sizes.size(), best_weights);
    return std::min(start, bases_.size() - 1);
  }

  /// Simplifies to the first `count` sizes.
  void collapse(const std::vector<uint32_t>& sizes, size_t count, const std::vector<float>& weights) {
    sequence_ = std::make_unique<CollapseSequence>(original_.mesh(), weights);
    bases_.clear();
    for (size_t i = 0; i < count; ++i) {
      sequence_->collapse_to(sizes[i], poller());
      BaseMesh base = sequence_->base();
      if (!bases_.empty() && bases_.back().face.size() == base.face.size()) break;  // nothing is left to collapse
      bases_.push_back(std::move(base));
    }
  }

  /// Goes to larger (-1) or smaller (1) sizes, until two in a row are worse than the best.
  size_t best_size(size_t at, int direction) {
    size_t best = at;
    for (int worse = 0; worse < 2 && (direction > 0 ? at + 1 < bases_.size() : at > 0);) {
      at += static_cast<size_t>(direction);
      const bool is_best = is_better(trial(at).chosen.outcome, trial(best).chosen.outcome);
      worse = is_best ? 0 : worse + 1;
      if (is_best) best = at;
    }
    return best;
  }
  Trial& trial(size_t size) {
    const auto [found, is_new] = trials_.try_emplace(size);
    if (!is_new) return found->second;
    Trial& trial = found->second = start_trial(size);
    choose(trial);
    first_step_ = trial.chosen.step;
    trial.lifted = {};  // of all trials at once they would be most of the memory
    return trial;
  }

  /// Codes the base and finds how many levels it needs.
  [[nodiscard]] Trial start_trial(size_t size) {
    poll();
    const BaseMesh& base = bases_[size];
    Trial trial;
    trial.base = &base;
    trial.coded = code_base_(points_of_base(base, original_.mesh()));
    trial.most_levels = most_levels(base.face.size());
    lift(trial);
    trial.curves = encode_base_curves(trial.lifted.mesh.topology);
    Trial::Choice& chosen = trial.chosen;
    chosen.levels = 1;
    while (chosen.levels < trial.most_levels &&
           static_cast<double>(base.face.size() << (2 * chosen.levels)) * options_.rms < least_last_faces)
      ++chosen.levels;
    for (;; ++chosen.levels) {
      chosen.floor = floor_of(trial);
      if (chosen.levels == trial.most_levels || chosen.floor <= largest_floor_of_trial * wanted_) return trial;
    }
  }
  void lift(Trial& trial) const {
    trial.lifted = lift_base(*sequence_, *trial.base, trial.coded.triangles, original_, trial.most_levels, poller());
  }
  [[nodiscard]] double floor_of(const Trial& trial) const {
    return distance(fit(trial, fine_step * wanted_, 0), samples_of_trial_).rms;
  }

  /// Finds the step, and more levels as long as they are expected to take fewer bytes.
  void choose(Trial& trial) {
    find_step(trial, turns_of_trial, samples_of_trial_, step_trials);
    while (trial.chosen.levels < trial.most_levels && trial.chosen.floor > floor_of_enough_levels * wanted_) {
      const Trial::Choice before = trial.chosen;
      ++trial.chosen.levels;
      trial.chosen.floor = floor_of(trial);
      trial.chosen.outcome = {};
      find_step(trial, turns_of_trial, samples_of_trial_, step_trials);
      if (is_better(trial.chosen.outcome, before.outcome)) continue;
      trial.chosen = before;
      return;
    }
  }

  [[nodiscard]] int most_levels(size_t base_faces) const {
    const uint64_t original = original_.mesh().topology.face_count();
    const uint64_t most = std::min(options_.face_limit, std::max<uint64_t>(16 * original, 1000));
    int levels = 0;
    const auto faces = [&](int at) { return uint64_t{base_faces} << (2 * at); };
    while (levels < most_detail_levels && faces(levels + 1) <= most &&
           static_cast<double>(faces(levels)) * options_.rms < most_last_faces / 4)
      ++levels;
    return std::max(levels, 1);
  }

  [[nodiscard]] ResidualFit fit(const Trial& trial, double step, int turns_a_level) const {
    const StepSchedule steps{.last = static_cast<float>(step)};
    ResidualFit fit(original_, trial.lifted.mesh.positions,
                    place_on_original(original_, trial.lifted, trial.chosen.levels, steps, poller()), poller());
    fit.improve(turns_a_level * trial.chosen.levels, rate_weight);
    return fit;
  }

  [[nodiscard]] SurfaceDistance distance(const ResidualFit& fit, uint32_t samples) const {
    return surface_distance(original_.tree(), SurfaceTree(fit.surface(fit.level_count())), samples);
  }

  /// Finds the step that leaves the wanted distance.
  std::optional<ResidualFit> find_step(Trial& trial, int turns_a_level, uint32_t samples, int step_count) {
    if (trial.chosen.step == 0) trial.chosen.step = first_step_;
    std::optional<ResidualFit> best;
    double step = trial.chosen.step;
    for (int i = 0; i < step_count; ++i) {
      ResidualFit made = fit(trial, step, turns_a_level);
      const double rms = distance(made, samples).rms;
      const bool is_reached = rms <= wanted_;
      const bool is_coarser_step = is_reached && (!trial.chosen.outcome.is_reached || step >= trial.chosen.step);
      if (!best || is_coarser_step || (!is_reached && !trial.chosen.outcome.is_reached)) {
        trial.chosen.step = step;
        trial.chosen.outcome = {.rms = rms, .is_reached = is_reached};
        best.emplace(std::move(made));
      }
      if (is_reached && rms >= least_share * wanted_) break;
      step = expected_step(step, rms, trial.chosen.floor, wanted_);
    }
    const uint64_t streams = bytes_of(trial, *best);
    Outcome& outcome = trial.chosen.outcome;
    outcome.bytes = trial.coded.bytes + trial.curves.size() + streams;
    outcome.expected_bytes = trial.chosen.floor < wanted_ || outcome.is_reached
                                 ? static_cast<double>(outcome.bytes - streams) +
                                       static_cast<double>(streams) *
                                           expected_share(trial.chosen.step, outcome.rms, trial.chosen.floor, wanted_)
                                 : std::numeric_limits<double>::infinity();
    return best;
  }

  /// Bytes of the residuals.
  [[nodiscard]] static uint64_t bytes_of(const Trial& trial, const ResidualFit& fit) {
    uint64_t bytes = 0;
    const std::vector<uint32_t> whole(fit.level_count(), 1);
    for (const auto& level : fit.code(PieceOrder(trial.lifted.mesh), whole)) bytes += level[0].size();
    return bytes;
  }

  /// Takes finer steps where they turn faces back for few bytes.
  void turn_faces_back(const Trial& trial, std::optional<ResidualFit>& best) const {
    const auto folds_of = [&](const ResidualFit& fit) {
      const SurfaceTree surface(fit.surface(fit.level_count()));
      return count_folds(original_, surface, sheet_reach * wanted_) /
             static_cast<double>(surface.surface().triangles.size());
    };
    const uint64_t others = trial.coded.bytes + trial.curves.size();
    const double most_bytes = most_growth * static_cast<double>(others + bytes_of(trial, *best));
    double step = trial.chosen.step;
    for (double folds = folds_of(*best); folds >= least_folds;) {
      step /= 2;
      ResidualFit finer = fit(trial, step, turns_at_last);
      const double left = folds_of(finer);
      if (left > (1 - least_turned_back) * folds || static_cast<double>(others + bytes_of(trial, finer)) > most_bytes)
        return;
      folds = left;
      best.emplace(std::move(finer));
    }
  }

  [[nodiscard]] EncodedDetail finish(const Trial& trial, const ResidualFit& fit) const {
    EncodedDetail encoded;
    encoded.base = {trial.coded.triangles, trial.curves};
    encoded.parted = parted_;
    encoded.normals = normals_;
    encoded.bytes = trial.coded.bytes + trial.curves.size();
    add_levels(trial, fit, encoded);
    for (size_t l = 0; l <= encoded.levels.size(); ++l) {
      poll();
      const SurfaceTree surface(fit.surface(l));
      const SurfaceDistance d = surface_distance(original_.tree(), surface, samples_at_last * samples_of_trial_);
      const double largest = std::max(d.largest, vertex_distance(original_.tree(), surface));
      encoded.reach.push_back({d.rms / original_.diagonal(), largest / original_.diagonal()});
      if (l == encoded.levels.size()) encoded.folds = count_folds(original_, surface, sheet_reach * wanted_);
      progress(0.9 + 0.1 * static_cast<double>(l) / static_cast<double>(encoded.levels.size()));
    }
    return encoded;
  }

  void add_levels(const Trial& trial, const ResidualFit& fit, EncodedDetail& encoded) const {
    const PieceOrder order(trial.lifted.mesh);
    encoded.levels = encode_pieces(fit, order, options_.piece_bytes, [&](std::span<const uint32_t> piece_counts) {
      if (!has_values(trial.lifted.mesh.attributes.attributes)) return std::vector<CodedValues>{};
      return encode_values(original_, trial.lifted, *sequence_, *trial.base, fit.surface(fit.level_count()).positions,
                           static_cast<float>(options_.texcoord_step), order, piece_counts, poller());
    });
    for (const DetailStream& level : encoded.levels) {
      encoded.texcoord_bytes += level.texcoords.bytes.size();
      encoded.bytes += level.bytes.size() + level.texcoords.bytes.size();
    }
  }

  const DetailOptions& options_;
  const BaseCoder& code_base_;
  double wanted_;        ///< in the mesh's unit
  uint32_t parted_ = 0;  ///< vertices
  NormalStyle normals_{};
  OriginalSurface original_;
  uint32_t samples_of_trial_;
  double first_step_;  ///< to try
  std::unique_ptr<CollapseSequence> sequence_;
  std::vector<BaseMesh> bases_;
  std::map<size_t, Trial> trials_;
};

}  // namespace

EncodedDetail encode_detail(const TriangleMesh& original, const DetailOptions& options, const BaseCoder& code_base) {
  check(options);
  require_detail_attributes(without_normals(original.attributes));
  return DetailEncoder(original, options, code_base).run();
}

}  // namespace papilio
