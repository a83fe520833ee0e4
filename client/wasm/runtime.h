#pragma once

#include <cstdint>

// Runtime shared by the modules (runtime.cpp): memory and errors, which WebAssembly without exceptions cannot unwind.
// An error is passed to the caller, which throws its own exception through the module and discards the instance.

#define PAPILIO_EXPORTED(name) [[clang::export_name(#name), gnu::used]]
#define PAPILIO_IMPORTED(name) [[clang::import_module("papilio"), clang::import_name(#name)]]

extern "C" {

/// Throws in the caller's language. `fault` is a papilio_fault (client/c/papilio.h). The texts end with 0.
PAPILIO_IMPORTED(fault) [[noreturn]] void caller_fault(int32_t fault, const char* message, const char* parameter);

}  // extern "C"
