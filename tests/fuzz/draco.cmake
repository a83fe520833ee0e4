# Draco from the source of Debian's package (tests/support/library_source.sh), instrumented, so that the fuzzer
# measures coverage of the decoder. Without undefined-behaviour checks: its arithmetic overflows on damaged streams.
# Without the transcoder, which is not used.

file(READ /usr/include/draco/draco_features.h FEATURES)
string(REPLACE "#define DRACO_TRANSCODER_SUPPORTED" "" FEATURES "${FEATURES}")
file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/draco/draco/draco_features.h CONTENT "${FEATURES}" @ONLY)

file(GLOB_RECURSE DRACO_SOURCES ${DRACO_SOURCE}/src/draco/*.cc)
list(FILTER DRACO_SOURCES INCLUDE REGEX "/draco/(attributes|compression|core|mesh|metadata|point_cloud)/")
list(FILTER DRACO_SOURCES EXCLUDE REGEX "_test|test_")
add_library(draco_instrumented STATIC EXCLUDE_FROM_ALL ${DRACO_SOURCES})
target_include_directories(draco_instrumented SYSTEM PUBLIC ${CMAKE_BINARY_DIR}/draco ${DRACO_SOURCE}/src)
target_compile_options(draco_instrumented PRIVATE -w -fsanitize=address,fuzzer-no-link -fno-omit-frame-pointer)
add_library(draco::draco ALIAS draco_instrumented)
