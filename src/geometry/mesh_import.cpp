#include "geometry/mesh_import.h"

#include "geometry/assimp_reader.h"
#include "geometry/mesh_check.h"
#include "geometry/mesh_file.h"
#include "geometry/obj_numbers.h"

namespace sprung {
namespace {

void check_mesh_file(const std::filesystem::path& file) {
  const std::string bytes = read_mesh_file(file);
  const std::string extension = lower_case_extension(file);
  if (extension == ".obj") (void)read_obj_numbers(file, plain_obj_text(bytes));
  if (extension == ".ply") check_ply(file, bytes);
  if (extension == ".off") check_off(file, bytes);
}

}  // namespace

ImportedMesh import_mesh(const std::filesystem::path& file) {
  check_mesh_file(file);
  ImportedMesh result = clean_mesh(read_with_assimp(file));
  if (result.mesh.triangles.cols() > 0) return result;
  const bool none_read = result.report.faces_read == 0;
  throw InputError(Problem{.file = file.string(),
                           .rule = none_read ? "has no faces" : "has no face with an area",
                           .remedy = "export it again, with its surface"});
}

}  // namespace sprung
