// Mesh files as assimp may see them. assimp trusts what a file says of itself: it reads past the end of truncated files, aborts at
// faces without corners, follows indices out of range and nodes in circles. So a file is read here first, and written anew with
// the surface alone: no material, no name, no animation, nothing that was not checked.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace sprung {

/// The bytes of a mesh file that assimp reads whole.
struct CheckedFile {
  std::string extension;  ///< of the format, without a dot
  std::string bytes;
};

/// A face with more corners is damage: no exporter writes one, and assimp's triangulation takes the square of their number.
inline constexpr std::int64_t kMostCorners = 10'000;
inline constexpr const char* kMostCornersRule = "a face must have at most 10000 corners";

/// The surface of a file as PLY. Coordinates are either all words, which assimp rounds as it does those of the format they are
/// from, or all floats.
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

/// Whether the word spells a finite number.
[[nodiscard]] bool is_finite_number(std::string_view word);

// Each throws InputError, naming the place, when the file does not hold all that it declares, or a number is malformed, a face has
// no corners or an index is out of range.

[[nodiscard]] CheckedFile checked_obj(const std::filesystem::path& file, const std::string& bytes);

[[nodiscard]] CheckedFile checked_ply(const std::filesystem::path& file, const std::string& bytes);

/// Binary files, files with another dimension and files with homogeneous coordinates are refused.
[[nodiscard]] CheckedFile checked_off(const std::filesystem::path& file, const std::string& text);

[[nodiscard]] CheckedFile checked_stl(const std::filesystem::path& file, const std::string& bytes);

/// glTF 2.0 as text or binary, with its buffers inside or beside it. Compressed meshes are refused.
[[nodiscard]] CheckedFile checked_gltf(const std::filesystem::path& file, const std::string& bytes);

[[nodiscard]] CheckedFile checked_3ds(const std::filesystem::path& file, const std::string& bytes);

}  // namespace sprung
