#include "geometry/import/mesh_check.h"
#include "geometry/import/mesh_file.h"
#include "geometry/import/obj_numbers.h"
#include "geometry/import/text_words.h"

#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

namespace sprung {
namespace {

constexpr double kLeastWeight = 1e-30;  // smaller weights would move the vertex to where no float is

// Writes vertices and faces without texture coordinates and normals.
class SurfaceReader {
 public:
  SurfaceReader(const std::filesystem::path& file, const std::vector<Vector3>& positions)
      : problems_(file), positions_(positions), vertices_(std::ssize(positions)) {}

  void add(std::string_view line) {
    ++line_number_;
    split_words(line, words_);
    if (words_.empty()) return;
    const std::string_view kind = words_[0];
    if (kind == "v") add_vertex();
    if (kind == "f") add_face();
  }

  CheckedFile finish() {
    problems_.throw_if_any();
    return writer_.finish();
  }

 private:
  // Four numbers are homogeneous coordinates, more numbers are a colour.
  void add_vertex() {
    const Vector3& position = positions_[static_cast<std::size_t>(vertices_so_far_++)];
    const double weight = words_.size() == 5 ? finite_number(words_[4]).value_or(1.0) : 1.0;
    if (std::abs(weight) < kLeastWeight) report(words_[4], "the weight of a vertex must not be 0");
    writer_.add_vertex(position / weight);
  }

  // Requires corners that `read_obj_numbers` accepts. Positive numbers count from 1 in the whole file, negative ones back from the
  // last vertex before the face.
  void add_face() {
    if (std::ssize(words_) - 1 > kMostCorners) {
      return report("", kMostCornersRule);
    }
    corners_.clear();
    for (std::size_t word = 1; word < words_.size(); ++word) {
      const std::string_view corner = words_[word].substr(0, words_[word].find('/'));
      const std::int64_t written = parse_number<std::int64_t>(corner).value_or(0);
      const std::int64_t number = written > 0 ? written : vertices_so_far_ + 1 + written;
      if (number < 1 || number > vertices_)
        return report(corner, "must refer to one of the " + std::to_string(vertices_) + " vertices");
      corners_.push_back(number - 1);
    }
    writer_.add_face(corners_);
  }

  void report(std::string_view value, const std::string& rule) {
    problems_.add("line " + std::to_string(line_number_), std::string(value), rule);
  }

  FileProblems problems_;
  PlyWriter writer_;
  std::vector<std::string_view> words_;
  std::vector<std::int64_t> corners_;
  std::size_t line_number_ = 0;
  const std::vector<Vector3>& positions_;
  std::int64_t vertices_;
  std::int64_t vertices_so_far_ = 0;
};

}  // namespace

CheckedFile checked_obj(const std::filesystem::path& file, const std::string& bytes) {
  const std::string text = plain_obj_text(bytes);
  const ObjNumbers numbers = read_obj_numbers(file, text);
  SurfaceReader reader(file, numbers.positions);
  for (std::string_view rest = text; !rest.empty();) reader.add(take_line(rest));
  return reader.finish();
}

}  // namespace sprung
