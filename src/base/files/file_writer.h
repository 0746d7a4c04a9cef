// Writes files such that an error, as a full disk or a missing permission, leaves no partial file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace sprung {

/// The hidden temporary name, in the same folder, under which `file` is written first.
[[nodiscard]] std::filesystem::path temporary_path(const std::filesystem::path& file);

/// Whether a file is on the disk when a call returns, or may still be lost if the machine stops.
enum class Durability : std::uint8_t { later, now };

/// Writes a file under its temporary name and renames it, replacing an existing file. Creates missing folders. With
/// Durability::now, all that was written to its file system before is on the disk first. Throws FileError; the existing file is
/// then unchanged, and no temporary file and no empty new folder remains.
void write_file(const std::filesystem::path& file, std::string_view text, Durability durability = Durability::later);

/// Appends to a file and creates it if missing. Returns its size before. Throws FileError; the file is then unchanged.
std::uintmax_t append_to_file(const std::filesystem::path& file, std::string_view text);

/// Creates a folder and its parents. Throws FileError.
void make_folder(const std::filesystem::path& folder);

}  // namespace sprung
