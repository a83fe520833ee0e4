#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/poller.h"
#include "detail/linear_stencils.h"
#include "detail/original_surface.h"
#include "detail/placement.h"
#include "papilio/mesh.h"

namespace papilio {

/// Residuals of a hierarchy, improved by coordinate descent on squared distance and rate. The distances of the last
/// level's vertices to the original are propagated to coarser levels by the adjoint of the subdivision. A residual
/// changes if that saves more error, or bits, than it costs.
class ResidualFit {
 public:
  /// Starts from placed residuals. `original` must outlive this.
  ResidualFit(const OriginalSurface& original, Buffer<Vec3f> base, PlacedLevels placed, Poller poller);

  /// Improves one level in each turn. `rate_weight`: weight of a bit; 1 is the error that a bit saves at a high rate.
  /// Restores the residuals where faces turn over.
  void improve(int turns, double rate_weight);

  /// Replaces the residuals of the last level.
  void set_last_residuals(Residuals residuals);

  /// Drops all but the first `count` levels; improve() must not follow.
  void keep_levels(size_t count);

  /// Returns the coded residuals [level][piece], in `piece_counts` [level] pieces.
  [[nodiscard]] std::vector<std::vector<std::vector<uint8_t>>> code(const PieceOrder& order,
                                                                    std::span<const uint32_t> piece_counts) const;
  /// Returns the mesh of the first `levels` levels.
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
    Buffer<float> gradient{};         // [E] decrease of half the squared error along the normal
    Buffer<float> gradient_across{};  // [C] decrease of half the squared error across edges on curves
    Buffer<float> area{};             // [E] area that a vertex moves
  };
  void forward();
  void place_new_vertices(Level& level);
  [[nodiscard]] Buffer<Vec3f> face_normals() const;
  bool turn_faces_back(const std::vector<Residuals>& before, const Buffer<Vec3f>& normals);
  void find_forces();
  [[nodiscard]] Nearest nearest(uint32_t v, Vec3d normal) const;
  void push_down();
  void improve(Level& level, double bit_cost);
  void improve_across(Level& level, double bit_cost);
  [[nodiscard]] Vec3f force_to_surface(uint32_t v, Vec3d normal);
  [[nodiscard]] Vec3f force_to_curve(uint32_t v) const;

  const OriginalSurface& original_;
  Poller poller_;
  std::vector<Level> levels_;
  Topology last_;
  enum class On : uint8_t { surface, seam, curve };
  std::vector<On> on_;       // [V] where a vertex must lie
  Buffer<Vec3f> positions_;  // [V] positions of the last level
  Buffer<Vec3f> force_;      // [V] area times the vector to the original
  Buffer<float> area_;       // [V]
  Buffer<float> distance_;   // [V] last distance to the original; negative: unknown
  Buffer<uint32_t> face_;    // [V] last nearest face of the original
  uint32_t base_vertices_;
};

}  // namespace papilio
