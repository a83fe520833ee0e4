#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <memory>
#include <new>
#include <string>

#include "papilio/refine.h"
#include "server/admission.h"
#include "server/cache/lru.h"
#include "tests/support/shapes.h"

// Each allocation of a refinement and of the server's shared state fails in turn.

namespace {

thread_local int64_t allocations_left = -1;  // negative: unlimited
thread_local int64_t blocks_made = 0;        // for arrays
thread_local bool blocks_fail = false;       // arrays try twice: after one failure all blocks fail

#if defined(__SANITIZE_ADDRESS__)
constexpr bool keeps_blocks = false;  // no blocks are reused under this sanitizer
#else
constexpr bool keeps_blocks = true;
#endif

}  // namespace

#pragma GCC diagnostic ignored "-Wmismatched-new-delete"  // GCC 12 inlines both and sees new paired with free

void* operator new(std::size_t size) {
  if (allocations_left >= 0 && allocations_left-- == 0) throw std::bad_alloc();
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  if (blocks_fail || (allocations_left >= 0 && allocations_left-- == 0)) {
    blocks_fail = true;
    throw std::bad_alloc();
  }
  ++blocks_made;
  const auto unit = static_cast<std::size_t>(alignment);
  if (void* memory = std::aligned_alloc(unit, (size + unit - 1) / unit * unit)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory, std::align_val_t /*alignment*/) noexcept { std::free(memory); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t /*size*/) noexcept { std::free(memory); }

// The sanitizer sees its own operator new in libraries, and the operator delete above.
extern "C" const char* __asan_default_options();
extern "C" const char* __asan_default_options() { return "alloc_dealloc_mismatch=0"; }

namespace papilio {
namespace {

using namespace test;

/// Runs with 0, 1, 2, ... allocations until a run succeeds; each earlier run must throw `Error`.
void fail_each_allocation(const Options& options) {
  const Mesh coarse = build_mesh(join(icosahedron(), cube(), 5));
  const Result expected = refine(coarse, options);
  for (int64_t allowed = 0;; ++allowed) {
    Mesh copy = coarse;
    release_spare_blocks();
    allocations_left = allowed;
    try {
      const Result result = refine(std::move(copy), options);
      allocations_left = -1;
      EXPECT_EQ(result.mesh.triangles(), expected.mesh.triangles());
      EXPECT_GT(allowed, 20);
      return;
    } catch (const Error& error) {
      blocks_fail = false;
      allocations_left = -1;
      ASSERT_EQ(error.fault(), Fault::out_of_memory) << allowed;
    } catch (const std::bad_alloc&) {
      blocks_fail = false;
      allocations_left = -1;
      ASSERT_LT(allowed, 3) << "only the error's text may exceed the limit";
    }
  }
}

TEST(Allocation, EveryFailedAllocationIsAnError) {
  fail_each_allocation({.levels = 2});
  fail_each_allocation({.levels = 2, .scheme = Scheme::in_place, .flatness = {0.9}, .tension = Tension::sharp});
  fail_each_allocation({.levels = 3, .crease_angle = 60, .tolerance = 1e-3});
  fail_each_allocation({.levels = 3, .view = View{.error_pixels = 0.1}, .max_faces = 200});
}

TEST(Allocation, SecondRunAllocatesNoArray) {
  const Mesh coarse = build_mesh(torus(40, 30));
  const View view{.eye = {4, 1, 1}, .error_pixels = 0.5};
  for (const Tension tension : {Tension::off, Tension::soft})
    for (const Options& options :
         {Options{.levels = 3, .tension = tension}, Options{.levels = 3, .tension = tension, .edges = false},
          Options{.levels = 3, .flatness = {0.98, 0.99}, .tension = tension},
          Options{.levels = 3, .tension = tension, .tolerance = 2e-4},
          Options{.levels = 3, .view = view, .tension = tension},
          Options{.levels = 3, .tension = tension, .max_faces = 20000}}) {
      const auto run = [&] {
        blocks_made = 0;
        (void)refine(Mesh(coarse), options);
        return blocks_made;
      };
      release_spare_blocks();
      const auto first = run();
      EXPECT_GT(first, 10);
      EXPECT_EQ(run(), keeps_blocks ? 0 : first);
    }
  release_spare_blocks();
}

TEST(Allocation, MemoryLimitRefusesBeforeRefinement) {
  for (const Options& options :
       {Options{.levels = 6, .memory_limit = 1 << 20}, Options{.levels = 6, .tolerance = 1e-7, .memory_limit = 1 << 20},
        Options{.levels = 6, .scheme = Scheme::in_place, .flatness = {1}, .memory_limit = 1 << 20}}) {
    try {
      (void)refine(build_mesh(icosahedron()), options);
      ADD_FAILURE() << "was not refused";
    } catch (const Error& error) {
      EXPECT_EQ(error.fault(), Fault::result_too_large);
      EXPECT_NE(std::string(error.what()).find("MiB"), std::string::npos);
    }
  }
}

/// Calls `work` with 0, 1, 2, ... allocations until it succeeds.
template <class Work>
void fail_each_allocation_of(const Work& work) {
  for (int64_t allowed = 0;; ++allowed) {
    allocations_left = allowed;
    try {
      work();
      allocations_left = -1;
      EXPECT_GT(allowed, 0);
      return;
    } catch (const std::bad_alloc&) {
      allocations_left = -1;
    }
  }
}

TEST(Allocation, FailedAllocationLeavesTheLruConsistent) {
  using server::Lru;
  Lru<int> lru(2 * (100 + Lru<int>::entry_bytes));
  const auto value = std::make_shared<int>(1);
  for (int i = 0; i < 8; ++i) {
    const std::string key = "a key too long for the string itself, number " + std::to_string(i);
    fail_each_allocation_of([&] { lru.put(key, value, 100); });
    EXPECT_EQ(lru.get(key), value);
    EXPECT_EQ(lru.bytes(), lru.size() * (100 + Lru<int>::entry_bytes));
  }
  EXPECT_EQ(lru.size(), 2U);
}

TEST(Allocation, FailedAllocationFreesTheSlot) {
  server::Admission admission(1, 0);
  const std::function<bool()> stays = [] { return false; };
  const std::string client = "a name too long for the string itself";
  fail_each_allocation_of([&] { (void)admission.enter(client, {1, 1}, stays); });
  EXPECT_EQ(admission.computing(), 0);
  EXPECT_EQ(admission.waiting(), 0);
  EXPECT_FALSE(admission.full());
}

}  // namespace
}  // namespace papilio
