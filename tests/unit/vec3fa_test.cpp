#include "core/simd/vec3fa.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "papilio/buffer.h"

namespace papilio {
namespace {

TEST(Vec3fa, DotsAreBitIdenticalToDot) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> exponent(-20, 20);
  std::normal_distribution<float> direction;
  const auto any = [&] {
    const float size = std::exp2(exponent(random));
    return Vec3f{size * direction(random), size * direction(random), size * direction(random)};
  };
  Buffer<Vec3f> vectors(4);  // widen() reads four floats
  for (int i = 0; i < 10'000; ++i) {
    std::generate(vectors.begin(), vectors.end(), any);
    const Vec3f &a = vectors[0], &b = vectors[1], &c = vectors[2], &d = vectors[3];
    const Vec3fa products = dots(widen(a), widen(b), widen(c), widen(d));
    ASSERT_EQ(products.v[0], dot(a, b));
    ASSERT_EQ(products.v[1], dot(a, c));
    ASSERT_EQ(products.v[2], dot(a, d));
  }
}

}  // namespace
}  // namespace papilio
