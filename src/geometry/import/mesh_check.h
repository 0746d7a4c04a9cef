// Checks mesh files before assimp reads them. assimp trusts the counts and indices of a file: it reads past the end of truncated
// files, aborts at faces without corners, and follows indices out of range and cyclic nodes. So each file is read here first and
// written anew with only its surface: no materials, names or animations.
#pragma once

#include "base/types.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sprung {

/// The bytes of a mesh file that assimp can read.
struct CheckedFile {
  std::string extension;  ///< of the format, without its dot
  std::string bytes;
  std::vector<Vector3> positions{};  ///< of the vertices of a PLY file, because assimp rounds them to floats
};

/// Largest number of corners of a face. No exporter writes larger faces, and the run time of assimp's triangulation is quadratic
/// in this number.
inline constexpr std::int64_t kMostCorners = 10'000;
inline constexpr const char* kMostCornersRule = "a face must have at most 10000 corners";

/// Writes a surface as PLY, with positions as floats, and keeps the exact positions beside it.
class PlyWriter {
 public:
  void add_vertex(const Vector3& position);

  /// Leaves out points and lines. Requires corners in [0, 2^31).
  void add_face(std::span<const std::int64_t> corners);

  /// Leaves the writer empty.
  [[nodiscard]] CheckedFile finish();

 private:
  std::vector<Vector3> positions_;
  std::string faces_;
  std::size_t face_count_ = 0;
};

/// The double nearest to the number that the word spells; none unless it is finite.
[[nodiscard]] std::optional<double> finite_number(std::string_view word);

/// The position that the first three words spell; none unless there are three finite numbers.
[[nodiscard]] std::optional<Vector3> finite_position(std::span<const std::string_view> words);

// Each function throws InputError that names the location if the file is shorter than it declares, a number is malformed, a face
// has no corners or an index is out of range.

[[nodiscard]] CheckedFile checked_obj(const std::filesystem::path& file, const std::string& bytes);

[[nodiscard]] CheckedFile checked_ply(const std::filesystem::path& file, const std::string& bytes);

/// Refuses binary files, other dimensions and homogeneous coordinates.
[[nodiscard]] CheckedFile checked_off(const std::filesystem::path& file, const std::string& text);

[[nodiscard]] CheckedFile checked_stl(const std::filesystem::path& file, const std::string& bytes);

/// glTF 2.0 as text or binary, with embedded or separate buffers. Refuses compressed meshes.
[[nodiscard]] CheckedFile checked_gltf(const std::filesystem::path& file, const std::string& bytes);

[[nodiscard]] CheckedFile checked_3ds(const std::filesystem::path& file, const std::string& bytes);

}  // namespace sprung
