// Writes files so that a full disk or a missing permission leaves no partial file behind.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace sprung {

/// The hidden name beside `file` that it is written under first.
[[nodiscard]] std::filesystem::path temporary_path(const std::filesystem::path& file);

/// Writes a whole file under its temporary name and renames it, replacing what was there; makes missing folders. Throws FileError;
/// then the file is as it was before, and neither the temporary file nor an empty new folder remains.
void write_file(const std::filesystem::path& file, std::string_view text);

/// Appends to a file, which is made when missing. Throws FileError; then the file is as it was before.
void append_to_file(const std::filesystem::path& file, std::string_view text);

/// Makes a folder and those above it. Throws FileError.
void make_folder(const std::filesystem::path& folder);

}  // namespace sprung
