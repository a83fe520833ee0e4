// C functions as a WebAssembly module. Callers write arrays into its memory, and read results from it.

#include <new>
#include <typeinfo>

#include "client/c/failure.h"
#include "client/c/papilio.h"
#include "client/wasm/runtime.h"

using papilio::c::Failure;

extern "C" {

/// Returns whether to stop.
PAPILIO_IMPORTED(cancelled) int32_t caller_cancelled();
/// Receives a level.
PAPILIO_IMPORTED(level) void caller_level(const papilio_triangles* mesh, const papilio_statistics* statistics);

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

}  // namespace

// Empty virtual tables of the standard library's type_info classes, by which `catch` and dynamic_cast find the bases of
// a type. This module only compares types, so that the code behind the tables is not linked.
extern "C" {

extern const void* const class_type_table[3] __asm__("_ZTVN10__cxxabiv117__class_type_infoE");
extern const void* const single_type_table[3] __asm__("_ZTVN10__cxxabiv120__si_class_type_infoE");
extern const void* const multiple_type_table[3] __asm__("_ZTVN10__cxxabiv121__vmi_class_type_infoE");
const void* const class_type_table[3] = {};
const void* const single_type_table[3] = {};
const void* const multiple_type_table[3] = {};

}  // extern "C"

// Called by `throw`.
extern "C" {

[[noreturn]] void __cxa_throw(void* thrown, std::type_info* type, void* (* /*destructor*/)(void*)) {
  using papilio::c::failure_of;
  if (*type == typeid(papilio::proto::Problem)) hand_over(failure_of(*static_cast<papilio::proto::Problem*>(thrown)));
  if (*type == typeid(papilio::Error)) hand_over(failure_of(*static_cast<papilio::Error*>(thrown)));
  if (*type == typeid(std::bad_alloc) || *type == typeid(std::length_error)) hand_over(papilio::c::lack_of_memory());
  caller_fault(PAPILIO_INTERNAL, type->name(), "");
}

}  // extern "C"
