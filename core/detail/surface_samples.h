#pragma once

#include <cmath>
#include <cstdint>

#include "detail/surface_tree.h"

namespace papilio {

/// Returns the sample of a number in a triangle. Samples follow the plastic number's sequence, folded at the diagonal
/// [Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018].
inline Vec3d sample_of(const TriangleCorners& c, uint32_t number) {
  const auto fraction = [](double x) { return x - std::floor(x); };
  double u = fraction(0.5 + number * 0.7548776662466927);
  double v = fraction(0.5 + number * 0.5698402909980532);
  if (u + v > 1) u = 1 - u, v = 1 - v;
  return c.a + u * (c.b - c.a) + v * (c.c - c.a);
}

/// Calls visit(face, point) for samples of a surface, spread evenly by area.
template <class Visit>
void for_each_sample(const SurfaceTree& surface, uint32_t samples, const Visit& visit) {
  const auto faces = static_cast<uint32_t>(surface.surface().triangles.size());
  const auto area = [](const TriangleCorners& c) { return length(cross(c.b - c.a, c.c - c.a)); };
  double total = 0;
  for (uint32_t f = 0; f < faces; ++f) total += area(surface.corners(f));
  double sum = 0;
  uint32_t taken = 0;
  for (uint32_t f = 0; f < faces; ++f) {
    const TriangleCorners c = surface.corners(f);
    sum += area(c);
    for (; taken < samples && sum * samples > (taken + 0.5) * total; ++taken) visit(f, sample_of(c, taken));
  }
}

}  // namespace papilio
