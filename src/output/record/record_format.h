// What the writer and the reader of record.bin have in common; RECORD.md describes the file.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace sprung {

inline constexpr const char* kRecordFile = "record.bin";
inline constexpr std::string_view kRecordMagic = "sprungrc";
inline constexpr std::uint64_t kRecordVersion = 1;
inline constexpr std::array<const char*, 3> kNumberTypeNames{"u8", "i32", "f64"};  ///< in the order of NumberType

/// What to do about a record that cannot be read.
inline constexpr const char* kDamagedRecordRemedy =
    "restore the file, or run the scene again; if the run has OBJ files, remove record.bin to show these";

/// Prefixes of the names of a body's and an obstacle's arrays; the names of the arrays of an `mtllib` file and of a deforming
/// obstacle.
[[nodiscard]] inline std::string body_arrays(std::size_t body) { return "bodies/" + std::to_string(body) + "/"; }
[[nodiscard]] inline std::string library_array(std::size_t body, std::size_t library) {
  return body_arrays(body) + "libraries/" + std::to_string(library);
}
[[nodiscard]] inline std::string obstacle_arrays(std::size_t obstacle) { return "obstacles/" + std::to_string(obstacle) + "/"; }
[[nodiscard]] inline std::string deformed_array(std::size_t deforming) { return "deformed/" + std::to_string(deforming); }

}  // namespace sprung
