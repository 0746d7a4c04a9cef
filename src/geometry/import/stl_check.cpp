#include "geometry/import/mesh_check.h"
#include "geometry/import/mesh_file.h"
#include "geometry/import/text_words.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <string_view>

namespace sprung {
namespace {

constexpr std::size_t kHeader = 80;
constexpr std::size_t kFacesBegin = kHeader + sizeof(std::uint32_t);
constexpr std::size_t kFace = 50;  // a normal and three corners of three floats each, then two bytes of attributes
constexpr std::size_t kNormal = 12;

bool same_word(std::string_view word, std::string_view lower_case) {
  return std::equal(word.begin(), word.end(), lower_case.begin(), lower_case.end(),
                    [](char a, char b) { return ('A' <= a && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b; });
}

/// Number of faces that a binary file declares.
std::size_t declared_faces(const std::string& bytes) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + kHeader, sizeof(count));
  return count;
}

// ASCII: `facet normal x y z`, `outer loop`, three times `vertex x y z`, `endloop`, `endfacet`. Skips all other words, and the
// names after `solid` and `endsolid`.
class SolidText {
 public:
  SolidText(const std::filesystem::path& file, std::string_view text) : problems_(file), rest_(text) {}

  CheckedFile check() {
    bool inside = false;
    for (std::string_view word = next(); !word.empty(); word = next()) {
      if (same_word(word, "solid") || same_word(word, "endsolid")) {
        inside = same_word(word, "solid");
        skip_line();
      } else if (same_word(word, "vertex")) {
        add_corner();
      } else if (same_word(word, "facet") || same_word(word, "endfacet")) {
        end_face();
      }
    }
    end_face();
    if (inside) problems_.add("", "", "is truncated: its last solid has no end", "export it again");
    problems_.throw_if_any();
    return writer_.finish();
  }

 private:
  void skip_line() {
    if (!line_ended_) (void)take_line(rest_);
    line_ended_ = true;
  }

  // The next word of the text; empty at its end.
  std::string_view next() {
    const auto is_space = [](char c) { return is_blank(c) || c == '\n'; };
    const auto begin = std::find_if_not(rest_.begin(), rest_.end(), is_space);
    const auto end = std::find_if(begin, rest_.end(), is_space);
    rest_ = {end, rest_.end()};
    line_ended_ = false;
    return {begin, end};
  }

  void add_corner() {
    std::array<std::string_view, 3> words;
    for (std::string_view& word : words) word = next();
    corners_.push_back(vertices_++);
    const std::optional<Vector3> position = finite_position(words);
    if (!position) return report("a vertex must have three finite coordinates");
    writer_.add_vertex(*position);
  }

  void end_face() {
    if (corners_.size() == 3) {
      writer_.add_face(corners_);
      ++faces_;
    } else if (!corners_.empty()) {
      report("a facet must have three vertices");
    }
    corners_.clear();
  }

  void report(const std::string& rule) { problems_.add("face " + std::to_string(faces_ + 1), "", rule); }

  FileProblems problems_;
  std::string_view rest_;
  bool line_ended_ = false;
  std::vector<std::int64_t> corners_;
  std::int64_t vertices_ = 0;
  std::int64_t faces_ = 0;
  PlyWriter writer_;
};

CheckedFile faces_of_binary(const std::string& bytes) {
  PlyWriter writer;
  std::array<std::int64_t, 3> corners{0, 1, 2};
  for (std::size_t face = kFacesBegin; face < bytes.size(); face += kFace) {
    std::array<float, 9> x{};
    std::memcpy(x.data(), bytes.data() + face + kNormal, sizeof(x));
    for (std::size_t k = 0; k < x.size(); k += 3) writer.add_vertex({x[k], x[k + 1], x[k + 2]});
    writer.add_face(corners);
    for (std::int64_t& corner : corners) corner += 3;
  }
  return writer.finish();
}

}  // namespace

CheckedFile checked_stl(const std::filesystem::path& file, const std::string& bytes) {
  const bool has_count = bytes.size() >= kFacesBegin;
  if (has_count && bytes.size() == kFacesBegin + kFace * declared_faces(bytes)) return faces_of_binary(bytes);
  std::string_view first = bytes;
  first.remove_prefix(std::min(first.find_first_not_of(" \t\r\n"), first.size()));
  if (same_word(first.substr(0, 5), "solid")) return SolidText(file, bytes).check();
  FileProblems problems(file);
  problems.add("", "",
               has_count ? "is truncated or damaged: it declares " + std::to_string(declared_faces(bytes)) + " faces, which take " +
                               std::to_string(kFacesBegin + kFace * declared_faces(bytes)) + " bytes, and has " +
                               std::to_string(bytes.size())
                         : "must begin with \"solid\", or with the 84 bytes of a binary file",
               "export it again");
  problems.throw_if_any();
  return {};
}

}  // namespace sprung
