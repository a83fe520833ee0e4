#pragma once

#include <cstdint>

// What the modules share (runtime.cpp): memory, and errors, which WebAssembly without exceptions cannot unwind. An
// error is handed to the caller, who throws one of its own through all of the module, and gives the instance up.

#define PAPILIO_EXPORTED(name) [[clang::export_name(#name), gnu::used]]
#define PAPILIO_IMPORTED(name) [[clang::import_module("papilio"), clang::import_name(#name)]]

extern "C" {

/// Throws in the caller's language. `fault` is a papilio_fault (client/c/papilio.h). The texts end with 0.
PAPILIO_IMPORTED(fault) [[noreturn]] void caller_fault(int32_t fault, const char* message, const char* parameter);

}  // extern "C"
