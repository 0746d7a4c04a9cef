#include "geometry/import/text_words.h"
#include "geometry/tetrahedra/tetrahedra_file.h"

#include <algorithm>
#include <iterator>

namespace sprung {
namespace {

constexpr std::int64_t kTetrahedron = 4;
// Points, lines, triangles and quadrangles of all orders that Gmsh numbers below 29.
constexpr std::int64_t kFlatTypes[] = {1, 2, 3, 8, 9, 10, 15, 16, 20, 21, 22, 23, 24, 25, 26, 27, 28};

class GmshReader {
 public:
  GmshReader(const std::filesystem::path& file, std::string_view text) : lines_(file, text) {}

  TetrahedraMesh read() {
    const bool version_4 = read_format();
    bool has_nodes = false;
    bool has_elements = false;
    while (lines_.next()) {
      const std::string section(lines_.word(0));
      if (section == "$Nodes") {
        version_4 ? read_node_blocks() : read_nodes();
        end_section(section);
        has_nodes = true;
      } else if (section == "$Elements") {
        version_4 ? read_element_blocks() : read_elements();
        end_section(section);
        has_elements = true;
      } else if (section.starts_with('$')) {
        skip_section(section);
      } else {
        lines_.stop(section, "must begin a section, as $Nodes does");
      }
    }
    if (!has_nodes || !has_elements) {
      lines_.problems().add("", "", std::string("has no section ") + (has_nodes ? "$Elements" : "$Nodes"), "export it again");
      lines_.problems().throw_if_any();
    }
    refused_.report(lines_.problems(), "must be 4, a tetrahedron of four corners, or a cell without volume",
                    "mesh with tetrahedra of the first order alone");
    return assemble(found_, lines_.problems(), lines_.problems());
  }

 private:
  /// Whether the version is 4.1, not 2.2.
  bool read_format() {
    if (!lines_.next() || lines_.word(0) != "$MeshFormat") {
      lines_.stop(lines_.word(0), "must be $MeshFormat, as Gmsh files begin", "save it as version 2.2 or 4.1");
    }
    lines_.next();
    const std::string version(lines_.word(0));
    if (version != "2.2" && version != "4.1") {
      lines_.stop(version, "must be version 2.2 or 4.1", "save it with `gmsh -save -format msh41 FILE`");
    }
    if (lines_.word(1) != "0") {
      lines_.stop("", "is a binary file, of which only text is read",
                  "save it as text with `gmsh -save -format " + std::string(version == "2.2" ? "msh22" : "msh41") +
                      " -setnumber Mesh.Binary 0 FILE`");
    }
    end_section("$MeshFormat");
    return version == "4.1";
  }

  void end_section(const std::string& section) {
    if (lines_.next() && lines_.word(0) == "$End" + section.substr(1)) return;
    if (lines_.words().empty()) truncated(section);
    lines_.stop(lines_.word(0), "must be $End" + section.substr(1) + ", as the counts of the section say");
  }

  void skip_section(const std::string& section) {
    while (lines_.next()) {
      if (lines_.word(0) == "$End" + section.substr(1)) return;
    }
    truncated(section);
  }

  [[noreturn]] void truncated(const std::string& section) {
    lines_.stop("", "is truncated: the section " + section + " has no end");
  }

  /// The next line of a section.
  void next_of(const std::string& section) {
    if (!lines_.next()) truncated(section);
    if (lines_.word(0).starts_with('$')) lines_.stop(lines_.word(0), "comes too early: " + section + " declares more lines");
  }

  void read_nodes() {
    next_of("$Nodes");
    const std::int64_t nodes = lines_.count(lines_.word(0), "nodes");
    for (std::int64_t i = 0; i < nodes; ++i) {
      next_of("$Nodes");
      const std::int64_t number = lines_.integer(lines_.word(0));
      found_.nodes.push_back({number, lines_.position(1), lines_.line()});
    }
  }

  void read_node_blocks() {
    next_of("$Nodes");
    const std::int64_t blocks = lines_.count(lines_.word(0), "blocks");
    const std::int64_t nodes = lines_.count(lines_.word(1), "nodes");
    for (std::int64_t block = 0; block < blocks; ++block) {
      next_of("$Nodes");
      const std::int64_t in_block = lines_.count(lines_.word(3), "nodes in the block");
      const std::size_t first = found_.nodes.size();
      for (std::int64_t i = 0; i < in_block; ++i) {
        next_of("$Nodes");
        found_.nodes.push_back({lines_.integer(lines_.word(0)), Vector3::Zero(), lines_.line()});
      }
      for (std::int64_t i = 0; i < in_block; ++i) {
        next_of("$Nodes");
        found_.nodes[first + static_cast<std::size_t>(i)].position = lines_.position(0);
      }
    }
    check_total("nodes", nodes, std::ssize(found_.nodes));
  }

  // A line has the number of the element, its type, its number of tags, the tags and the nodes.
  void read_elements() {
    next_of("$Elements");
    const std::int64_t elements = lines_.count(lines_.word(0), "elements");
    for (std::int64_t i = 0; i < elements; ++i) {
      next_of("$Elements");
      const std::int64_t tags = lines_.integer(lines_.word(2));
      add_element(lines_.integer(lines_.word(1)), static_cast<std::size_t>(std::clamp<std::int64_t>(tags, 0, 1 << 20)) + 3);
    }
  }

  void read_element_blocks() {
    next_of("$Elements");
    const std::int64_t blocks = lines_.count(lines_.word(0), "blocks");
    const std::int64_t elements = lines_.count(lines_.word(1), "elements");
    std::int64_t found = 0;
    for (std::int64_t block = 0; block < blocks; ++block) {
      next_of("$Elements");
      const std::int64_t type = lines_.integer(lines_.word(2));
      const std::int64_t in_block = lines_.count(lines_.word(3), "elements in the block");
      for (std::int64_t i = 0; i < in_block; ++i) {
        next_of("$Elements");
        add_element(type, 1);
      }
      found += in_block;
    }
    check_total("elements", elements, found);
  }

  void add_element(std::int64_t type, std::size_t first_node) {
    if (type != kTetrahedron) {
      if (std::find(std::begin(kFlatTypes), std::end(kFlatTypes), type) == std::end(kFlatTypes)) refused_.add(type, lines_.line());
      return;
    }
    if (lines_.words().size() != first_node + 4) return lines_.report("", "a tetrahedron must have four nodes");
    TetrahedraLines::Element& element = found_.elements.emplace_back();
    element.line = lines_.line();
    for (std::size_t c = 0; c < 4; ++c) element.nodes[c] = lines_.integer(lines_.word(first_node + c));
  }

  void check_total(const std::string& things, std::int64_t declared, std::int64_t found) {
    if (declared == found) return;
    lines_.report(std::to_string(found) + " " + things, "must be " + std::to_string(declared) + ", as the section declares");
  }

  WordLines lines_;
  TetrahedraLines found_;
  RefusedCells refused_;
};

}  // namespace

TetrahedraMesh read_gmsh(const std::filesystem::path& file) {
  const std::string text = read_mesh_text(file);
  return GmshReader(file, text).read();
}

}  // namespace sprung
