#include "geometry/import/text_words.h"
#include "geometry/tetrahedra/tetrahedra_file.h"

#include <algorithm>
#include <cctype>
#include <iterator>

namespace sprung {
namespace {

constexpr std::int64_t kTetrahedron = 10;
// Vertices, lines and faces of all orders.
constexpr std::int64_t kFlatTypes[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 21, 22, 23, 28, 30, 34, 35, 36, 68, 69, 70, 75, 76, 77};

class VtkReader {
 public:
  VtkReader(const std::filesystem::path& file, std::string_view text) : lines_(file, text) {}

  TetrahedraMesh read() {
    read_header();
    // What is between the arrays, such as METADATA, is skipped; data of points and cells end the mesh.
    while (lines_.next()) {
      const std::string keyword(lines_.word(0));
      if (after_array_ && parse_number<double>(keyword)) lines_.stop(keyword, "is one number more than the file declares");
      after_array_ = true;
      if (keyword == "POINTS") {
        read_points();
      } else if (keyword == "CELLS") {
        read_cells();
      } else if (keyword == "CELL_TYPES") {
        read_types();
      } else if (keyword == "CELL_DATA" || keyword == "POINT_DATA") {
        break;
      } else {
        after_array_ = false;
      }
    }
    join();
    return assemble(found_, lines_.problems(), lines_.problems());
  }

 private:
  struct Cell {
    std::size_t begin = 0;  ///< of its points in cell_points_
    std::size_t end = 0;
    std::size_t line = 0;
  };

  void read_header() {
    if (!lines_.next() || lines_.word(0) != "#" || lines_.word(1) != "vtk") {
      lines_.stop(lines_.word(0), "must begin with `# vtk DataFile Version`",
                  "save it as a legacy VTK file; XML files are not read");
    }
    lines_.skip_line();  // the title
    lines_.next();
    if (lines_.word(0) == "BINARY")
      lines_.stop("", "is a binary file, of which only text is read", "save it with the file type ASCII");
    if (lines_.word(0) != "ASCII") lines_.stop(lines_.word(0), "must be ASCII");
    lines_.next();
    if (lines_.word(0) != "DATASET" || lines_.word(1) != "UNSTRUCTURED_GRID") {
      lines_.stop(lines_.word(1), "must be DATASET UNSTRUCTURED_GRID", "only such a data set has tetrahedra");
    }
  }

  /// The next number of an array; stops at a keyword or at the end.
  std::string_view next_number(const std::string& array) {
    const std::string_view word = lines_.next_word();
    if (word.empty()) lines_.stop("", "is truncated: " + array + " declares more numbers");
    const bool keyword = !parse_number<double>(word) && (std::isalpha(static_cast<unsigned char>(word[0])) != 0);
    if (keyword) lines_.stop(word, "comes too early: " + array + " declares more numbers");
    return word;
  }

  void end_array(const std::string& array) {
    if (!lines_.line_is_read()) lines_.stop(lines_.next_word(), "is one number more than " + array + " declares");
  }

  void begin_array() {
    while (!lines_.line_is_read()) (void)lines_.next_word();
  }

  void read_points() {
    const std::int64_t points = lines_.count(lines_.word(1), "points");
    begin_array();
    for (std::int64_t i = 0; i < points; ++i) {
      TetrahedraLines::Node node{.number = i};
      for (int axis = 0; axis < 3; ++axis) node.position[axis] = lines_.number(next_number("POINTS"));
      node.line = lines_.line();
      found_.nodes.push_back(node);
    }
    end_array("POINTS");
  }

  // Up to version 4 each cell has its number of points, then the points; version 5 has the places where the cells begin, then all
  // points.
  void read_cells() {
    const std::int64_t first = lines_.count(lines_.word(1), "cells");
    const std::int64_t second = lines_.count(lines_.word(2), "numbers of all cells");
    begin_array();
    const std::string_view word = first == 0 && second == 0 ? std::string_view() : lines_.next_word();
    if (word == "OFFSETS") {
      begin_array();
      read_offset_cells(first, second);
    } else if (first > 0) {
      read_counted_cells(first, second, word);
    }
    end_array("CELLS");
  }

  void read_counted_cells(std::int64_t cells, std::int64_t numbers, std::string_view word) {
    std::int64_t read = 0;
    for (std::int64_t i = 0; i < cells; ++i) {
      const std::string_view size = i == 0 ? word : next_number("CELLS");
      const std::size_t line = lines_.line();
      const std::int64_t points = lines_.count(size, "points of a cell");
      read_cell(points, "CELLS");
      cells_.back().line = line;
      read += points + 1;
    }
    if (read != numbers) {
      lines_.report(std::to_string(read) + " numbers", "must be " + std::to_string(numbers) + ", as CELLS declares");
    }
  }

  void read_offset_cells(std::int64_t offsets, std::int64_t numbers) {
    std::vector<std::int64_t> begins;
    for (std::int64_t i = 0; i < offsets; ++i) begins.push_back(lines_.integer(next_number("OFFSETS")));
    const bool rises = std::is_sorted(begins.begin(), begins.end());
    if (begins.empty() || begins.front() != 0 || !rises || begins.back() != numbers) {
      lines_.stop("", "OFFSETS must rise from 0 to " + std::to_string(numbers));
    }
    if (lines_.next_word() != "CONNECTIVITY") lines_.stop("", "OFFSETS must be followed by CONNECTIVITY");
    begin_array();
    for (std::size_t i = 0; i + 1 < begins.size(); ++i) {
      read_cell(begins[i + 1] - begins[i], "CONNECTIVITY");
    }
  }

  void read_cell(std::int64_t points, const std::string& array) {
    const std::size_t begin = cell_points_.size();
    for (std::int64_t p = 0; p < points; ++p) cell_points_.push_back(lines_.integer(next_number(array)));
    cells_.push_back({begin, cell_points_.size(), lines_.line()});
  }

  void read_types() {
    const std::int64_t types = lines_.count(lines_.word(1), "types");
    begin_array();
    for (std::int64_t i = 0; i < types; ++i) {
      types_.push_back(lines_.integer(next_number("CELL_TYPES")));
      type_lines_.push_back(lines_.line());
    }
    end_array("CELL_TYPES");
  }

  void join() {
    if (cells_.size() != types_.size()) {
      lines_.problems().add("", "",
                            "has " + std::to_string(cells_.size()) + " CELLS but " + std::to_string(types_.size()) + " CELL_TYPES",
                            "export it again");
      lines_.problems().throw_if_any();
    }
    RefusedCells refused;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      if (types_[i] != kTetrahedron) {
        const bool flat = std::find(std::begin(kFlatTypes), std::end(kFlatTypes), types_[i]) != std::end(kFlatTypes);
        if (!flat) refused.add(types_[i], type_lines_[i]);
      } else if (const auto& [begin, end, line] = cells_[i]; end - begin != 4) {
        lines_.problems().add("line " + std::to_string(line), std::to_string(end - begin) + " points",
                              "a tetrahedron must have four nodes");
      } else {
        TetrahedraLines::Element& element = found_.elements.emplace_back();
        element.line = line;
        std::copy_n(cell_points_.begin() + static_cast<std::ptrdiff_t>(begin), 4, element.nodes.begin());
      }
    }
    refused.report(lines_.problems(), "must be 10, a tetrahedron of four corners, or a cell without volume",
                   "cut the other cells into tetrahedra, with ParaView's filter Tetrahedralize for example");
  }

  WordLines lines_;
  TetrahedraLines found_;
  std::vector<Cell> cells_;
  std::vector<std::int64_t> cell_points_;
  std::vector<std::int64_t> types_;
  std::vector<std::size_t> type_lines_;
  bool after_array_ = false;
};

}  // namespace

TetrahedraMesh read_vtk(const std::filesystem::path& file) {
  const std::string text = read_mesh_text(file);
  return VtkReader(file, text).read();
}

}  // namespace sprung
