#include "server/address_space.h"

#include <gtest/gtest.h>

namespace papilio::server {
namespace {

TEST(AddressSpace, WhatIsSetIsTaken) {
  Config config;
  config.max_memory_bytes = 123456789;
  config.container_memory_bytes = 1000;
  EXPECT_EQ(address_space_bound(config), 123456789U);
}

TEST(AddressSpace, WithoutAContainerWhatTheSettingsMayNeed) {
  Config config;
  config.engine.slots = 2;
  EXPECT_EQ(address_space_bound(config), address_space_needed(config));
}

TEST(AddressSpace, NoMoreThanTheContainersMemoryBesideTheStacks) {
  Config config;
  config.engine.slots = 2;
  config.container_memory_bytes = 1ULL << 30;
  Config larger = config;
  larger.container_memory_bytes += 1ULL << 20;
  EXPECT_LT(address_space_bound(config), address_space_needed(config));
  EXPECT_GE(address_space_bound(config), 1ULL << 30);
  EXPECT_EQ(address_space_bound(larger) - address_space_bound(config), 1ULL << 20);
  larger.container_memory_bytes = 1ULL << 50;
  EXPECT_EQ(address_space_bound(larger), address_space_needed(config));
}

TEST(AddressSpace, AlwaysEnoughToStart) {
  Config config;
  config.engine.slots = 2;
  config.container_memory_bytes = 1 << 20;
  EXPECT_EQ(address_space_bound(config), address_space_of_threads(config));
}

}  // namespace
}  // namespace papilio::server
