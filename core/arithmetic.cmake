# The same arithmetic everywhere, so that results agree to the bit on every machine: no contraction into fused
# multiply-adds. Nobody reads the errno of a root: without it several are taken at once.
set(PAPILIO_ARITHMETIC -ffp-contract=off -fno-math-errno)
# GCC 12 at -O1, as under sanitizers, leaves out stores that are read (unit normals in hierarchy/allowed_distance.cpp)
# where it goes by what it thinks that functions change.
list(APPEND PAPILIO_ARITHMETIC
  "$<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-fno-ipa-modref>")
