#include <algorithm>
#include <limits>

#include "papilio/mesh.h"
#include "simd/vec3fa.h"

namespace papilio {

Box bounding_box(std::span<const Vec3f> positions) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  Box box{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
  if (positions.empty()) return box;
  Vec3fa least{Vec3fa::Register{} + infinity};
  Vec3fa most{Vec3fa::Register{} - infinity};
  for (const Vec3f& p : positions.first(positions.size() - 1)) {  // widen() reads four floats
    least = lesser(widen(p), least);
    most = larger(widen(p), most);
  }
  store(least, box.min);
  store(most, box.max);
  const Vec3f& p = positions.back();
  box.min = {std::min(box.min.x, p.x), std::min(box.min.y, p.y), std::min(box.min.z, p.z)};
  box.max = {std::max(box.max.x, p.x), std::max(box.max.y, p.y), std::max(box.max.z, p.z)};
  return box;
}

double Box::diagonal() const { return min.x <= max.x ? length(to_double(max) - to_double(min)) : 0; }

Vec3d Box::centre() const { return 0.5 * (to_double(min) + to_double(max)); }

float Box::largest_coordinate() const {
  const auto largest = [](float from, float to) { return std::max({0.0F, -from, to}); };
  return std::max({largest(min.x, max.x), largest(min.y, max.y), largest(min.z, max.z)});
}

}  // namespace papilio
