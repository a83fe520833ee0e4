#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/detail/binary_coder.h"
#include "core/detail/mixed_bit.h"
#include "core/detail/residual_models.h"

namespace papilio {
namespace {

TEST(BinaryCoder, BitsRoundTripAtAnyProbability) {
  std::mt19937 random(1);
  for (int round = 0; round < 200; ++round) {
    std::vector<std::pair<bool, uint32_t>> bits;
    for (uint32_t i = 0; i < random() % 3000; ++i) {
      const uint32_t probability = round % 3 == 0 ? 1 + random() % 65535 : round % 3 == 1 ? 1 : 65535;
      bits.emplace_back(random() % 65536 < probability, probability);
    }
    BinaryEncoder encoder;
    for (const auto& [bit, probability] : bits) encoder.code(bit, probability);
    const std::vector<uint8_t> bytes = encoder.finish();
    BinaryDecoder decoder(bytes);
    for (const auto& [bit, probability] : bits) ASSERT_EQ(decoder.code(probability), bit);
  }
}

TEST(BinaryCoder, SizeIsTheEntropyPlusAFewBytes) {
  std::mt19937 random(2);
  constexpr uint32_t count = 100'000;
  constexpr uint32_t probability = 65536 / 100;
  BinaryEncoder encoder;
  for (uint32_t i = 0; i < count; ++i) encoder.code(random() % 100 == 0, probability);
  const double entropy = 0.01 * std::log2(100) + 0.99 * std::log2(1 / 0.99);
  EXPECT_NEAR(static_cast<double>(encoder.finish().size()), entropy * count / 8, 0.03 * entropy * count / 8);
}

TEST(BinaryCoder, NoBitsTakeNoBytes) { EXPECT_TRUE(BinaryEncoder().finish().empty()); }

TEST(MixedBit, SquashIsTheInverseOfStretchAndBothAreMonotone) {
  for (uint32_t p = 64; p < 65536 - 64; p += 16) EXPECT_NEAR(squash(stretch(p)), p, 8 + p / 128.0) << p;
  for (int32_t x = -4000; x < 4000; ++x) EXPECT_LE(squash(x), squash(x + 1));
  EXPECT_EQ(squash(0), 32768U);
  EXPECT_EQ(squash(-100'000), squash(-3071));
  EXPECT_GE(squash(-100'000), 1U);
  EXPECT_LE(squash(100'000), 65535U);
}

TEST(MixedBit, ModelsLearnTheShareOfOnes) {
  std::mt19937 random(3);
  BitModel model;
  for (int i = 0; i < 20'000; ++i) model.update(random() % 10 == 0);
  EXPECT_NEAR(model.probability(), 6554, 1600);
}

TEST(MixedBit, MixerFavoursTheBetterModel) {
  BitMixer<2> mixer(1);
  BitModel knows, knows_not;
  for (int i = 0; i < 400; ++i) knows.update(true);
  uint32_t probability = 0;
  for (int i = 0; i < 2000; ++i) {
    BitModel known = knows;
    BitModel unknown = knows_not;
    probability = mixer.mix({&known, &unknown}, 0);
    mixer.update(true);
  }
  EXPECT_GT(probability, 65000U);
}

/// Random contexts, as in hostile streams.
ResidualContext random_context(std::mt19937& random) {
  ResidualContext c;
  c.level = random() % 11;
  c.known = random() % 5;
  for (uint32_t i = 0; i < c.known; ++i) {
    c.neighbours[i] = static_cast<int32_t>(random() % 5) - 2;
    if (random() % 50 == 0) c.neighbours[i] = random() % 2 == 0 ? largest_residual : -largest_residual;
    c.free_neighbours += random() % 20 == 0 ? 1 : 0;
  }
  c.parents = random() % 3 == 0 ? random() % (8 * largest_residual) : random() % 30;
  c.turn = random() % 3 == 0 ? random() % 1'000'001 : random() % 60;
  const auto any = [&](int32_t most) {
    const int32_t limit = random() % 50 == 0 ? most : 20;
    return static_cast<int32_t>(random() % (2 * static_cast<uint32_t>(limit) + 1)) - limit;
  };
  c.ends = any(2 * largest_residual);
  c.has_sibling = random() % 2 == 0;
  if (c.has_sibling) c.sibling = any(largest_residual);
  c.has_beyond = random() % 2 == 0;
  if (c.has_beyond) c.beyond = any(8 * largest_residual);
  c.bow = random() % 50 == 0 ? 1e6 : any(60);
  return c;
}

int32_t random_residual(std::mt19937& random) {
  const uint32_t kind = random() % 100;
  if (kind < 60) return 0;
  if (kind < 95) return static_cast<int32_t>(random() % 9) - 4;
  if (kind < 99) return static_cast<int32_t>(random() % 2001) - 1000;
  return random() % 2 == 0 ? largest_residual : -largest_residual;
}

TEST(ResidualModels, ResidualsRoundTrip) {
  std::mt19937 random(4);
  struct Coded {
    ResidualContext context;
    int32_t residual;
    bool is_free;
    int32_t tangential;
  };
  std::vector<Coded> all;
  for (int i = 0; i < 50'000; ++i)
    all.push_back({random_context(random), random_residual(random), random() % 100 == 0, random_residual(random)});
  BinaryEncoder encoder;
  ResidualModels models;
  const auto encode = [&](bool bit, uint32_t probability) {
    encoder.code(bit, probability);
    return bit;
  };
  for (const Coded& c : all) {
    EXPECT_EQ(models.code_freedom(c.context, c.is_free, encode), c.is_free);
    EXPECT_EQ(models.code(c.context, c.residual, encode), c.residual);
    if (c.is_free) {
      EXPECT_EQ(models.code_tangential(c.tangential, encode), c.tangential);
    }
  }
  const std::vector<uint8_t> bytes = encoder.finish();
  BinaryDecoder decoder(bytes);
  ResidualModels others;
  const auto decode = [&](bool, uint32_t probability) { return decoder.code(probability); };
  for (const Coded& c : all) {
    ASSERT_EQ(others.code_freedom(c.context, false, decode), c.is_free);
    ASSERT_EQ(others.code(c.context, 0, decode), c.residual);
    if (c.is_free) {
      ASSERT_EQ(others.code_tangential(0, decode), c.tangential);
    }
  }
}

TEST(ResidualModels, AnyBytesDecodeToResiduals) {
  std::mt19937 random(5);
  for (int round = 0; round < 50; ++round) {
    std::vector<uint8_t> bytes(random() % 200);
    for (uint8_t& byte : bytes) byte = static_cast<uint8_t>(random());
    BinaryDecoder decoder(bytes);
    ResidualModels models;
    const auto decode = [&](bool, uint32_t probability) { return decoder.code(probability); };
    for (int i = 0; i < 2000; ++i) {
      const int32_t residual = models.code(random_context(random), 0, decode);
      ASSERT_LE(std::abs(residual), largest_residual);
      ASSERT_LE(std::abs(models.code_tangential(0, decode)), largest_residual);
    }
  }
}

/// Returns the bytes of residuals that are the mean of two neighbours, times `share`, and noise.
size_t bytes_of_residuals_near_neighbours(double share) {
  std::mt19937 random(6);
  BinaryEncoder encoder;
  ResidualModels models;
  for (int i = 0; i < 20'000; ++i) {
    ResidualContext c{.level = 3, .known = 2};
    c.neighbours[0] = static_cast<int32_t>(random() % 61) - 30;
    c.neighbours[1] = c.neighbours[0];
    const double expected = share * c.neighbours[0];
    const auto residual = static_cast<int32_t>(std::lround(expected)) + static_cast<int32_t>(random() % 7) - 3;
    models.code(c, residual, [&](bool bit, uint32_t probability) {
      encoder.code(bit, probability);
      return bit;
    });
  }
  return encoder.finish().size();
}

TEST(ResidualModels, ExpectedResidualsTakeTheBytesOfTheirNoise) {
  const double noise = 20'000 * std::log2(7) / 8;
  for (const double share : {0.5, 1.0, -1.0})
    EXPECT_LT(static_cast<double>(bytes_of_residuals_near_neighbours(share)), 1.2 * noise) << share;
}

TEST(ResidualModels, ZerosTakeAlmostNoBytes) {
  BinaryEncoder encoder;
  ResidualModels models;
  for (int i = 0; i < 100'000; ++i)
    models.code({.level = 4, .known = 4}, 0, [&](bool bit, uint32_t probability) {
      encoder.code(bit, probability);
      return bit;
    });
  EXPECT_LT(encoder.finish().size(), 40U);
}

}  // namespace
}  // namespace papilio
