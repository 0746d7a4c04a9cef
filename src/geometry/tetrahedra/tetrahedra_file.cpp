#include "geometry/tetrahedra/tetrahedra_file.h"

#include "geometry/import/text_words.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>
#include <utility>

namespace sprung {
namespace {

// A tetrahedron is flat if its volume is at most this fraction of the cube of its longest edge: more than the rounding errors of
// the volume, and far less than the least regular tetrahedra of meshing programs have.
constexpr double kFlat = 1e-10;

std::string line_key(std::size_t line) { return "line " + std::to_string(line); }

std::string first_of(const std::string& first, std::size_t count) {
  return count > 1 ? first + " (and " + std::to_string(count - 1) + " more)" : first;
}

/// Finds nodes by their numbers.
class NodeNumbers {
 public:
  NodeNumbers(const std::vector<TetrahedraLines::Node>& nodes, FileProblems& problems) {
    for (std::size_t i = 0; i < nodes.size(); ++i) entries_.push_back({nodes[i].number, static_cast<Index>(i)});
    std::sort(entries_.begin(), entries_.end(),
              [](const Entry& a, const Entry& b) { return a.number != b.number ? a.number < b.number : a.node < b.node; });
    for (std::size_t i = 1; i < entries_.size(); ++i) {
      if (entries_[i].number != entries_[i - 1].number) continue;
      problems.add(line_key(nodes[entries_[i].node].line), std::to_string(entries_[i].number),
                   "is the number of another node too, on line " + std::to_string(nodes[entries_[i - 1].node].line));
    }
  }

  /// kNone if there is no such node.
  [[nodiscard]] Index find(std::int64_t number) const {
    const auto found =
        std::lower_bound(entries_.begin(), entries_.end(), number, [](const Entry& e, std::int64_t n) { return e.number < n; });
    return found != entries_.end() && found->number == number ? found->node : kNone;
  }

 private:
  struct Entry {
    std::int64_t number;
    Index node;
  };
  std::vector<Entry> entries_;
};

/// The tetrahedra by indices of nodes. Those that cannot be are problems.
std::vector<std::array<Index, 4>> resolve(const TetrahedraLines& lines, FileProblems& of_nodes, FileProblems& of_elements) {
  const NodeNumbers numbers(lines.nodes, of_nodes);
  std::vector<std::array<Index, 4>> tetrahedra;
  tetrahedra.reserve(lines.elements.size());
  for (const TetrahedraLines::Element& element : lines.elements) {
    std::array<Index, 4>& corners = tetrahedra.emplace_back();
    for (std::size_t c = 0; c < 4; ++c) {
      corners[c] = numbers.find(element.nodes[c]);
      if (corners[c] == kNone) {
        of_elements.add(line_key(element.line), std::to_string(element.nodes[c]),
                        "must be the number of one of the " + std::to_string(lines.nodes.size()) + " nodes");
      } else if (std::find(corners.begin(), corners.begin() + c, corners[c]) != corners.begin() + c) {
        of_elements.add(line_key(element.line), std::to_string(element.nodes[c]), "a tetrahedron must not use a node twice");
      }
    }
  }
  return tetrahedra;
}

TetrahedraMesh without_unused(const TetrahedraLines& lines, std::vector<std::array<Index, 4>> tetrahedra) {
  std::vector<Index> renumbered(lines.nodes.size(), kNone);
  for (const auto& corners : tetrahedra) {
    for (const Index corner : corners) renumbered[corner] = 0;
  }
  Index used = 0;
  for (Index& number : renumbered) {
    if (number != kNone) number = used++;
  }
  TetrahedraMesh mesh;
  mesh.vertices.resize(3, used);
  for (std::size_t i = 0; i < renumbered.size(); ++i) {
    if (renumbered[i] != kNone) mesh.vertices.col(renumbered[i]) = lines.nodes[i].position;
  }
  for (auto& corners : tetrahedra) {
    for (Index& corner : corners) corner = renumbered[corner];
  }
  mesh.tetrahedra = std::move(tetrahedra);
  return mesh;
}

double longest_edge(const Points& vertices, const std::array<Index, 4>& corners) {
  double longest = 0.0;
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = a + 1; b < 4; ++b)
      longest = std::max(longest, (vertices.col(corners[b]) - vertices.col(corners[a])).norm());
  }
  return longest;
}

/// Turns the tetrahedra of negative volume. Flat ones are a problem.
void orient(const TetrahedraLines& lines, TetrahedraMesh& mesh, FileProblems& problems) {
  std::size_t flat = 0;
  std::size_t first_line = 0;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    std::array<Index, 4>& corners = mesh.tetrahedra[t];
    const double volume = tetrahedron_volume(mesh.vertices, corners);
    if (!(std::abs(volume) > kFlat * std::pow(longest_edge(mesh.vertices, corners), 3.0))) {
      if (flat++ == 0) first_line = lines.elements[t].line;
    } else if (volume < 0.0) {
      std::swap(corners[2], corners[3]);
    }
  }
  if (flat == 0) return;
  problems.add(line_key(first_line), first_of("a tetrahedron", flat), "must have a volume",
               "remove flat tetrahedra, or mesh again");
}

/// Tetrahedra that share a side must lie on different sides of it.
void check_sides(const TetrahedraLines& lines, const TetrahedraMesh& mesh, FileProblems& problems) {
  const std::vector<TetrahedronSide> sides = tetrahedron_sides(mesh.tetrahedra);
  const auto is_even = [](const TetrahedronSide& side) {
    const auto& [a, b, c] = side.corners;
    return (a < b) == ((b < c) == (a < c));
  };
  std::size_t shared = 0;
  Index first = std::numeric_limits<Index>::max();
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].sorted == sides[begin].sorted) ++end;
    const std::size_t uses = end - begin;
    if (uses == 1 || (uses == 2 && is_even(sides[begin]) != is_even(sides[begin + 1]))) continue;
    ++shared;
    first = std::min(first, sides[end - 1].tetrahedron);
  }
  if (shared == 0) return;
  problems.add(line_key(lines.elements[first].line), first_of("a side", shared),
               "must belong to at most two tetrahedra, on its two sides",
               "remove tetrahedra that overlap or stand in the file twice, as members of two physical groups do");
}

}  // namespace

WordLines::WordLines(const std::filesystem::path& file, std::string_view text, char comment)
    : problems_(file), rest_(text), comment_(comment) {}

bool WordLines::next() {
  next_word_ = 0;
  words_.clear();
  while (!rest_.empty() && words_.empty()) {
    ++line_;
    const std::string_view line = take_line(rest_);
    split_words(comment_ == '\0' ? line : line.substr(0, line.find(comment_)), words_);
  }
  return !words_.empty();
}

void WordLines::skip_line() {
  ++line_;
  (void)take_line(rest_);
}

std::string_view WordLines::next_word() {
  if (next_word_ == words_.size() && !next()) return {};
  return words_[next_word_++];
}

void WordLines::report(std::string_view value, const std::string& rule, const std::string& remedy) {
  problems_.add(line_key(line_), std::string(value), rule, remedy);
}

void WordLines::stop(std::string_view value, const std::string& rule, const std::string& remedy) {
  report(value, rule, remedy);
  problems_.throw_if_any();
  std::abort();  // not reached: there is a problem
}

double WordLines::number(std::string_view word) {
  const std::optional<double> value = parse_number<double>(word);
  if (value && std::isfinite(*value)) return *value;
  report(word, "must be a finite number");
  return 0.0;
}

std::int64_t WordLines::integer(std::string_view word) {
  const std::optional<std::int64_t> value = parse_number<std::int64_t>(word);
  if (!value) report(word, "must be an integer");
  return value.value_or(0);
}

Vector3 WordLines::position(std::size_t first_word) {
  if (words_.size() < first_word + 3) {
    report("", "a node must have three coordinates");
    return Vector3::Zero();
  }
  return {number(words_[first_word]), number(words_[first_word + 1]), number(words_[first_word + 2])};
}

std::int64_t WordLines::count(std::string_view word, const std::string& things) {
  const std::int64_t value = parse_number<std::int64_t>(word).value_or(-1);
  if (value < 0) stop(word, "must be the number of " + things);
  return value;
}

void RefusedCells::add(std::int64_t type, std::size_t line) {
  if (count_++ > 0) return;
  type_ = type;
  line_ = line;
}

void RefusedCells::report(FileProblems& problems, const std::string& rule, const std::string& remedy) const {
  if (count_ > 0) problems.add(line_key(line_), first_of("a cell of type " + std::to_string(type_), count_), rule, remedy);
}

TetrahedraMesh assemble(const TetrahedraLines& lines, FileProblems& of_nodes, FileProblems& of_elements) {
  std::vector<std::array<Index, 4>> tetrahedra = resolve(lines, of_nodes, of_elements);
  of_nodes.throw_if_any();
  of_elements.throw_if_any();
  if (tetrahedra.empty()) {
    of_elements.add("", "", "has no tetrahedra", "mesh the volume, and export all of its elements");
    of_elements.throw_if_any();
  }
  TetrahedraMesh mesh = without_unused(lines, std::move(tetrahedra));
  orient(lines, mesh, of_elements);
  of_elements.throw_if_any();
  check_sides(lines, mesh, of_elements);
  of_elements.throw_if_any();
  return mesh;
}

bool is_tetrahedra_file(const std::filesystem::path& file) {
  const std::string extension = lower_case_extension(file);
  return extension == ".msh" || extension == ".node" || extension == ".ele" || extension == ".vtk";
}

TetrahedraMesh read_tetrahedra(const std::filesystem::path& file) {
  const std::string extension = lower_case_extension(file);
  if (extension == ".msh") return read_gmsh(file);
  if (extension == ".node" || extension == ".ele") return read_tetgen(file);
  if (extension == ".vtk") return read_vtk(file);
  throw InputError(Problem{.file = file.string(),
                           .rule = "tetrahedra are read from .msh (Gmsh), .node and .ele (TetGen) and .vtk files",
                           .remedy = "save the mesh in one of these formats; a surface is a body of type \"mesh\" or \"lattice\""});
}

}  // namespace sprung
