#include "server/cache/lru.h"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace papilio::server {
namespace {

constexpr uint64_t overhead = Lru<int>::entry_bytes;

TEST(Lru, LeastRecentlyUsedValueIsEvicted) {
  Lru<int> lru(3 * (100 + overhead));
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(lru.put(std::to_string(i), std::make_shared<int>(i), 100));
  EXPECT_EQ(lru.bytes(), 3 * (100 + overhead));
  ASSERT_NE(lru.get("0"), nullptr);  // now 1 is the oldest
  EXPECT_TRUE(lru.put("3", std::make_shared<int>(3), 100));
  EXPECT_EQ(lru.get("1"), nullptr);
  for (const int i : {0, 2, 3}) EXPECT_EQ(*lru.get(std::to_string(i)), i);
  EXPECT_EQ(lru.size(), 3U);
}

TEST(Lru, PutReplacesTheValueOfItsKey) {
  Lru<int> lru(1000 + 2 * overhead);
  EXPECT_TRUE(lru.put("a", std::make_shared<int>(1), 100));
  EXPECT_FALSE(lru.put("a", std::make_shared<int>(2), 300));
  EXPECT_EQ(*lru.get("a"), 2);
  EXPECT_EQ(lru.bytes(), 300 + overhead);
  EXPECT_EQ(lru.size(), 1U);
}

TEST(Lru, ValueLargerThanTheBudgetIsNotStoredAndEvictsNothing) {
  Lru<int> lru(500);
  EXPECT_TRUE(lru.put("small", std::make_shared<int>(1), 100));
  EXPECT_TRUE(lru.put("large", std::make_shared<int>(2), 400));
  EXPECT_EQ(lru.get("large"), nullptr);
  EXPECT_NE(lru.get("small"), nullptr);
}

TEST(Lru, EvictedValueStaysValidForItsUsers) {
  Lru<int> lru(100 + overhead);
  lru.put("a", std::make_shared<int>(7), 100);
  const std::shared_ptr<int> held = lru.get("a");
  lru.put("b", std::make_shared<int>(8), 100);
  EXPECT_EQ(lru.get("a"), nullptr);
  EXPECT_EQ(*held, 7);
  EXPECT_TRUE(lru.remove("b"));
  EXPECT_FALSE(lru.remove("b"));
  EXPECT_EQ(lru.bytes(), 0U);
}

TEST(Lru, ConcurrentUseIsSafe) {
  Lru<int> lru(10 * (100 + overhead));
  std::vector<std::jthread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&lru, t] {
      for (int i = 0; i < 500; ++i) {
        const std::string key = std::to_string((i * (t + 1)) % 20);
        const auto value = lru.get(key);
        EXPECT_TRUE(value == nullptr || std::to_string(*value) == key);
        lru.put(key, std::make_shared<int>(std::stoi(key)), 100);
        if (i % 7 == 0) lru.remove(key);
      }
    });
  threads.clear();
  EXPECT_LE(lru.size(), 10U);
  EXPECT_EQ(lru.bytes(), lru.size() * (100 + overhead));
}

}  // namespace
}  // namespace papilio::server
