// Shared by the readers of tetrahedra. Internal to geometry/tetrahedra/.
#pragma once

#include "geometry/import/mesh_file.h"
#include "geometry/tetrahedra/tetrahedra_mesh.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace sprung {

/// Nodes and tetrahedra as a file has them, with the lines on which they stand.
struct TetrahedraLines {
  struct Node {
    std::int64_t number = 0;  ///< by which tetrahedra refer to it
    Vector3 position = Vector3::Zero();
    std::size_t line = 0;
  };
  struct Element {
    std::array<std::int64_t, 4> nodes{};
    std::size_t line = 0;
  };
  std::vector<Node> nodes;
  std::vector<Element> elements;
};

/// Walks through the lines of a text that have words, and collects its problems.
class WordLines {
 public:
  /// Words from `comment` to the end of a line are ignored; '\0': there are no comments.
  WordLines(const std::filesystem::path& file, std::string_view text, char comment = '\0');

  /// Goes to the next line that has words; false at the end.
  bool next();
  /// Goes over a line, be it blank.
  void skip_line();
  /// The next word, which may stand on a later line; empty at the end. After it, `words` are those of its line.
  std::string_view next_word();
  /// Whether `next_word` will go to another line.
  [[nodiscard]] bool line_is_read() const { return next_word_ == words_.size(); }

  [[nodiscard]] const std::vector<std::string_view>& words() const { return words_; }
  [[nodiscard]] std::string_view word(std::size_t i) const { return i < words_.size() ? words_[i] : std::string_view(); }
  [[nodiscard]] std::size_t line() const { return line_; }
  [[nodiscard]] FileProblems& problems() { return problems_; }

  /// Adds a problem of the present line.
  void report(std::string_view value, const std::string& rule, const std::string& remedy = "");

  /// Adds a problem after which the rest of the file has no meaning, and throws all.
  [[noreturn]] void stop(std::string_view value, const std::string& rule, const std::string& remedy = "export it again");

  /// The number in a word; 0 after a report.
  double number(std::string_view word);
  std::int64_t integer(std::string_view word);
  /// Coordinates in three words of the line; zero after a report.
  Vector3 position(std::size_t first_word);
  /// A number of things that follow. Stops unless it is an integer that is not negative.
  std::int64_t count(std::string_view word, const std::string& things);

 private:
  FileProblems problems_;
  std::string_view rest_;
  char comment_;
  std::vector<std::string_view> words_;
  std::size_t next_word_ = 0;
  std::size_t line_ = 0;
};

/// Cells of a type that cannot be simulated: one problem names the first and counts them.
class RefusedCells {
 public:
  void add(std::int64_t type, std::size_t line);
  void report(FileProblems& problems, const std::string& rule, const std::string& remedy) const;

 private:
  std::int64_t type_ = 0;
  std::size_t line_ = 0;
  std::size_t count_ = 0;
};

/// The mesh. Adds the problems of nodes and of tetrahedra to the lists of their files, and throws if there are any.
[[nodiscard]] TetrahedraMesh assemble(const TetrahedraLines& lines, FileProblems& of_nodes, FileProblems& of_elements);

[[nodiscard]] TetrahedraMesh read_gmsh(const std::filesystem::path& file);
[[nodiscard]] TetrahedraMesh read_tetgen(const std::filesystem::path& file);
[[nodiscard]] TetrahedraMesh read_vtk(const std::filesystem::path& file);

}  // namespace sprung
