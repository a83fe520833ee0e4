// The C functions as a WebAssembly module. Its callers write arrays into its memory, and read results there.
//
// WebAssembly without exceptions cannot unwind: an error is handed to the caller, who throws one of its own through all
// of this, and gives the instance up.

#include <cstdlib>
#include <new>
#include <typeinfo>

#include "client/c/failure.h"
#include "client/c/papilio.h"
#include "papilio/buffer.h"

using papilio::c::Failure;

#define PAPILIO_EXPORTED(name) [[clang::export_name(#name), gnu::used]]
#define PAPILIO_IMPORTED(name) [[clang::import_module("papilio"), clang::import_name(#name)]]

extern "C" {

/// Throws in the caller's language. The texts end with 0.
PAPILIO_IMPORTED(fault) [[noreturn]] void caller_fault(int32_t fault, const char* message, const char* parameter);
/// Whether to stop.
PAPILIO_IMPORTED(cancelled) int32_t caller_cancelled();
/// Takes a level.
PAPILIO_IMPORTED(level) void caller_level(const papilio_triangles* mesh, const papilio_statistics* statistics);

/// Memory for what the caller writes.
PAPILIO_EXPORTED(allocate) void* module_allocate(size_t bytes) { return ::operator new(bytes); }
PAPILIO_EXPORTED(release) void module_release(void* block) { ::operator delete(block); }

PAPILIO_EXPORTED(mesh_create) papilio_mesh* module_mesh_create(const papilio_triangles* triangles) {
  return papilio_mesh_create(triangles);
}
PAPILIO_EXPORTED(mesh_free) void module_mesh_free(papilio_mesh* mesh) { papilio_mesh_free(mesh); }

PAPILIO_EXPORTED(refine)
papilio_result* module_refine(papilio_mesh* mesh, const char* parameters, int32_t wants_levels) {
  papilio_hooks hooks{};
  hooks.cancelled = [](void*) -> int { return caller_cancelled(); };
  if (wants_levels != 0)
    hooks.on_level = [](void*, const papilio_triangles* level, const papilio_statistics* statistics) {
      caller_level(level, statistics);
    };
  return papilio_refine(mesh, parameters, &hooks);
}
PAPILIO_EXPORTED(result_mesh) const papilio_triangles* module_result_mesh(const papilio_result* result) {
  return papilio_result_mesh(result);
}
PAPILIO_EXPORTED(result_statistics) const papilio_statistics* module_result_statistics(const papilio_result* result) {
  return papilio_result_statistics(result);
}
PAPILIO_EXPORTED(result_free) void module_result_free(papilio_result* result) { papilio_result_free(result); }

}  // extern "C"

namespace {

[[noreturn]] void hand_over(const Failure& failure) {
  caller_fault(failure.fault, failure.message.c_str(), failure.parameter.c_str());
}

void* allocate(size_t bytes, size_t alignment) {
  while (true) {
    // Whole multiples of the alignment, as aligned_alloc wants them.
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

// What the standard library calls where it would throw or end the program.
void std::__libcpp_verbose_abort(const char* /*format*/, ...) {
  caller_fault(PAPILIO_INTERNAL, "The standard library has met a bug.", "");
}
extern "C" void abort_message(const char* /*format*/, ...) {
  caller_fault(PAPILIO_INTERNAL, "The standard library has met a bug.", "");
}

// What `throw` calls.
extern "C" {

void* __cxa_allocate_exception(size_t bytes) { return ::operator new(bytes); }

[[noreturn]] void __cxa_throw(void* thrown, std::type_info* type, void* (* /*destructor*/)(void*)) {
  using papilio::c::failure_of;
  if (*type == typeid(papilio::proto::Problem)) hand_over(failure_of(*static_cast<papilio::proto::Problem*>(thrown)));
  if (*type == typeid(papilio::Error)) hand_over(failure_of(*static_cast<papilio::Error*>(thrown)));
  if (*type == typeid(std::bad_alloc) || *type == typeid(std::length_error)) hand_over(papilio::c::lack_of_memory());
  caller_fault(PAPILIO_INTERNAL, type->name(), "");
}

}  // extern "C"
