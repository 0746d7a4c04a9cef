// The OBJ file of a simulated body, as it is written back in each frame.
#pragma once

#include "geometry/mesh/polygon_mesh.h"
#include "geometry/obj_source/material_files.h"
#include "geometry/obj_source/obj_template.h"

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace sprung {

struct ObjSource {
  ObjTemplate file;
  std::vector<Index> particle_of;  ///< the particle of the body that each vertex of the file became; empty: i became i
  MaterialFiles materials{};
  PolygonFaces faces{};  ///< of the vertices of the file
  Edges lines{2, 0};

  /// The file with the body's particles at these positions [m], 3 x n, without the faces of the numbers `removed`, which ascend.
  /// `triangles` are those of its particles.
  [[nodiscard]] std::string text(const Points& particles, const Triangles& triangles, const std::vector<Index>& removed = {}) const;
};

/// The files of bodies, by the names of the bodies.
using ObjSources = std::map<std::string, std::shared_ptr<const ObjSource>>;

/// Requires a file that `read_obj` accepts. Throws as it does.
[[nodiscard]] ObjSource read_obj_source(const std::filesystem::path& file, ObjTemplate::Normals normals);

}  // namespace sprung
