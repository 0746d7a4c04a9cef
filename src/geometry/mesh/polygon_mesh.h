// Meshes that keep vertex order, polygons, UVs and groups: simulated bodies are read from and written to them (OBJ). Normals are
// left out, because a body deforms.
#pragma once

#include "base/types.h"

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace sprung {

/// Faces as given, with the attributes that an OBJ file gives their corners.
struct PolygonFaces {
  std::vector<Index> corner_begin{0};  ///< face f has corners [corner_begin[f], corner_begin[f + 1])
  std::vector<Index> vertex;           ///< per corner
  std::vector<Index> texcoord;         ///< per corner, kNone for none; empty when the mesh has no UVs
  std::vector<std::array<double, 2>> texcoords;
  std::vector<std::string> groups;  ///< names of groups or objects, in the order of their faces
  std::vector<Index> group_begin;   ///< group g begins at face group_begin[g]

  [[nodiscard]] Index face_count() const { return static_cast<Index>(corner_begin.size()) - 1; }
};

/// Cuts each polygon into a fan of triangles around its first corner.
[[nodiscard]] Triangles triangulate(const PolygonFaces& faces);

/// The faces without those of these numbers, which ascend. The others keep their attributes.
[[nodiscard]] PolygonFaces without_faces(const PolygonFaces& faces, const std::vector<Index>& removed);

/// One face per triangle, without attributes.
[[nodiscard]] PolygonFaces to_polygons(const Triangles& triangles);

struct PolygonMesh {
  Points vertices;  ///< [m], in the order of the file's `v` lines
  PolygonFaces faces;
  Edges lines;  ///< `l` elements, as edges
};

/// Reads an OBJ file and keeps the order of vertices and faces. Numbers are rounded to the nearest double. Throws InputError that
/// names the file if it is missing, cannot be read or has no vertices, and names each line or face with a number that is not
/// finite, an index out of range, fewer than three corners or a repeated corner.
[[nodiscard]] PolygonMesh read_obj(const std::filesystem::path& file);

/// OBJ text: `v` lines in order, then `vt`, then `f` (with groups) and `l` lines. Each number is the shortest text that reads back
/// as the same double, so `read_obj` returns the same mesh, bit for bit.
[[nodiscard]] std::string obj_text(const Points& vertices, const PolygonFaces& faces, const Edges& lines);

}  // namespace sprung
