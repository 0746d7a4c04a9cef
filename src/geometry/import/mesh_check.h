// Checks mesh files before assimp reads them. assimp trusts the counts and indices of a file: it reads past the end of truncated
// files, aborts at faces without corners, and follows indices out of range and cyclic nodes. So each file is read here first and
// written anew with only its surface: no materials, names or animations.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace sprung {

/// The bytes of a mesh file that assimp can read.
struct CheckedFile {
  std::string extension;  ///< of the format, without its dot
  std::string bytes;
};

/// Largest number of corners of a face. No exporter writes larger faces, and the run time of assimp's triangulation is quadratic
/// in this number.
inline constexpr std::int64_t kMostCorners = 10'000;
inline constexpr const char* kMostCornersRule = "a face must have at most 10000 corners";

/// Writes a surface as PLY. Coordinates are either text, which assimp rounds as in the original format, or floats.
class PlyWriter {
 public:
  enum class Kind : std::uint8_t { ascii, binary };

  explicit PlyWriter(Kind kind, std::string_view x = "float", std::string_view y = "float", std::string_view z = "float");

  /// Requires an ASCII file and words that are finite numbers of the types given to the constructor.
  void add_vertex(std::string_view x, std::string_view y, std::string_view z);

  /// Requires a binary file.
  void add_vertex(float x, float y, float z);

  /// Leaves out points and lines. Requires corners in [0, 2^31).
  void add_face(std::span<const std::int64_t> corners);

  [[nodiscard]] CheckedFile finish() const;

 private:
  Kind kind_;
  std::string types_[3];
  std::string vertices_;
  std::string faces_;
  std::size_t vertex_count_ = 0;
  std::size_t face_count_ = 0;
};

/// Whether the word is a finite number.
[[nodiscard]] bool is_finite_number(std::string_view word);

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
