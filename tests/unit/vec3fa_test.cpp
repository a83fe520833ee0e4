#include "core/simd/vec3fa.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "papilio/buffer.h"

namespace papilio {
namespace {

Vec3f narrow(Vec3fa lanes) {
  Vec3f p;
  store(lanes, p);
  return p;
}

TEST(Vec3fa, OperationsAreBitIdenticalToThoseOfVec3f) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> exponent(-20, 20);
  std::normal_distribution<float> direction;
  const auto any = [&] {
    const float size = std::exp2(exponent(random));
    return Vec3f{size * direction(random), size * direction(random), size * direction(random)};
  };
  Buffer<Vec3f> vectors(2);  // widen() reads four floats
  for (int i = 0; i < 10'000; ++i) {
    std::generate(vectors.begin(), vectors.end(), any);
    const Vec3f &a = vectors[0], &b = vectors[1];
    ASSERT_EQ(narrow(widen(a) + widen(b)), a + b);
    ASSERT_EQ(narrow(widen(a) - widen(b)), a - b);
    ASSERT_EQ(narrow(0.3F * widen(a)), 0.3F * a);
    ASSERT_EQ(squared_length(widen(a)), dot(a, a));
    ASSERT_EQ(narrow(larger(widen(a), widen(b))), (Vec3f{std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}));
    ASSERT_EQ(narrow(lesser(widen(a), widen(b))), (Vec3f{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)}));
    Buffer<Vec3f> sums{a, a};
    add_share(true, widen(b), sums[0]);
    add_share(false, widen(b), sums[1]);
    ASSERT_EQ(sums[0], a + b);
    ASSERT_EQ(sums[1], b);
  }
}

}  // namespace
}  // namespace papilio
