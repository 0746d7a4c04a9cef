// A hash of the bits of positions. Two runs with the same hash count as identical.
#pragma once

#include "base/types.h"

#include <bit>
#include <cstdint>

namespace sprung::testing {

/// FNV-1a of the bits of all positions that were added, byte by byte from the lowest.
class PositionHash {
 public:
  void add(const Points& positions) {
    for (const double coordinate : positions.reshaped()) {
      const auto bits = std::bit_cast<std::uint64_t>(coordinate);
      for (int shift = 0; shift < 64; shift += 8) value_ = (value_ ^ ((bits >> shift) & 0xffU)) * 0x100000001b3U;
    }
  }

  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325U;
};

}  // namespace sprung::testing
