#include "geometry/obj_source/obj_source.h"

#include "geometry/import/mesh_file.h"
#include "geometry/mesh/vertex_normals.h"

namespace sprung {

std::string ObjSource::text(const Points& particles, const Triangles& triangles, const std::vector<Index>& removed) const {
  const auto of_file = [&](const Points& points) -> Points {
    return particle_of.empty() ? points : points(Eigen::all, particle_of);
  };
  const auto text_of = [&](const ObjTemplate& present) {
    return present.text(of_file(particles), file.writes_normals() ? of_file(vertex_normals(particles, triangles)) : Points(3, 0));
  };
  return removed.empty() ? text_of(file) : text_of(file.without_faces(removed));
}

ObjSource read_obj_source(const std::filesystem::path& file, ObjTemplate::Normals normals) {
  const std::string text = read_mesh_text(file);
  return {.file = ObjTemplate(text, normals), .particle_of = {}, .materials = find_material_files(file, text)};
}

}  // namespace sprung
