#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "detail/linear_stencils.h"
#include "detail/original_surface.h"
#include "detail/placement.h"
#include "papilio/mesh.h"

namespace papilio {

/// Residuals of a hierarchy, improved by coordinate descent on squared distance and rate: the distances of the last
/// level's vertices to the original are pushed down through the adjoint of the subdivision, and a residual changes
/// where that saves more error, or bits, than it costs.
class ResidualFit {
 public:
  /// `original` must outlive this. `poll` is called every turn and may throw to stop.
  ResidualFit(const OriginalSurface& original, Buffer<Vec3f> base, PlacedLevels placed, std::function<void()> poll);

  /// So many turns, each of one level. `rate_weight`: weight of a bit, 1 being what it saves at a high rate.
  void improve(int turns, double rate_weight);

  /// Codes the residuals: [levels][pieces], of so many pieces a level.
  [[nodiscard]] std::vector<std::vector<std::vector<uint8_t>>> code(const PieceOrder& order,
                                                                    std::span<const uint32_t> piece_counts) const;
  /// The mesh of the first `levels` levels; all of them: the surface.
  [[nodiscard]] TriangleMesh surface(size_t levels) const;
  [[nodiscard]] size_t level_count() const { return levels_.size(); }
  [[nodiscard]] float step(size_t level) const { return levels_[level].residuals.step; }
  [[nodiscard]] const DetailLevel& level(size_t level) const { return levels_[level].level; }
  [[nodiscard]] const Residuals& residuals(size_t level) const { return levels_[level].residuals; }

 private:
  struct Level {
    DetailLevel level;
    Residuals residuals;
    LinearStencils stencils{};
    Buffer<Vec3f> normals{};          // [E]
    Buffer<float> gradient{};         // [E] of half the squared error, against the normal
    Buffer<float> gradient_across{};  // [C] against the direction across the edges on curves
    Buffer<float> area{};             // [E] that a vertex moves
  };
  void forward();
  void find_forces();
  [[nodiscard]] Nearest nearest(uint32_t v, Vec3d normal) const;
  void push_down();
  void improve(Level& level, double bit_cost);
  void improve_across(Level& level, double bit_cost);
  [[nodiscard]] Vec3f force_to_surface(uint32_t v, Vec3d normal);
  [[nodiscard]] Vec3f force_to_curve(uint32_t v) const;

  const OriginalSurface& original_;
  std::function<void()> poll_;
  std::vector<Level> levels_;
  Topology last_;
  enum class On : uint8_t { surface, seam, curve };
  std::vector<On> on_;       // [V] what a vertex keeps to
  Buffer<Vec3f> positions_;  // [V] of the last level
  Buffer<Vec3f> force_;      // [V] area times the way to the original
  Buffer<float> area_;       // [V]
  Buffer<float> distance_;   // [V] to the original when last looked; negative: not known
  Buffer<uint32_t> face_;    // [V] of the original, nearest then
  uint32_t base_vertices_;
};

}  // namespace papilio
