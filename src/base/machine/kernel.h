// Hot loops compiled twice, for the baseline machine and for AVX2, and chosen at run time; a few also for the eight lanes of
// AVX-512. The whole program keeps the baseline ABI, which libfcl needs, and contraction is off, so all versions compute the same
// bits.
#pragma once

#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__OPTIMIZE__) && !defined(__SANITIZE_THREAD__) && \
    !defined(__SANITIZE_ADDRESS__)
#define SPRUNG_KERNEL __attribute__((target_clones("avx2", "default")))
#define SPRUNG_WIDE_KERNEL __attribute__((target("arch=x86-64-v4")))
#else
#define SPRUNG_KERNEL
#define SPRUNG_WIDE_KERNEL
#endif

namespace sprung {

/// Whether this machine supports the target of SPRUNG_WIDE_KERNEL.
[[nodiscard]] inline bool has_wide_lanes() {
#if defined(__GNUC__) && defined(__x86_64__)
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd") &&
         __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
#else
  return false;
#endif
}

}  // namespace sprung
