#include "client/wasm/runtime.h"

#include <cstdlib>
#include <new>

#include "client/c/papilio.h"
#include "papilio/buffer.h"

extern "C" {

/// Allocates memory for data that the caller writes.
PAPILIO_EXPORTED(allocate) void* module_allocate(size_t bytes) { return ::operator new(bytes); }
PAPILIO_EXPORTED(release) void module_release(void* block) { ::operator delete(block); }

}  // extern "C"

namespace {

void* allocate(size_t bytes, size_t alignment) {
  while (true) {
    // aligned_alloc requires a multiple of the alignment.
    const size_t whole = (bytes + alignment - 1) / alignment * alignment;
    if (void* block = whole < bytes ? nullptr : std::aligned_alloc(alignment, whole)) return block;
    if (papilio::spare_bytes() == 0)
      caller_fault(PAPILIO_OUT_OF_MEMORY, "There is not enough memory for this result. Ask for fewer levels.", "");
    papilio::release_spare_blocks();
  }
}

}  // namespace

void* operator new(size_t bytes) { return allocate(bytes, alignof(std::max_align_t)); }
void* operator new(size_t bytes, std::align_val_t alignment) { return allocate(bytes, static_cast<size_t>(alignment)); }
void operator delete(void* block) noexcept { std::free(block); }
void operator delete(void* block, size_t /*bytes*/) noexcept { std::free(block); }
void operator delete(void* block, std::align_val_t /*alignment*/) noexcept { std::free(block); }

// Called by the standard library where it would throw or end the program.
void std::__libcpp_verbose_abort(const char* /*format*/, ...) {
  caller_fault(PAPILIO_INTERNAL, "The standard library has met a bug.", "");
}
extern "C" void abort_message(const char* /*format*/, ...) {
  caller_fault(PAPILIO_INTERNAL, "The standard library has met a bug.", "");
}

// Called by `throw` before the exception is constructed; each module defines its own __cxa_throw.
extern "C" void* __cxa_allocate_exception(size_t bytes) { return ::operator new(bytes); }

// Called with the destructors of static objects, which are never destroyed.
extern "C" int __cxa_atexit(void (* /*destroy*/)(void*), void* /*object*/, void* /*module*/) { return 0; }
