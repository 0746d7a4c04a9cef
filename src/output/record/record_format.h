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

/// What the names of the arrays of a body, an obstacle and a deforming obstacle begin with.
[[nodiscard]] inline std::string body_arrays(std::size_t body) { return "bodies/" + std::to_string(body) + "/"; }
[[nodiscard]] inline std::string obstacle_arrays(std::size_t obstacle) { return "obstacles/" + std::to_string(obstacle) + "/"; }
[[nodiscard]] inline std::string deformed_array(std::size_t deforming) { return "deformed/" + std::to_string(deforming); }

}  // namespace sprung
