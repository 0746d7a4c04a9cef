#include "geometry/import/mesh_check.h"
#include "geometry/import/mesh_file.h"
#include "geometry/import/text_words.h"

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace sprung {
namespace {

class OffChecker {
 public:
  OffChecker(const std::filesystem::path& file, std::string_view text) : problems_(file), rest_(text) {}

  CheckedFile check() {
    if (!next_line() || !words_[0].ends_with("OFF")) {
      problems_.add("", "", "must begin with OFF");
    } else if (words_.size() > 1 && words_[1] == "BINARY") {
      problems_.add("", "", "is binary OFF, which is not read", "export it as text");
    } else if (words_[0].find_first_of("4n") != std::string_view::npos) {
      problems_.add("", std::string(words_[0]), "has vertices of another dimension than 3",
                    "export it with three coordinates a vertex");
    } else {
      check_elements();
    }
    problems_.throw_if_any();
    return writer_.finish();
  }

 private:
  // The next line that is neither blank nor a comment.
  bool next_line() {
    while (!rest_.empty()) {
      ++line_number_;
      const std::string_view line = take_line(rest_);
      split_words(line.substr(0, line.find('#')), words_);
      if (!words_.empty()) return true;
    }
    return false;
  }

  // The counts may follow the keyword on its line.
  void check_elements() {
    words_.erase(words_.begin());
    if (words_.empty() && !next_line()) return problems_.add("", "", "is truncated: the counts of vertices and faces are missing");
    const std::int64_t vertices = count(0);
    const std::int64_t faces = count(1);
    if (vertices < 0 || faces < 0) return report("must begin with the counts of vertices and faces");
    for (std::int64_t i = 0; i < vertices; ++i) {
      if (!next_line()) return truncated("vertices", vertices, i);
      add_vertex();
    }
    for (std::int64_t i = 0; i < faces; ++i) {
      if (!next_line()) return truncated("faces", faces, i);
      add_face(vertices);
    }
  }

  [[nodiscard]] std::int64_t count(std::size_t word) const {
    return word < words_.size() ? parse_number<std::int64_t>(words_[word]).value_or(-1) : -1;
  }

  void add_vertex() {
    const std::optional<Vector3> position = finite_position(words_);
    if (!position) return report("a vertex must have three finite coordinates");
    writer_.add_vertex(*position);
  }

  void add_face(std::int64_t vertices) {
    const std::int64_t corners = count(0);
    if (corners < 1 || corners >= std::ssize(words_)) return report("a face must have its number of corners, then the corners");
    if (corners > kMostCorners) return report(kMostCornersRule);
    corners_.clear();
    for (std::int64_t corner = 1; corner <= corners; ++corner) {
      corners_.push_back(count(static_cast<std::size_t>(corner)));
      if (corners_.back() >= 0 && corners_.back() < vertices) continue;
      return report("a corner must be a vertex number below " + std::to_string(vertices));
    }
    writer_.add_face(corners_);
  }

  void report(const std::string& rule) { problems_.add("line " + std::to_string(line_number_), "", rule); }

  void truncated(const std::string& elements, std::int64_t declared, std::int64_t found) {
    problems_.add(
        "", "", "is truncated: it declares " + std::to_string(declared) + " " + elements + " but contains " + std::to_string(found),
        "export it again");
  }

  FileProblems problems_;
  std::string_view rest_;
  std::vector<std::string_view> words_;
  std::vector<std::int64_t> corners_;
  PlyWriter writer_;
  std::size_t line_number_ = 0;
};

}  // namespace

CheckedFile checked_off(const std::filesystem::path& file, const std::string& text) { return OffChecker(file, text).check(); }

}  // namespace sprung
