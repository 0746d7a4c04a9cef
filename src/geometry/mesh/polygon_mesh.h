// Meshes whose vertex order, polygons, UVs and groups must survive: what simulated bodies are read from and written to (OBJ).
// Normals are left out: a body deforms.
#pragma once

#include "base/types.h"

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace sprung {

/// Faces as given, with what an OBJ file says of their corners.
struct PolygonFaces {
  std::vector<Index> corner_begin{0};  ///< face f has corners [corner_begin[f], corner_begin[f + 1])
  std::vector<Index> vertex;           ///< per corner
  std::vector<Index> texcoord;         ///< per corner, kNone for none; empty when the mesh has no UVs
  std::vector<std::array<double, 2>> texcoords;
  std::vector<std::string> groups;  ///< names of groups or objects, in the order of their faces
  std::vector<Index> group_begin;   ///< group g begins at face group_begin[g]

  [[nodiscard]] Index face_count() const { return static_cast<Index>(corner_begin.size()) - 1; }
};

/// Fans each polygon from its first corner.
[[nodiscard]] Triangles triangulate(const PolygonFaces& faces);

/// One face a triangle, no attributes.
[[nodiscard]] PolygonFaces to_polygons(const Triangles& triangles);

struct PolygonMesh {
  Points vertices;  ///< [m], in the order of the file's `v` lines
  PolygonFaces faces;
  Edges lines;  ///< `l` elements, as edges
};

/// Reads an OBJ file, keeping the order of vertices and faces; numbers are the nearest doubles. Throws InputError naming the file
/// when it is missing, cannot be read or has no vertices, and each line or face that holds a number that is not finite, an index
/// out of range, fewer than three corners or a corner twice.
[[nodiscard]] PolygonMesh read_obj(const std::filesystem::path& file);

/// OBJ text: `v` lines in order, then `vt`, then `f` (with groups) and `l` lines. Numbers are the shortest that read back equal, so
/// `read_obj` gives back the same mesh, bit for bit.
[[nodiscard]] std::string obj_text(const Points& vertices, const PolygonFaces& faces, const Edges& lines);

}  // namespace sprung
