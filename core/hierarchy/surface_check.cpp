#include "hierarchy/surface_check.h"

#include <algorithm>

#include "base/parallel.h"
#include "hierarchy/leaf_comparison.h"
#include "hierarchy/move_bounds.h"

namespace papilio {

SurfaceCheck::SurfaceCheck(std::span<const LevelChoice> levels, int level_count, AllowedDistance allowed,
                           double share_known, const Progress& progress)
    : levels_(levels),
      level_count_(level_count),
      allowed_(std::move(allowed)),
      progress_(progress),
      sums_(sums_below(levels, level_count, share_known * allowed_.least())) {}

/// Returns what `find` returns for each part of the coarse faces.
template <class Found, class Find>
std::vector<Found> SurfaceCheck::compare(const Find& find) const {
  const uint32_t count = levels_[0].level->mesh.topology.face_count();
  uint64_t faces = 0;
  for (const LevelChoice& choice : levels_) faces += choice.region.faces.size();
  const uint32_t parts =
      std::min(count, parts_of(static_cast<uint32_t>(std::min<uint64_t>(faces, none)), progress_.threads()));
  std::vector<Found> found(parts);
  for_each_part(parts, count, [&](uint32_t part, uint32_t first, uint32_t last) {
    // The first part runs on the calling thread, which alone may poll.
    LeafComparison comparison(levels_, sums_, level_count_, allowed_, part == 0 ? &progress_ : nullptr);
    found[part] = find(comparison, first, last);
  });
  return found;
}

Buffer<LevelFace> SurfaceCheck::far_faces(NearFaces& near) const {
  Buffer<LevelFace> far;
  for (const Buffer<LevelFace>&of_part :
       compare<Buffer<LevelFace>>([&](LeafComparison&comparison, uint32_t first, uint32_t last) {
         return comparison.far_faces(near, first, last);
       }))
    far.insert(far.end(), of_part.begin(), of_part.end());
  return far;
}

bool SurfaceCheck::exceeds(double share) const {
  return std::ranges::count(compare<char>([&](LeafComparison& comparison, uint32_t first, uint32_t last) {
                              return comparison.exceeds(share, first, last) ? 1 : 0;
                            }),
                            1) > 0;
}

double SurfaceCheck::largest_bound() const {
  return std::ranges::max(compare<double>(
      [](LeafComparison& comparison, uint32_t first, uint32_t last) { return comparison.largest_bound(first, last); }));
}

double SurfaceCheck::largest_share() const {
  const double most = largest_bound();
  // Few distances are much smaller than the sum of moves: a guess leaves out most of the leaves.
  for (const double guess : {0.8 * most, 0.2 * most, 0.0}) {
    const double found =
        std::ranges::max(compare<double>([&](LeafComparison& comparison, uint32_t first, uint32_t last) {
          return comparison.largest_share(guess, first, last);
        }));
    if (found > guess) return found;
  }
  return 0;
}

}  // namespace papilio
