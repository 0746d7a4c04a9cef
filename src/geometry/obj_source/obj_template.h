// An OBJ file as text in which only the positions of vertices change, so that it can be written again as it was.
#pragma once

#include "base/types.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace sprung {

class ObjTemplate {
 public:
  /// What becomes of the normals of the file.
  enum class Normals : std::uint8_t {
    as_given,    ///< `vn` lines and the corners of faces stay as they are
    per_vertex,  ///< a `vn` line follows each `v` line, and each corner of a face has the normal of its vertex
  };

  /// Requires the text of a file that `read_obj` accepts.
  ObjTemplate(std::string_view text, Normals normals);

  [[nodiscard]] Index vertex_count() const { return static_cast<Index>(position_at_.size()); }
  [[nodiscard]] Index face_count() const { return static_cast<Index>(faces_.size()); }
  [[nodiscard]] bool writes_normals() const { return !normal_at_.empty(); }
  /// The file without the faces of these numbers, which ascend; a face is an `f` line.
  [[nodiscard]] ObjTemplate without_faces(const std::vector<Index>& removed) const;

  /// The names of `usemtl` lines, each with the number of the first face after it.
  [[nodiscard]] const std::vector<std::pair<std::string, Index>>& face_materials() const { return face_materials_; }

  /// Whether the file has `vn` lines.
  [[nodiscard]] bool has_given_normals() const { return has_given_normals_; }

  /// The file with these positions [m] in its `v` lines, 3 x n; what follows the three numbers, as a colour, stays. `normals`, 3 x
  /// n, are written if `writes_normals()`. Numbers are the shortest that read back to the same bits. The text does not depend on
  /// the number of threads.
  [[nodiscard]] std::string text(const Points& positions, const Points& normals) const;

 private:
  void append(std::string& out, Index begin, Index end, const Points& positions, const Points& normals) const;

  std::string text_;                                        ///< the file without the numbers that change
  std::vector<std::size_t> position_at_;                    ///< where the numbers of each vertex belong
  std::vector<std::size_t> normal_at_;                      ///< where the `vn` line of each vertex belongs, without its end
  std::vector<std::pair<std::size_t, std::size_t>> faces_;  ///< begin and end of each `f` line
  std::vector<std::pair<std::string, Index>> face_materials_;
  bool has_given_normals_ = false;
};

}  // namespace sprung
