#include "geometry/mesh/polygon_mesh.h"

#include "base/format.h"

#include <algorithm>
#include <array>
#include <charconv>

namespace sprung {
namespace {

void append_index(std::string& text, Index index) {
  std::array<char, 16> buffer{};
  text.append(buffer.data(), std::to_chars(buffer.data(), buffer.data() + buffer.size(), index + 1).ptr);
}

void append_face(std::string& text, const PolygonFaces& faces, Index face) {
  text += 'f';
  for (Index corner = faces.corner_begin[face]; corner < faces.corner_begin[face + 1]; ++corner) {
    text += ' ';
    append_index(text, faces.vertex[corner]);
    if (faces.texcoord.empty() || faces.texcoord[corner] == kNone) continue;
    text += '/';
    append_index(text, faces.texcoord[corner]);
  }
  text += '\n';
}

void append_faces(std::string& text, const PolygonFaces& faces) {
  std::size_t group = 0;
  for (Index face = 0; face < faces.face_count(); ++face) {
    for (; group < faces.groups.size() && faces.group_begin[group] == face; ++group) text += "g " + faces.groups[group] + '\n';
    append_face(text, faces, face);
  }
}

// An element for each edge: of a polyline, Blender 3.4 reads the first edge alone.
void append_lines(std::string& text, const Edges& lines) {
  for (Index e = 0; e < static_cast<Index>(lines.cols()); ++e) {
    text.append("l ").append(std::to_string(lines(0, e) + 1)).append(" ").append(std::to_string(lines(1, e) + 1)).append("\n");
  }
}

}  // namespace

Triangles triangulate(const PolygonFaces& faces) {
  Triangles triangles(3, faces.corner_begin.back() - 2 * faces.face_count());
  Index t = 0;
  for (Index face = 0; face < faces.face_count(); ++face) {
    const Index first = faces.corner_begin[face];
    for (Index corner = first + 2; corner < faces.corner_begin[face + 1]; ++corner) {
      triangles.col(t++) << faces.vertex[first], faces.vertex[corner - 1], faces.vertex[corner];
    }
  }
  return triangles;
}

PolygonFaces without_faces(const PolygonFaces& faces, const std::vector<Index>& removed) {
  PolygonFaces kept;
  kept.texcoords = faces.texcoords;
  kept.groups = faces.groups;
  for (Index face = 0; face < faces.face_count(); ++face) {
    if (std::ranges::binary_search(removed, face)) continue;
    for (Index corner = faces.corner_begin[face]; corner < faces.corner_begin[face + 1]; ++corner) {
      kept.vertex.push_back(faces.vertex[corner]);
      if (!faces.texcoord.empty()) kept.texcoord.push_back(faces.texcoord[corner]);
    }
    kept.corner_begin.push_back(static_cast<Index>(kept.vertex.size()));
  }
  for (const Index begin : faces.group_begin) {
    kept.group_begin.push_back(begin - static_cast<Index>(std::ranges::lower_bound(removed, begin) - removed.begin()));
  }
  return kept;
}

PolygonFaces to_polygons(const Triangles& triangles) {
  PolygonFaces faces;
  faces.vertex.assign(triangles.data(), triangles.data() + triangles.size());
  faces.corner_begin.resize(triangles.cols() + 1);
  for (Index face = 0; face <= triangles.cols(); ++face) faces.corner_begin[face] = 3 * face;
  return faces;
}

std::string obj_text(const Points& vertices, const PolygonFaces& faces, const Edges& lines) {
  std::string text;
  text.reserve(64 * (vertices.cols() + faces.texcoords.size()) + 16 * faces.vertex.size() + 16 * lines.cols());
  for (Index i = 0; i < vertices.cols(); ++i) {
    text += 'v';
    for (Index k = 0; k < 3; ++k) append_number(text += ' ', vertices(k, i));
    text += '\n';
  }
  for (const std::array<double, 2>& uv : faces.texcoords) {
    append_number(text += "vt ", uv[0]);
    append_number(text += ' ', uv[1]);
    text += '\n';
  }
  append_faces(text, faces);
  append_lines(text, lines);
  return text;
}

}  // namespace sprung
