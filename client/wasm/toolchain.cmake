# For CMAKE_TOOLCHAIN_FILE: Debian's clang, its C library for WebAssembly (wasi-libc) and its C++ library.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR wasm32)
set(CMAKE_C_COMPILER clang-19)
set(CMAKE_CXX_COMPILER clang++-19)
set(CMAKE_C_COMPILER_TARGET wasm32-wasi)
set(CMAKE_CXX_COMPILER_TARGET wasm32-wasi)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
# Archives without an index, which the linker does not need: of LLVM's there may be an older one, which cannot read these
# objects to make it.
set(CMAKE_AR /usr/bin/ar)
set(CMAKE_CXX_ARCHIVE_CREATE "<CMAKE_AR> qcS <TARGET> <OBJECTS>")
set(CMAKE_CXX_ARCHIVE_FINISH "")
set(CMAKE_CXX_FLAGS_INIT "-msimd128 -fignore-exceptions -flto")
set(CMAKE_EXE_LINKER_FLAGS_INIT
  "-O0 -mexec-model=reactor -Wl,--gc-sections -Wl,--strip-all -Wl,-z,stack-size=1048576")
