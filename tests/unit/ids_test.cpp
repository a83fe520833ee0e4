#include "core/base/ids.h"

#include <gtest/gtest.h>

#include <concepts>
#include <type_traits>

#include "papilio/mesh.h"

namespace papilio {
namespace {

// Ids of one kind do not convert to another kind.
static_assert(!std::convertible_to<HalfEdgeId, FaceId> && !std::constructible_from<FaceId, HalfEdgeId>);
static_assert(!std::convertible_to<FaceId, EdgeId> && !std::convertible_to<EdgeId, VertexId>);
static_assert(std::convertible_to<FaceId, uint32_t> && std::convertible_to<uint32_t, FaceId>);
static_assert(sizeof(HalfEdgeId) == sizeof(uint32_t) && std::is_trivially_copyable_v<HalfEdgeId>);

TEST(HalfEdgeId, NextAndPreviousEqualTheTopologys) {
  for (HalfEdgeId h = 0; h < 12; ++h) {
    EXPECT_EQ(uint32_t{h.face()}, Topology::face(h));
    EXPECT_EQ(uint32_t{h.next()}, Topology::next(h));
    EXPECT_EQ(uint32_t{h.previous()}, Topology::previous(h));
  }
}

}  // namespace
}  // namespace papilio
