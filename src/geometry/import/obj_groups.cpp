#include "geometry/import/obj_groups.h"

#include "geometry/import/mesh_file.h"
#include "geometry/import/obj_numbers.h"
#include "geometry/import/text_words.h"

#include <algorithm>
#include <string_view>

namespace sprung {
namespace {

class GroupReader {
 public:
  void add(std::string_view line) {
    split_words(line, words_);
    if (words_.empty()) return;
    const std::string_view kind = words_[0];
    if (kind == "v") ++vertices_so_far_;
    if (kind == "g") groups_.assign(words_.begin() + 1, words_.end());
    if (kind == "o") object_ = name();
    if (kind == "usemtl") material_ = name();
    if (kind == "f" || kind == "l" || kind == "p") add_element();
  }

  ObjGroups finish() {
    for (auto& named : found_) {
      for (std::vector<Index>* numbers : {&named.second.vertices, &named.second.faces, &named.second.lines}) {
        std::ranges::sort(*numbers);
        numbers->erase(std::unique(numbers->begin(), numbers->end()), numbers->end());
      }
    }
    return std::move(found_);
  }

 private:
  /// The words after the first: names of objects and materials may have blanks.
  [[nodiscard]] std::string name() const {
    std::string joined;
    for (std::size_t word = 1; word < words_.size(); ++word) {
      if (word > 1) joined += ' ';
      joined += words_[word];
    }
    return joined;
  }

  void add_element() {
    vertices_.clear();
    for (std::size_t word = 1; word < words_.size(); ++word) {
      const Index written = parse_number<Index>(words_[word].substr(0, words_[word].find('/'))).value_or(0);
      if (written != 0) vertices_.push_back(written > 0 ? written - 1 : vertices_so_far_ + written);
    }
    const auto segments = words_[0] == "l" ? static_cast<Index>(vertices_.size()) - 1 : 0;
    for (const std::string& group : groups_) append(group, segments);
    append(object_, segments);
    append(material_, segments);
    if (words_[0] == "f") ++faces_so_far_;
    lines_so_far_ += segments;
  }

  /// A line of n vertices is n - 1 lines of the mesh.
  void append(const std::string& name, Index segments) {
    if (name.empty()) return;
    ObjGroup& group = found_[name];
    group.vertices.insert(group.vertices.end(), vertices_.begin(), vertices_.end());
    if (words_[0] == "f") group.faces.push_back(faces_so_far_);
    for (Index k = 0; k < segments; ++k) group.lines.push_back(lines_so_far_ + k);
  }

  ObjGroups found_;
  std::vector<std::string> groups_;
  std::string object_;
  std::string material_;
  Index vertices_so_far_ = 0;
  Index faces_so_far_ = 0;
  Index lines_so_far_ = 0;
  std::vector<std::string_view> words_;
  std::vector<Index> vertices_;  // of the present element
};

}  // namespace

ObjGroups read_obj_groups(const std::filesystem::path& file) {
  const std::string text = plain_obj_text(read_mesh_text(file));
  GroupReader reader;
  for (std::string_view rest = text; !rest.empty();) reader.add(take_line(rest));
  return reader.finish();
}

}  // namespace sprung
