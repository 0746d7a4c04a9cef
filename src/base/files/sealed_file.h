// Binary files whose damage shows when they are read.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace sprung {

/// The first bytes of a sealed file: its kind, and the program that wrote it.
struct Seal {
  std::string_view kind;      ///< 8 letters
  std::string_view what;      ///< in messages: `a checkpoint of sprung`
  std::string_view version;   ///< of the layout of the bytes and of the program; others are refused
  std::string_view remedy{};  ///< in messages, if the file cannot be used
};

/// The bytes of a file with this seal: kind, version, size of the content, content, and the FNV-1a fingerprint of all before it.
[[nodiscard]] std::string sealed(const Seal& seal, std::string_view content);

/// The content of a sealed file. Throws FileError that tells in one line which is true: the file cannot be read, is of another
/// kind, was written by another version (both are named), is truncated, or is damaged. Every change of one bit is found.
[[nodiscard]] std::string read_sealed(const std::filesystem::path& file, const Seal& seal);

}  // namespace sprung
