// A number that tells texts apart: FNV-1a, 64 bits (Fowler, Noll and Vo 1991).
#pragma once

#include <cstdint>
#include <string_view>

namespace sprung {

/// Texts that differ in one byte have different fingerprints; other differences almost always show.
class Fingerprint {
 public:
  void add(std::string_view bytes) {
    for (const char byte : bytes) value_ = (value_ ^ static_cast<unsigned char>(byte)) * 0x100000001b3U;
  }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325U;
};

[[nodiscard]] inline std::uint64_t fingerprint_of(std::string_view bytes) {
  Fingerprint fingerprint;
  fingerprint.add(bytes);
  return fingerprint.value();
}

}  // namespace sprung
