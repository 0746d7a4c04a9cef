#include "geometry/obj_source/obj_template.h"

#include "base/format.h"
#include "base/parallel.h"
#include "geometry/obj_source/obj_lines.h"

#include <algorithm>
#include <numeric>

namespace sprung {
namespace {

constexpr Index kVerticesPerChunk = 4096;
constexpr std::size_t kBytesPerNumbers = 64;

void append_numbers(std::string& out, const Points& points, Index i) {
  for (int axis = 0; axis < 3; ++axis) {
    out += ' ';
    append_number(out, points(axis, i));
  }
}

/// The corner of a face with its vertex as its normal. There is a `vn` line after each `v` line, so numbers that count back are
/// the same too.
std::string corner_with_normal(std::string_view corner) {
  const std::size_t first = std::min(corner.find('/'), corner.size());
  const std::string_view vertex = corner.substr(0, first);
  const std::string_view rest = corner.substr(std::min(first + 1, corner.size()));
  const std::string_view texcoord = rest.substr(0, std::min(rest.find('/'), rest.size()));
  return std::string(vertex) + '/' + std::string(texcoord) + '/' + std::string(vertex);
}

}  // namespace

ObjTemplate::ObjTemplate(std::string_view text, Normals normals) {
  const bool per_vertex = normals == Normals::per_vertex;
  text_.reserve(text.size());
  ObjLine line;
  for (std::size_t at = 0; at < text.size(); at = line.whole.end) {
    read_obj_line(text, at, line);
    const std::string_view kind = line.word(text, 0);
    std::size_t copied = line.whole.begin;
    const std::size_t line_at = text_.size();
    const auto copy_until = [&](std::size_t end) {
      text_ += text.substr(copied, end - copied);
      copied = end;
    };
    if (kind == "vn") has_given_normals_ = true;
    if (kind == "usemtl" && line.words.size() > 1) {
      const std::size_t begin = line.words[1].begin;  // a name may have blanks
      face_materials_.emplace_back(text.substr(begin, line.words.back().end - begin), static_cast<Index>(faces_.size()));
    }
    if (kind == "vn" && per_vertex) continue;
    if (kind == "v" && line.words.size() > 3) {
      copy_until(line.words[0].end);
      position_at_.push_back(text_.size());
      copied = line.words[3].end;
    }
    if (kind == "f" && per_vertex) {
      for (std::size_t word = 1; word < line.words.size(); ++word) {
        copy_until(line.words[word].begin);
        text_ += corner_with_normal(line.word(text, word));
        copied = line.words[word].end;
      }
    }
    copy_until(line.whole.end);
    if (kind == "f") faces_.emplace_back(line_at, text_.size());
    if (kind == "v" && per_vertex) {
      const std::string_view end = text.substr(line.line_end, line.whole.end - line.line_end);
      if (end.empty()) text_ += '\n';
      normal_at_.push_back(text_.size());
      text_ += end.empty() ? "\n" : end;
    }
  }
}

ObjTemplate ObjTemplate::without_faces(const std::vector<Index>& removed) const {
  ObjTemplate left = *this;
  left.text_.clear();
  left.faces_.clear();
  std::size_t copied = 0;
  std::size_t position = 0;
  std::size_t normal = 0;
  auto next = removed.begin();
  const auto copy_until = [&](std::size_t end) {
    const std::size_t gone = copied - left.text_.size();
    for (; position < position_at_.size() && position_at_[position] <= end; ++position) left.position_at_[position] -= gone;
    for (; normal < normal_at_.size() && normal_at_[normal] <= end; ++normal) left.normal_at_[normal] -= gone;
    left.text_.append(text_, copied, end - copied);
  };
  for (std::size_t face = 0; face < faces_.size(); ++face) {
    const auto& [begin, end] = faces_[face];
    copy_until(begin);
    copied = begin;
    if (next != removed.end() && *next == static_cast<Index>(face)) {
      ++next;
    } else {
      const std::size_t at = left.text_.size();
      copy_until(end);
      left.faces_.emplace_back(at, left.text_.size());
    }
    copied = end;
  }
  copy_until(text_.size());
  return left;
}

std::string ObjTemplate::text(const Points& positions, const Points& normals) const {
  const Index count = vertex_count();
  std::vector<std::string> chunks(static_cast<std::size_t>((count + kVerticesPerChunk - 1) / kVerticesPerChunk));
  parallel_chunks(count, kVerticesPerChunk, [&](Index begin, Index end) {
    append(chunks[static_cast<std::size_t>(begin / kVerticesPerChunk)], begin, end, positions, normals);
  });
  std::string whole(text_, 0, position_at_.empty() ? text_.size() : position_at_.front());
  whole.reserve(std::accumulate(chunks.begin(), chunks.end(), whole.size(),
                                [](std::size_t size, const std::string& chunk) { return size + chunk.size(); }));
  for (const std::string& chunk : chunks) whole += chunk;
  return whole;
}

void ObjTemplate::append(std::string& out, Index begin, Index end, const Points& positions, const Points& normals) const {
  const auto text_end = [&](Index i) { return i + 1 < vertex_count() ? position_at_[i + 1] : text_.size(); };
  const std::size_t numbers = static_cast<std::size_t>(end - begin) * (writes_normals() ? 2 : 1);
  out.reserve(numbers * kBytesPerNumbers + text_end(end - 1) - position_at_[begin]);
  for (Index i = begin; i < end; ++i) {
    append_numbers(out, positions, i);
    std::size_t copied = position_at_[i];
    if (writes_normals()) {
      out.append(text_, copied, normal_at_[i] - copied);
      copied = normal_at_[i];
      append_numbers(out += "vn", normals, i);
    }
    out.append(text_, copied, text_end(i) - copied);
  }
}

}  // namespace sprung
