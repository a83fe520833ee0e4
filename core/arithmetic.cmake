# The same arithmetic everywhere, so that results agree to the bit on every machine: no contraction into fused
# multiply-adds. Nobody reads the errno of a root: without it several are taken at once.
set(PAPILIO_ARITHMETIC -ffp-contract=off -fno-math-errno)
