#include "geometry/import/mesh_import.h"

#include "geometry/import/assimp_reader.h"
#include "geometry/import/mesh_check.h"
#include "geometry/import/mesh_file.h"

namespace sprung {
namespace {

CheckedFile read_checked(const std::filesystem::path& file) {
  const std::string extension = lower_case_extension(file);
  const auto checked = [&](auto check) { return check(file, read_mesh_text(file)); };
  if (extension == ".obj") return checked(checked_obj);
  if (extension == ".stl") return checked(checked_stl);
  if (extension == ".ply") return checked(checked_ply);
  if (extension == ".off") return checked(checked_off);
  if (extension == ".gltf" || extension == ".glb") return checked(checked_gltf);
  if (extension == ".3ds") return checked(checked_3ds);
  throw InputError(Problem{.file = file.string(),
                           .value = file.extension().string(),
                           .rule = "must be a mesh in one of the formats .obj, .stl, .ply, .off, .gltf, .glb, .3ds",
                           .remedy = "convert its surface to OBJ, for instance with Blender"});
}

}  // namespace

ImportedMesh import_mesh(const std::filesystem::path& file) {
  ImportedMesh result = clean_mesh(read_with_assimp(file, read_checked(file)));
  if (result.mesh.triangles.cols() > 0) return result;
  const bool none_read = result.report.faces_read == 0;
  throw InputError(Problem{.file = file.string(),
                           .rule = none_read ? "has no faces" : "has no face with an area",
                           .remedy = "export it again, with its surface"});
}

}  // namespace sprung
