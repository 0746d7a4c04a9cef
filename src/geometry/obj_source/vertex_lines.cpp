#include "geometry/obj_source/vertex_lines.h"

#include "base/format.h"
#include "base/parallel.h"
#include "geometry/import/text_words.h"

#include <algorithm>
#include <charconv>
#include <numeric>
#include <vector>

namespace sprung {
namespace {

constexpr Index kVerticesPerChunk = 4096;
constexpr std::size_t kBytesPerVertex = 64;

std::string chunk_lines(const Points& vertices, Index begin, Index end) {
  std::string text;
  text.reserve(static_cast<std::size_t>(end - begin) * kBytesPerVertex);
  for (Index i = begin; i < end; ++i) {
    text += 'v';
    for (int axis = 0; axis < 3; ++axis) {
      text += ' ';
      append_number(text, vertices(axis, i));
    }
    text += '\n';
  }
  return text;
}

}  // namespace

std::string vertex_lines(const Points& vertices) {
  const Index count = static_cast<Index>(vertices.cols());
  std::vector<std::string> chunks(static_cast<std::size_t>((count + kVerticesPerChunk - 1) / kVerticesPerChunk));
  parallel_chunks(count, kVerticesPerChunk, [&](Index begin, Index end) {
    chunks[static_cast<std::size_t>(begin / kVerticesPerChunk)] = chunk_lines(vertices, begin, end);
  });
  return std::accumulate(chunks.begin(), chunks.end(), std::string());
}

Points read_vertex_lines(const std::string& text) {
  std::vector<double> numbers;
  const auto ends_line = [](char letter) { return letter == '\n' || letter == '\r'; };
  const char* const end = text.data() + text.size();
  for (const char* line = text.data(); line != end;) {
    const char* const line_end = std::find_if(line, end, ends_line);
    const char* at = std::find_if_not(line, line_end, is_blank);
    if (line_end - at > 2 && at[0] == 'v' && is_blank(at[1])) {
      const std::size_t before = numbers.size();
      double number = 0.0;
      for (++at; numbers.size() < before + 3;) {
        const auto read = std::from_chars(std::find_if_not(at, line_end, is_blank), line_end, number);
        if (read.ec != std::errc{}) break;
        numbers.push_back(number);
        at = read.ptr;
      }
      if (numbers.size() < before + 3) numbers.resize(before);
    }
    line = line_end == end ? end : line_end + 1;
  }
  return Points::Map(numbers.data(), 3, static_cast<Eigen::Index>(numbers.size() / 3));
}

}  // namespace sprung
