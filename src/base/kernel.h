// Hot loops compiled once for the baseline machine and once for AVX2, chosen at run time. The whole program keeps the
// baseline ABI, which libfcl needs, and contraction is off, so both versions compute the same bits.
#pragma once

#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__OPTIMIZE__) && !defined(__SANITIZE_THREAD__) && \
    !defined(__SANITIZE_ADDRESS__)
#define SPRUNG_KERNEL __attribute__((target_clones("avx2", "default")))
#else
#define SPRUNG_KERNEL
#endif
