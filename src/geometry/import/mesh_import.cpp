#include "geometry/import/mesh_import.h"

#include "geometry/import/assimp_reader.h"
#include "geometry/import/mesh_check.h"
#include "geometry/import/mesh_file.h"
#include "geometry/import/obj_numbers.h"

namespace sprung {
namespace {

TriangleMesh read_checked(const std::filesystem::path& file) {
  const std::string bytes = read_mesh_file(file);
  const std::string extension = lower_case_extension(file);
  if (extension == ".obj") {
    const std::string text = plain_obj_text(bytes);
    (void)read_obj_numbers(file, text);
    return read_with_assimp(file, text_for_assimp(text));
  }
  if (extension == ".ply") check_ply(file, bytes);
  if (extension == ".off") check_off(file, bytes);
  return read_with_assimp(file);
}

}  // namespace

ImportedMesh import_mesh(const std::filesystem::path& file) {
  ImportedMesh result = clean_mesh(read_checked(file));
  if (result.mesh.triangles.cols() > 0) return result;
  const bool none_read = result.report.faces_read == 0;
  throw InputError(Problem{.file = file.string(),
                           .rule = none_read ? "has no faces" : "has no face with an area",
                           .remedy = "export it again, with its surface"});
}

}  // namespace sprung
