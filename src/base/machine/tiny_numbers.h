// Denormal numbers, which are up to a hundred times slower than others on some machines.
#pragma once

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace sprung {

/// During its lifetime, this thread treats numbers below the least normal number (2^-1022) as zero, if the machine can.
class TinyNumbersAreZero {
 public:
#if defined(__SSE2__)
  TinyNumbersAreZero() { _mm_setcsr(before_ | kFlushResults | kFlushOperands); }
  ~TinyNumbersAreZero() { _mm_setcsr(before_); }
#else
  TinyNumbersAreZero() = default;
  ~TinyNumbersAreZero() = default;
#endif
  TinyNumbersAreZero(const TinyNumbersAreZero&) = delete;
  TinyNumbersAreZero& operator=(const TinyNumbersAreZero&) = delete;

 private:
#if defined(__SSE2__)
  static constexpr unsigned kFlushResults = 0x8000;
  static constexpr unsigned kFlushOperands = 0x0040;
  unsigned before_ = _mm_getcsr();
#endif
};

}  // namespace sprung
