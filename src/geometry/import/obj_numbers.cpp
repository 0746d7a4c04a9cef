#include "geometry/import/obj_numbers.h"

#include "geometry/import/mesh_file.h"
#include "geometry/import/text_words.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

namespace sprung {
namespace {

class Scanner {
 public:
  explicit Scanner(const std::filesystem::path& file) : problems_(file) {}

  void scan(std::string_view line) {
    ++line_number_;
    split_words(line, words_);
    if (words_.empty()) return;
    if (words_[0] == "v") scan_position();
    if (words_[0] == "vt") scan_texcoord();
    if (words_[0] == "f") scan_face();
    if (words_[0] == "l") scan_polyline();
  }

  ObjNumbers finish() {
    for (const LineVertex& use : line_vertices_) {
      if (use.vertex < 0 || use.vertex >= static_cast<std::int64_t>(numbers_.positions.size())) {
        problems_.add("line " + std::to_string(use.line_number), std::to_string(use.as_written),
                      "must refer to one of the " + std::to_string(numbers_.positions.size()) + " vertices");
      }
    }
    problems_.throw_if_any();
    return std::move(numbers_);
  }

 private:
  struct LineVertex {
    std::int64_t vertex;
    Index as_written;
    std::size_t line_number;
  };

  void report(std::string_view value, const std::string& rule) {
    problems_.add("line " + std::to_string(line_number_), std::string(value), rule);
  }

  double number(std::size_t word) {
    const std::optional<double> value = parse_number<double>(words_[word]);
    if (!value || !std::isfinite(*value)) report(words_[word], "must be a finite number");
    return value.value_or(0.0);
  }

  void scan_position() {
    if (words_.size() < 4) return report("", "a vertex must have three coordinates");
    numbers_.positions.emplace_back(number(1), number(2), number(3));
  }

  void scan_texcoord() {
    if (words_.size() < 2) return report("", "a texture coordinate must have one or two numbers");
    numbers_.texcoords.push_back({number(1), words_.size() > 2 ? number(2) : 0.0});
  }

  void scan_face() {
    if (words_.size() < 4) report("", "a face must have at least three corners");
    for (std::size_t word = 1; word < words_.size(); ++word) check_corner(words_[word]);
  }

  // `v`, `v/vt`, `v//vn` or `v/vt/vn`.
  void check_corner(std::string_view corner) {
    std::string_view rest = corner;
    for (bool first = true;; first = false) {
      const std::size_t slash = rest.find('/');
      const std::string_view field = rest.substr(0, slash);
      const bool left_out = field.empty() && !first;
      if (!left_out && parse_number<Index>(field).value_or(0) == 0) return report(corner, "must be vertex numbers counted from 1");
      if (slash == std::string_view::npos) return;
      rest.remove_prefix(slash + 1);
    }
  }

  void scan_polyline() {
    if (words_.size() < 3) report("", "a line must have at least two vertices");
    Index previous = kNone;
    for (std::size_t word = 1; word < words_.size(); ++word) {
      const std::string_view text = words_[word].substr(0, words_[word].find('/'));
      const Index written = parse_number<Index>(text).value_or(0);
      if (written == 0) return report(words_[word], "must be vertex numbers counted from 1");
      const std::int64_t vertex = written > 0 ? written - std::int64_t{1} : written + std::ssize(numbers_.positions);
      line_vertices_.push_back({vertex, written, line_number_});
      if (word > 1) numbers_.lines.push_back({previous, static_cast<Index>(vertex)});
      previous = static_cast<Index>(vertex);
    }
  }

  FileProblems problems_;
  ObjNumbers numbers_;
  std::vector<LineVertex> line_vertices_;
  std::vector<std::string_view> words_;
  std::size_t line_number_ = 0;
};

}  // namespace

std::string plain_obj_text(const std::string& text) {
  std::string plain;
  plain.reserve(text.size() + 1);
  std::size_t joined_lines = 0;
  bool in_comment = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool carriage_return = text[i] == '\r';
    if (carriage_return && i + 1 < text.size() && text[i + 1] == '\n') continue;
    const char c = carriage_return ? '\n' : text[i];
    if (c == '\n') {
      if (!in_comment && !plain.empty() && plain.back() == '\\') {
        plain.back() = ' ';
        ++joined_lines;
        continue;
      }
      plain.append(1 + joined_lines, '\n');
      joined_lines = 0;
      in_comment = false;
      continue;
    }
    in_comment = in_comment || (c == '#' && (plain.empty() || plain.back() == '\n' || is_blank(plain.back())));
    if (!in_comment) plain += c == '\0' ? ' ' : c;
  }
  return plain;
}

ObjNumbers read_obj_numbers(const std::filesystem::path& file, const std::string& plain_text) {
  Scanner scanner(file);
  for (std::string_view rest = plain_text; !rest.empty();) scanner.scan(take_line(rest));
  return scanner.finish();
}

}  // namespace sprung
