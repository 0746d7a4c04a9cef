#include "geometry/import/mesh_check.h"
#include "geometry/import/mesh_file.h"
#include "geometry/import/obj_numbers.h"
#include "geometry/import/text_words.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

namespace sprung {
namespace {

constexpr double kLeastWeight = 1e-30;     // smaller weights are 0 as a float
constexpr std::size_t kLongestName = 200;  // of a group; assimp copies the name into a buffer of fixed size

// Writes vertices, faces without texture coordinates and normals, and the names by which assimp groups faces.
class ObjWriter {
 public:
  ObjWriter(const std::filesystem::path& file, std::int64_t vertices) : problems_(file), vertices_(vertices) {}

  void add(std::string_view line) {
    ++line_number_;
    split_words(line, words_);
    if (words_.empty()) return;
    const std::string_view kind = words_[0];
    if (kind == "v") add_vertex();
    if (kind == "f") add_face();
    if (kind == "o" || kind == "g" || kind == "usemtl") add_name();
  }

  CheckedFile finish() {
    problems_.throw_if_any();
    return {"obj", std::move(text_)};
  }

 private:
  // Four numbers are homogeneous coordinates, more numbers are a colour. assimp skips vertices with coordinates like `.5`.
  void add_vertex() {
    ++vertices_so_far_;
    std::size_t numbers = 3;
    if (words_.size() == 5 && is_finite_number(words_[4])) {
      numbers = 4;
      if (std::abs(*parse_number<double>(words_[4])) < kLeastWeight) report(words_[4], "the weight of a vertex must not be 0");
    }
    text_ += 'v';
    for (std::size_t word = 1; word <= numbers; ++word) {
      text_ += ' ';
      if (words_[word].starts_with('.')) text_ += '0';
      text_ += words_[word];
    }
    text_ += '\n';
  }

  // Requires corners that `read_obj_numbers` accepts. Positive numbers count from 1 in the whole file, negative ones back from the
  // last vertex before the face.
  void add_face() {
    if (std::ssize(words_) - 1 > kMostCorners) {
      return report("", kMostCornersRule);
    }
    text_ += 'f';
    for (std::size_t word = 1; word < words_.size(); ++word) {
      const std::string_view corner = words_[word].substr(0, words_[word].find('/'));
      const std::int64_t written = parse_number<std::int64_t>(corner).value_or(0);
      const std::int64_t number = written > 0 ? written : vertices_so_far_ + 1 + written;
      if (number < 1 || number > vertices_)
        return report(corner, "must refer to one of the " + std::to_string(vertices_) + " vertices");
      text_ += ' ' + std::to_string(number);
    }
    text_ += '\n';
  }

  void add_name() {
    std::string line;
    for (const std::string_view word : words_) (line += word) += ' ';
    line.resize(std::min(line.size() - 1, kLongestName));
    std::replace_if(
        line.begin(), line.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, '_');
    (text_ += line) += '\n';
  }

  void report(std::string_view value, const std::string& rule) {
    problems_.add("line " + std::to_string(line_number_), std::string(value), rule);
  }

  FileProblems problems_;
  std::string text_;
  std::vector<std::string_view> words_;
  std::size_t line_number_ = 0;
  std::int64_t vertices_;
  std::int64_t vertices_so_far_ = 0;
};

}  // namespace

CheckedFile checked_obj(const std::filesystem::path& file, const std::string& bytes) {
  const std::string text = plain_obj_text(bytes);
  ObjWriter writer(file, std::ssize(read_obj_numbers(file, text).positions));
  for (std::string_view rest = text; !rest.empty();) writer.add(take_line(rest));
  return writer.finish();
}

}  // namespace sprung
