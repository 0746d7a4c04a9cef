#include "geometry/tetrahedra/tetrahedra_file.h"

namespace sprung {
namespace {

/// The lines of one of the two files. `things` are what it declares the number of.
class TetgenLines {
 public:
  TetgenLines(const std::filesystem::path& file, std::string_view text, std::string things)
      : lines_(file, text, '#'), things_(std::move(things)) {}

  /// Reads the first line. `second` is the number that must follow the count; empty: any.
  void begin(const std::string& rule, std::string_view second, const std::string& remedy) {
    if (!lines_.next()) lines_.stop("", "has nothing but comments");
    count_ = lines_.count(lines_.word(0), things_);
    if (lines_.words().size() > 1 && lines_.word(1) != second) lines_.stop(lines_.word(1), rule, remedy);
  }

  /// Calls `read` on each line.
  template <class Read>
  void each(const Read& read) {
    for (std::int64_t i = 0; i < count_; ++i) {
      if (!lines_.next()) {
        lines_.stop("",
                    "is truncated: it declares " + std::to_string(count_) + " " + things_ + " but contains " + std::to_string(i));
      }
      read(lines_);
    }
    if (lines_.next()) lines_.stop(lines_.word(0), "must not follow: the file declares " + std::to_string(count_) + " " + things_);
  }

  [[nodiscard]] FileProblems& problems() { return lines_.problems(); }

 private:
  WordLines lines_;
  std::string things_;
  std::int64_t count_ = 0;
};

std::string read_half(const std::filesystem::path& file, const std::filesystem::path& named) {
  if (file != named && !std::filesystem::exists(file)) {
    throw InputError(Problem{.file = file.string(),
                             .rule = "does not exist, but belongs to " + named.filename().string(),
                             .remedy = "TetGen writes both files; put it beside the other"});
  }
  return read_mesh_text(file);
}

}  // namespace

TetrahedraMesh read_tetgen(const std::filesystem::path& file) {
  std::filesystem::path node_file = file;
  std::filesystem::path element_file = file;
  if (lower_case_extension(file) == ".node") element_file.replace_extension(".ele");
  if (lower_case_extension(file) == ".ele") node_file.replace_extension(".node");
  const std::string node_text = read_half(node_file, file);
  const std::string element_text = read_half(element_file, file);

  TetrahedraLines found;
  TetgenLines nodes(node_file, node_text, "nodes");
  nodes.begin("must be 3, the number of coordinates of a node", "3", "export a mesh of volumes");
  nodes.each([&](WordLines& line) {
    const std::int64_t number = line.integer(line.word(0));
    found.nodes.push_back({number, line.position(1), line.line()});
  });
  TetgenLines elements(element_file, element_text, "tetrahedra");
  elements.begin("must be 4, the number of corners of a tetrahedron", "4", "run TetGen without -o2");
  elements.each([&](WordLines& line) {
    if (line.words().size() < 5) return line.report("", "a tetrahedron must have four nodes");
    TetrahedraLines::Element& element = found.elements.emplace_back();
    element.line = line.line();
    for (std::size_t c = 0; c < 4; ++c) element.nodes[c] = line.integer(line.word(c + 1));
  });
  return assemble(found, nodes.problems(), elements.problems());
}

}  // namespace sprung
