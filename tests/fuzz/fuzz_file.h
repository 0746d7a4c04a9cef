// What all fuzz programs share: a file for readers that want a path, and laws that stop the program when they are broken.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

namespace sprung::fuzz {

/// A file of this process alone, in a folder that the process removes when it ends.
[[nodiscard]] std::filesystem::path own_file(const std::string& name);

/// Writes the bytes to the file. Aborts when that fails.
void write_bytes(const std::filesystem::path& file, const void* bytes, std::size_t size);

/// Prints the law and aborts unless it holds, so that libFuzzer keeps the input.
void require(bool holds, const char* law);

}  // namespace sprung::fuzz
