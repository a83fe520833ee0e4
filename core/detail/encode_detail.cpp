#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "base/poller.h"
#include "detail/base_attributes.h"
#include "detail/base_curves.h"
#include "detail/base_lift.h"
#include "detail/base_points.h"
#include "detail/collapse_sequence.h"
#include "detail/distant_points.h"
#include "detail/encode_pieces.h"
#include "detail/encode_values.h"
#include "detail/error_weights.h"
#include "detail/face_order.h"
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

/// Factor between the sizes of candidate bases.
constexpr double size_ratio = 1.5;
constexpr uint32_t least_base_faces = 40;
/// Faces of the first candidate base, times the target distance: what most models need.
constexpr double faces_at_distance = 0.06;
/// Bounds of the faces of the last level, times the target distance.
constexpr double least_last_faces = 7, most_last_faces = 50;
/// Upper bound of the distance that exact residuals leave, a share of the target: levels are added until it holds.
/// Below the second share no more levels are added; between both, as long as that saves bytes.
constexpr double largest_floor_of_candidate = 0.8, floor_of_enough_levels = 0.4;
/// Steps, in target distances: to measure the floor of a level, and to start the search for the step.
constexpr double fine_step = 1, first_step = 4;
constexpr int attempts_of_candidate = 3, attempts_at_last = 4;
/// Lower bound of a distance that ends the search for the step, a share of the target.
constexpr double least_share_of_target = 0.96;
constexpr int turns_of_candidate = 2, turns_at_last = 5;  // turns per level
/// Distance beyond which points of the original are distant at the end, in target distances.
constexpr double distance_of_distant = 8;
constexpr double rate_weight = 2;
constexpr int weighting_passes = 3;
/// Samples for the distance of a candidate, per face of the original, and their bounds.
constexpr uint32_t samples_of_candidate_a_face = 2, least_samples = 5'000, most_samples = 20'000;
constexpr uint32_t samples_at_last = 3;  ///< factor of the samples at the end
/// Upper bound of the bases at the end, the larger ones if more samples show that the distance is not reached.
constexpr int most_last_bases = 3;
/// Distance within which another sheet is told from a turned face, in target distances.
constexpr double sheet_reach = 2;
/// Upper bound of the distance by which vertices are separated, a share of the target distance.
constexpr double parting_share = 0.1;
/// Size of removed slivers, a share of the target distance. Collapses cannot remove them: their normals are random, and
/// they unfold to nothing. With 0.1, a scan from marching cubes took 2.4 times as many bytes.
constexpr double sliver_size = 0.5;

void check(const DetailOptions& options) {
  if (!(options.rms >= 1e-6 && options.rms <= 0.1))
    throw Error(Fault::bad_option, "The distance must be 1e-6 to 0.1 of the diagonal.", "rms");
  if (!(options.texcoord_step > 0 && options.texcoord_step <= coordinate_limit))
    throw Error(Fault::bad_option, "The step of texture coordinates must be above 0.", "texcoord_step");
  if (options.piece_bytes == 0) throw Error(Fault::bad_option, "Pieces must have bytes.", "piece_bytes");
}

/// Effort of the search for a step.
struct Effort {
  int turns_a_level = 0;
  uint32_t samples = 0;
  int attempts = 0;
  bool reaches_distant = false;
};

/// Base of one size with its levels.
struct CandidateBase {
  const BaseMesh* base = nullptr;
  CodedBase coded;
  std::vector<uint8_t> curves;  ///< coded curves of the base
  LiftedBase lifted;            ///< empty once the choice is made
  int most_levels = 0;
  struct Choice {
    int levels = 0;
    double floor = 0;  ///< distance with fine steps
    double step = 0;   ///< step of the last level
    Outcome outcome;   ///< outcome with `step`
  } chosen;
};

class DetailEncoder {
 public:
  DetailEncoder(const TriangleMesh& triangles, const DetailOptions& options, const BaseCoder& code_base)
      : options_(options),
        poller_([&options] {
          if (options.cancelled && options.cancelled()) throw Error(Fault::cancelled, "Encoding was cancelled.");
        }),
        code_base_(code_base),
        wanted_(options.rms * bounding_box(triangles.positions).diagonal()),
        original_(prepare(triangles)),
        samples_of_candidate_(std::clamp(samples_of_candidate_a_face * original_.mesh().topology.face_count(),
                                         least_samples, most_samples)),
        first_step_(first_step * wanted_) {}

  EncodedDetail run() {
    size_t at = find_weights();
    for (const int direction : {-1, 1}) at = best_size(at, direction);
    progress(0.8);
    const CandidateBase* best = nullptr;
    std::optional<ResidualFit> best_fit;
    for (int tried = 0; tried < most_last_bases; ++tried) {
      CandidateBase& last = candidate(at);
      lift(last);
      std::optional<ResidualFit> fit =
          find_step(last, {turns_at_last, samples_at_last * samples_of_candidate_, attempts_at_last, true});
      if (best == nullptr || is_better_result(last.chosen.outcome, best->chosen.outcome)) {
        best = &last;
        best_fit.emplace(std::move(*fit));
      }
      if (last.chosen.outcome.is_reached || at == 0) break;
      --at;
    }
    return finish(*best, std::move(*best_fit));
  }

 private:
  Mesh prepare(const TriangleMesh& triangles) {
    TriangleMesh input = build_mesh(triangles).triangles();
    ManifoldSurface surface = manifold_surface(triangles, parting_share * wanted_);
    parted_ = surface.parted;
    TriangleMesh whole = remove_slivers(std::move(surface.mesh), sliver_size * wanted_, poller_).triangles();
    if (whole != input) input_.emplace(std::move(input));
    Mesh mesh = build_mesh(along_morton_curve(std::move(whole)));
    require_manifold(mesh);
    normals_ = mark_detail_curves(mesh);
    require_whole_parts(mesh);
    return mesh;
  }
  /// Returns the surface to which distances are measured.
  [[nodiscard]] const SurfaceTree& input() const { return input_ ? *input_ : original_.tree(); }
  void progress(double share) const {
    if (options_.on_progress) options_.on_progress(share);
  }

  /// Simplifies the original to bases of all sizes, the largest first. Raises weights of vertices where first
  /// candidates are far from the original. Returns the number of the size to start with.
  size_t find_weights() {
    const uint32_t faces = original_.mesh().topology.face_count();
    std::vector<uint32_t> sizes;
    double size = std::min(faces / 8.0, static_cast<double>(options_.face_limit) / 4);
    while (size >= least_base_faces) {
      sizes.push_back(static_cast<uint32_t>(size));
      size /= size_ratio;
    }
    if (sizes.empty()) sizes.push_back(std::min(least_base_faces, faces));
    size_t start = 0;
    while (start + 1 < sizes.size() && sizes[start + 1] >= faces_at_distance / options_.rms) ++start;

    collapse(sizes, start + 1, {});
    start = std::min(start, bases_.size() - 1);
    CandidateBase candidate = start_candidate(start);
    while (start > 0 && candidate.chosen.floor > largest_floor_of_candidate * wanted_)
      candidate = start_candidate(--start);

    std::vector<float> weights, best_weights;
    choose(candidate);
    first_step_ = candidate.chosen.step;
    Outcome best = candidate.chosen.outcome;
    for (int pass = 1; pass <= weighting_passes; ++pass) {
      progress(0.4 * pass / weighting_passes);
      weigh_errors(original_,
                   fit(candidate, fine_step * wanted_, 0).surface(static_cast<size_t>(candidate.chosen.levels)),
                   weights, poller_);
      collapse(sizes, start + 1, weights);
      candidate = start_candidate(std::min(start, bases_.size() - 1));
      choose(candidate);
      if (!is_better(candidate.chosen.outcome, best)) continue;
      best = candidate.chosen.outcome;
      best_weights = weights;
    }
    collapse(sizes, sizes.size(), best_weights);
    return std::min(start, bases_.size() - 1);
  }

  /// Simplifies to the first `count` sizes.
  void collapse(const std::vector<uint32_t>& sizes, size_t count, const std::vector<float>& weights) {
    sequence_ = std::make_unique<CollapseSequence>(original_.mesh(), weights, poller_);
    bases_.clear();
    for (size_t i = 0; i < count; ++i) {
      sequence_->collapse_to(sizes[i], poller_);
      BaseMesh base = sequence_->base();
      if (!bases_.empty() && bases_.back().face.size() == base.face.size()) break;  // no collapse is left
      bases_.push_back(std::move(base));
    }
  }

  /// Searches larger (-1) or smaller (1) sizes, until two in a row are worse than the best.
  size_t best_size(size_t at, int direction) {
    size_t best = at;
    for (int worse = 0; worse < 2 && (direction > 0 ? at + 1 < bases_.size() : at > 0);) {
      at += static_cast<size_t>(direction);
      const bool is_best = is_better(candidate(at).chosen.outcome, candidate(best).chosen.outcome);
      worse = is_best ? 0 : worse + 1;
      if (is_best) best = at;
    }
    return best;
  }
  CandidateBase& candidate(size_t size) {
    const auto [found, is_new] = candidates_.try_emplace(size);
    if (!is_new) return found->second;
    CandidateBase& candidate = found->second = start_candidate(size);
    choose(candidate);
    first_step_ = candidate.chosen.step;
    candidate.lifted = {};  // the lifted bases of all candidates would take most of the memory
    return candidate;
  }

  /// Codes the base, and finds the number of levels that it needs.
  [[nodiscard]] CandidateBase start_candidate(size_t size) {
    poller_.now();
    const BaseMesh& base = bases_[size];
    CandidateBase candidate;
    candidate.base = &base;
    candidate.coded = code_base_(points_of_base(base, original_.mesh()), sliding_normals(base, original_));
    candidate.most_levels = most_levels(base.face.size());
    lift(candidate);
    candidate.curves = encode_base_curves(candidate.lifted.mesh.topology);
    CandidateBase::Choice& chosen = candidate.chosen;
    chosen.levels = 1;
    while (chosen.levels < candidate.most_levels &&
           static_cast<double>(base.face.size() << (2 * chosen.levels)) * options_.rms < least_last_faces)
      ++chosen.levels;
    for (;; ++chosen.levels) {
      chosen.floor = floor_of(candidate);
      if (chosen.levels == candidate.most_levels || chosen.floor <= largest_floor_of_candidate * wanted_)
        return candidate;
    }
  }
  void lift(CandidateBase& candidate) const {
    candidate.lifted =
        lift_base(*sequence_, *candidate.base, candidate.coded, original_, candidate.most_levels, poller_);
  }
  [[nodiscard]] double floor_of(const CandidateBase& candidate) const {
    return distance(fit(candidate, fine_step * wanted_, 0), samples_of_candidate_).rms;
  }

  /// Finds the step, and adds levels as long as they are expected to save bytes.
  void choose(CandidateBase& candidate) {
    find_step(candidate, {turns_of_candidate, samples_of_candidate_, attempts_of_candidate});
    while (candidate.chosen.levels < candidate.most_levels &&
           candidate.chosen.floor > floor_of_enough_levels * wanted_) {
      const CandidateBase::Choice before = candidate.chosen;
      ++candidate.chosen.levels;
      candidate.chosen.floor = floor_of(candidate);
      candidate.chosen.outcome = {};
      find_step(candidate, {turns_of_candidate, samples_of_candidate_, attempts_of_candidate});
      if (is_better(candidate.chosen.outcome, before.outcome)) continue;
      candidate.chosen = before;
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

  [[nodiscard]] ResidualFit fit(const CandidateBase& candidate, double step, int turns_a_level) const {
    const StepSchedule steps{.last = static_cast<float>(step)};
    ResidualFit fit(original_, candidate.lifted.mesh.positions,
                    place_on_original(original_, candidate.lifted, candidate.chosen.levels, steps, poller_), poller_);
    fit.improve(turns_a_level * candidate.chosen.levels, rate_weight);
    return fit;
  }

  [[nodiscard]] SurfaceDistance distance(const ResidualFit& fit, uint32_t samples) const {
    return surface_distance(input(), SurfaceTree(fit.surface(fit.level_count())), samples, poller_);
  }

  /// Finds the step that leaves the target distance.
  std::optional<ResidualFit> find_step(CandidateBase& candidate, const Effort& effort) {
    if (candidate.chosen.step == 0) candidate.chosen.step = first_step_;
    std::optional<ResidualFit> best;
    double step = candidate.chosen.step;
    for (int i = 0; i < effort.attempts; ++i) {
      ResidualFit made = fit(candidate, step, effort.turns_a_level);
      if (effort.reaches_distant)
        reach_distant_points(made, original_, {distance_of_distant * wanted_, sheet_reach * wanted_}, poller_);
      const double rms = distance(made, effort.samples).rms;
      const bool is_reached = rms <= wanted_;
      const bool is_coarser_step =
          is_reached && (!candidate.chosen.outcome.is_reached || step >= candidate.chosen.step);
      if (!best || is_coarser_step || (!is_reached && !candidate.chosen.outcome.is_reached)) {
        candidate.chosen.step = step;
        candidate.chosen.outcome = {.rms = rms, .is_reached = is_reached};
        best.emplace(std::move(made));
      }
      if (is_reached && rms >= least_share_of_target * wanted_) break;
      step = expected_step(step, rms, candidate.chosen.floor, wanted_);
    }
    const uint64_t streams = bytes_of(candidate, *best);
    Outcome& outcome = candidate.chosen.outcome;
    outcome.bytes = candidate.coded.bytes + candidate.curves.size() + streams;
    outcome.expected_bytes = candidate.chosen.floor < wanted_ || outcome.is_reached
                                 ? static_cast<double>(outcome.bytes - streams) +
                                       static_cast<double>(streams) * expected_share(candidate.chosen.step, outcome.rms,
                                                                                     candidate.chosen.floor, wanted_)
                                 : std::numeric_limits<double>::infinity();
    return best;
  }

  /// Returns the bytes of the residuals.
  [[nodiscard]] static uint64_t bytes_of(const CandidateBase& candidate, const ResidualFit& fit) {
    uint64_t bytes = 0;
    const std::vector<uint32_t> whole(fit.level_count(), 1);
    for (const auto& level : fit.code(PieceOrder(candidate.lifted.mesh), whole)) bytes += level[0].size();
    return bytes;
  }

  /// Codes the levels, without those that the wanted distance does not need: on flat faces the last ones may add
  /// nothing. With attributes all are kept: their values are linear between vertices.
  [[nodiscard]] EncodedDetail finish(const CandidateBase& candidate, ResidualFit fit) const {
    EncodedDetail encoded;
    encoded.base = {candidate.coded.triangles, candidate.curves};
    encoded.parted = parted_;
    encoded.normals = normals_;
    encoded.bytes = candidate.coded.bytes + candidate.curves.size();
    for (size_t l = 0; l <= fit.level_count(); ++l) {
      poller_.now();
      const SurfaceTree surface(fit.surface(l));
      const SurfaceDistance d = surface_distance(input(), surface, samples_at_last * samples_of_candidate_, poller_);
      const double largest = std::max(d.largest, vertex_distance(input(), surface, poller_));
      encoded.reach.push_back({d.rms / original_.diagonal(), largest / original_.diagonal()});
      if (l > 0 && d.rms <= wanted_ && original_.mesh().attributes.attributes.empty()) fit.keep_levels(l);
      progress(0.9 + 0.1 * static_cast<double>(l) / static_cast<double>(fit.level_count()));
      if (l < fit.level_count()) continue;
      const Folds folds = find_folds(original_, surface, sheet_reach * wanted_, poller_);
      encoded.folds = folds.faces;
      encoded.folded_area = folds.area;
    }
    add_levels(candidate, fit, encoded);
    return encoded;
  }

  void add_levels(const CandidateBase& candidate, const ResidualFit& fit, EncodedDetail& encoded) const {
    const PieceOrder order(candidate.lifted.mesh);
    encoded.levels = encode_pieces(fit, order, options_.piece_bytes, [&](std::span<const uint32_t> piece_counts) {
      if (!has_values(candidate.lifted.mesh.attributes.attributes)) return std::vector<CodedValues>{};
      return encode_values(original_, candidate.lifted, *sequence_, *candidate.base,
                           fit.surface(fit.level_count()).positions, static_cast<float>(options_.texcoord_step), order,
                           piece_counts, poller_);
    });
    for (const DetailStream& level : encoded.levels) {
      encoded.texcoord_bytes += level.texcoords.bytes.size();
      encoded.bytes += level.bytes.size() + level.texcoords.bytes.size();
    }
  }

  const DetailOptions& options_;
  Poller poller_;
  const BaseCoder& code_base_;
  double wanted_;        ///< target distance, in the mesh's unit
  uint32_t parted_ = 0;  ///< number of separated vertices
  NormalStyle normals_{};
  std::optional<SurfaceTree> input_;  ///< surface before vertices were separated and slivers removed, if any were
  OriginalSurface original_;
  uint32_t samples_of_candidate_;
  double first_step_;  ///< first step of a search
  std::unique_ptr<CollapseSequence> sequence_;
  std::vector<BaseMesh> bases_;
  std::map<size_t, CandidateBase> candidates_;
};

}  // namespace

EncodedDetail encode_detail(const TriangleMesh& original, const DetailOptions& options, const BaseCoder& code_base) {
  check(options);
  require_detail_attributes(without_normals(original.attributes));
  return DetailEncoder(original, options, code_base).run();
}

}  // namespace papilio
