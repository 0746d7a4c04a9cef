#include "geometry/import/mesh_check.h"
#include "geometry/import/mesh_file.h"
#include "geometry/import/text_words.h"

#include <cstdint>
#include <string_view>
#include <vector>

namespace sprung {
namespace {

class OffChecker {
 public:
  OffChecker(const std::filesystem::path& file, std::string_view text) : problems_(file), rest_(text) {}

  void check() {
    if (!next_line() || !words_[0].ends_with("OFF")) {
      problems_.add("", "", "must begin with OFF");
    } else if (words_.size() < 2 || words_[1] != "BINARY") {
      check_elements();
    }
    problems_.throw_if_any();
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
      check_vertex();
    }
    for (std::int64_t i = 0; i < faces; ++i) {
      if (!next_line()) return truncated("faces", faces, i);
      check_face(vertices);
    }
  }

  [[nodiscard]] std::int64_t count(std::size_t word) const {
    return word < words_.size() ? parse_number<std::int64_t>(words_[word]).value_or(-1) : -1;
  }

  void check_vertex() {
    for (std::size_t word = 0; word < 3; ++word) {
      if (word >= words_.size() || !parse_number<double>(words_[word])) return report("a vertex must have three coordinates");
    }
  }

  void check_face(std::int64_t vertices) {
    const std::int64_t corners = count(0);
    if (corners < 1 || corners >= std::ssize(words_)) return report("a face must have its number of corners, then the corners");
    for (std::int64_t corner = 1; corner <= corners; ++corner) {
      const std::int64_t vertex = count(corner);
      if (vertex < 0 || vertex >= vertices) return report("a corner must be a vertex number below " + std::to_string(vertices));
    }
  }

  void report(const std::string& rule) { problems_.add("line " + std::to_string(line_number_), "", rule); }

  void truncated(const std::string& elements, std::int64_t declared, std::int64_t held) {
    problems_.add("", "",
                  "is truncated: it declares " + std::to_string(declared) + " " + elements + " and holds " + std::to_string(held),
                  "export it again");
  }

  FileProblems problems_;
  std::string_view rest_;
  std::vector<std::string_view> words_;
  std::size_t line_number_ = 0;
};

}  // namespace

void check_off(const std::filesystem::path& file, const std::string& text) { OffChecker(file, text).check(); }

}  // namespace sprung
