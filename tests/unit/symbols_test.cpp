#include "proto/edgebreaker/symbols.h"

#include <draco/compression/entropy/symbol_encoding.h>
#include <draco/core/varint_encoding.h>
#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

// Coded symbols are byte-identical to libdraco's.

namespace papilio::proto::edgebreaker {
namespace {

std::string bytes_of(const draco::EncoderBuffer& buffer) { return {buffer.data(), buffer.size()}; }

std::string by_libdraco(const std::vector<uint32_t>& symbols, uint32_t components, int level) {
  draco::EncoderBuffer out;
  draco::Options options;
  draco::SetSymbolEncodingCompressionLevel(&options, level);
  EXPECT_TRUE(draco::EncodeSymbols(symbols.data(), static_cast<int>(symbols.size()), static_cast<int>(components),
                                   &options, &out));
  return bytes_of(out);
}

std::string by_us(const std::vector<uint32_t>& symbols, uint32_t components, int level) {
  draco::EncoderBuffer out;
  write_symbols(symbols, components, level, out);
  return bytes_of(out);
}

/// Returns random symbols of up to `bits` bits, most of them small.
std::vector<uint32_t> random_symbols(size_t count, uint32_t bits, std::mt19937& random) {
  std::vector<uint32_t> symbols(count);
  for (uint32_t& symbol : symbols) symbol = (random() & ((uint64_t{1} << bits) - 1)) >> random() % bits;
  return symbols;
}

TEST(Symbols, BytesEqualLibdracos) {
  std::mt19937 random(3);
  bool is_tagged[2] = {false, false};
  for (const size_t values : {1, 2, 9, 100, 3000, 40000})
    for (const uint32_t bits : {1, 2, 5, 9, 13, 17, 18, 19, 22})
      for (uint32_t components = 1; components <= 5; ++components) {
        const std::vector<uint32_t> symbols = random_symbols(values * components, bits, random);
        const int level = static_cast<int>(random() % 11);
        const std::string expected = by_libdraco(symbols, components, level);
        EXPECT_TRUE(by_us(symbols, components, level) == expected)
            << values << " values of " << components << " components of " << bits << " bits, level " << level;
        is_tagged[expected[0] == draco::SYMBOL_CODING_TAGGED ? 1 : 0] = true;
      }
  EXPECT_TRUE(is_tagged[0] && is_tagged[1]);
}

TEST(Symbols, BytesEqualLibdracosAtEveryLevel) {
  std::mt19937 random(4);
  for (int level = 0; level <= 10; ++level)
    for (const uint32_t bits : {3, 8, 12}) {
      const std::vector<uint32_t> symbols = random_symbols(5000, bits, random);
      EXPECT_TRUE(by_us(symbols, 1, level) == by_libdraco(symbols, 1, level)) << level << ", " << bits << " bits";
    }
}

TEST(Symbols, BytesEqualLibdracosWithOneDominantSymbol) {
  std::vector<uint32_t> symbols(100000, 2);
  EXPECT_TRUE(by_us(symbols, 1, 7) == by_libdraco(symbols, 1, 7));
  symbols[77] = 900;
  EXPECT_TRUE(by_us(symbols, 1, 7) == by_libdraco(symbols, 1, 7));
}

TEST(Symbols, NoSymbolsTakeNoBytes) { EXPECT_EQ(by_us({}, 3, 7), ""); }

TEST(Symbols, ListsAreCodedLikeSeparateLists) {
  std::mt19937 random(5);
  std::vector<Buffer<uint32_t>> lists;
  std::string expected;
  for (const size_t count : {0, 700, 20, 0, 3000, 3000, 1}) {
    const std::vector<uint32_t> symbols = random_symbols(count, 3, random);
    lists.emplace_back(symbols.begin(), symbols.end());
    draco::EncoderBuffer varint;
    draco::EncodeVarint<uint32_t>(static_cast<uint32_t>(count), &varint);
    expected += bytes_of(varint) + (count > 0 ? by_libdraco(symbols, 1, default_compression_level) : "");
  }
  draco::EncoderBuffer out;
  write_symbol_lists(lists, out);
  EXPECT_TRUE(bytes_of(out) == expected);
}

}  // namespace
}  // namespace papilio::proto::edgebreaker
