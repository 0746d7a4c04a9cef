// Reads its input as a mesh file with the extension SPRUNG_FUZZ_EXTENSION. A file is refused with an InputError, or it gives a
// mesh that keeps what `mesh_import.h` and `polygon_mesh.h` promise.
#include "base/error.h"
#include "base/parallel.h"
#include "fuzz/fuzz_file.h"
#include "geometry/import/mesh_file.h"
#include "geometry/import/mesh_import.h"
#include "geometry/mesh/mesh_sequence.h"
#include "geometry/mesh/polygon_mesh.h"
#include "geometry/obj_source/obj_source.h"

#include <algorithm>
#include <string_view>

namespace sprung::fuzz {
namespace {

constexpr std::string_view kExtension = SPRUNG_FUZZ_EXTENSION;

bool in_range(const Index index, std::int64_t count) { return index >= 0 && index < count; }

void check_triangles(const Points& vertices, const Triangles& triangles) {
  require(vertices.allFinite(), "an accepted mesh has finite positions");
  require(triangles.cols() > 0, "an accepted mesh has triangles");
  for (const Index corner : triangles.reshaped())
    require(in_range(corner, vertices.cols()), "an accepted mesh has its indices in range");
}

template <class Read>
void refuse_or_read(const Read& read) {
  try {
    read();
  } catch (const InputError& error) {
    require(!error.problems().empty(), "what is refused has a reason");
  }
}

void check_environment(const std::filesystem::path& file) {
  refuse_or_read([&] {
    const ImportedMesh imported = import_mesh(file);
    check_triangles(imported.mesh.vertices, imported.mesh.triangles);
  });
}

Points read_vertices(const std::string& obj_text) {
  const std::filesystem::path frame = own_file("frame.obj");
  write_bytes(frame, obj_text.data(), obj_text.size());
  return read_obj(frame).vertices;
}

void check_body(const std::filesystem::path& file) {
  refuse_or_read([&] {
    const PolygonMesh mesh = read_obj(file);
    require(mesh.vertices.allFinite(), "an accepted body has finite positions");
    for (const Index corner : mesh.faces.vertex) require(in_range(corner, mesh.vertices.cols()), "a body's corners are in range");
    for (const Index vertex : mesh.lines.reshaped()) require(in_range(vertex, mesh.vertices.cols()), "a body's lines are in range");
    for (const Index corner : mesh.faces.texcoord) {
      require(corner == kNone || in_range(corner, std::ssize(mesh.faces.texcoords)), "a body's texture coordinates are in range");
    }
    const ObjSource source = read_obj_source(file, ObjTemplate::Normals::per_vertex);
    require(source.file.vertex_count() == mesh.vertices.cols(), "a body's file is written with all of its vertices");
    const std::string frame = source.text(mesh.vertices, triangulate(mesh.faces));
    require(read_vertices(frame) == mesh.vertices, "a frame has the positions of the body");
  });
}

void check_sequence(const std::filesystem::path& file) {
  refuse_or_read([&] {
    const ImportedSequence imported = import_sequence({file, file});
    require(imported.sequence.frames.size() == 2, "a sequence has a frame a file");
    for (const Points& frame : imported.sequence.frames) check_triangles(frame, imported.sequence.triangles);
  });
}

}  // namespace
}  // namespace sprung::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace sprung::fuzz;
  static const sprung::ThreadLimit kOneThread(1);  // meshes are small, and libFuzzer repeats what one thread does
  const std::filesystem::path file = own_file("mesh" + std::string(kExtension));
  write_bytes(file, bytes, size);
  check_environment(file);
  if (kExtension == ".obj") {
    check_body(file);
    check_sequence(file);
  }
  return 0;
}
