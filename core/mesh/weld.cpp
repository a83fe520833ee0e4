#include "mesh/weld.h"

#include <bit>
#include <random>

namespace papilio {
namespace {

/// Returns the random seed of this process, so that no mesh can be made to collide in the hash. Drawn once: on virtual
/// processors it takes a tenth of a millisecond.
uint64_t hash_seed() {
  static const uint64_t seed = std::random_device{}() | uint64_t{std::random_device{}()} << 32;
  return seed;
}

/// Hash table of points by position: open addressing, at most half full.
class PositionTable {
 public:
  explicit PositionTable(const Buffer<Vec3f>& points)
      : points_(points), mask_(std::bit_ceil(2 * points.size() + 2) - 1), slots_(mask_ + 1, none), seed_(hash_seed()) {}

  /// Returns the first inserted point with p's position; inserts p if there is none.
  uint32_t first_at(uint32_t p) {
    const Vec3f position = points_[p];
    for (size_t slot = hash(position) & mask_;; slot = (slot + 1) & mask_) {
      if (slots_[slot] == none) return slots_[slot] = p;
      if (points_[slots_[slot]] == position) return slots_[slot];
    }
  }

 private:
  static uint64_t bits(float c) { return std::bit_cast<uint32_t>(c + 0.0F); }  // -0 + 0 = 0

  static uint64_t mix(uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
    return x ^ (x >> 31);
  }

  [[nodiscard]] uint64_t hash(Vec3f p) const {
    return mix(mix(seed_ ^ (bits(p.x) | bits(p.y) << 32)) + bits(p.z) * 0x9e3779b97f4a7c15ULL);
  }

  const Buffer<Vec3f>& points_;
  size_t mask_;
  Buffer<uint32_t> slots_;
  uint64_t seed_;
};

}  // namespace

Buffer<uint32_t> weld(const TriangleMesh& input, Buffer<Vec3f>& positions, BuildReport& report,
                      std::vector<uint32_t>& corner_point) {
  const auto point_count = static_cast<uint32_t>(input.positions.size());
  auto first = Buffer<uint32_t>::for_overwrite(point_count);
  PositionTable table(input.positions);
  for (uint32_t p = 0; p < point_count; ++p) {
    first[p] = table.first_at(p);
    report.welded_points += first[p] == p ? 0 : 1;
  }

  Buffer<uint32_t> vertex(point_count, none);
  auto corners = Buffer<uint32_t>::for_overwrite(3 * input.triangles.size());
  positions.resize_for_overwrite(point_count);
  if (!input.attributes.empty()) corner_point.reserve(corners.size());
  uint32_t* corner = corners.data();
  uint32_t vertices = 0;
  for (const Triangle& t : input.triangles) {
    const Triangle p{first[t[0]], first[t[1]], first[t[2]]};
    if (p[0] == p[1] || p[1] == p[2] || p[2] == p[0]) {
      ++report.degenerate_faces;
      continue;
    }
    if (!input.attributes.empty()) corner_point.insert(corner_point.end(), t.begin(), t.end());
    for (uint32_t point : p) {
      if (vertex[point] == none) {
        positions[vertices] = input.positions[point];
        vertex[point] = vertices++;
      }
      *corner++ = vertex[point];
    }
  }
  corners.resize_for_overwrite(static_cast<size_t>(corner - corners.data()));
  positions.resize_for_overwrite(vertices);
  report.isolated_points = point_count - report.welded_points - vertices;
  return corners;
}

}  // namespace papilio
