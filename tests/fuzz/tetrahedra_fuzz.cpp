// Reads its input as a mesh of tetrahedra with the extension SPRUNG_FUZZ_EXTENSION. A file is refused with an InputError, or it
// gives a mesh that keeps what `tetrahedra_mesh.h` promises.
#include "base/error.h"
#include "base/parallel.h"
#include "fuzz/fuzz_file.h"
#include "geometry/tetrahedra/box_meshes.h"
#include "geometry/tetrahedra/tetrahedra_mesh.h"
#include "geometry/tetrahedra/tetrahedra_texts.h"

namespace sprung::fuzz {
namespace {

void write_text(const std::string& name, const std::string& text) { write_bytes(own_file(name), text.data(), text.size()); }

/// TetGen's files come in pairs: the input, which replaces one of these, is read beside the other.
bool write_pair() {
  const TetrahedraMesh mesh = test::make_box({1, 1, 1}, 1.0, test::Cut::five);
  write_text("mesh.node", test::node_text(mesh, 1));
  write_text("mesh.ele", test::ele_text(mesh, 1));
  return true;
}

void check(const std::filesystem::path& file) {
  try {
    const TetrahedraMesh mesh = read_tetrahedra(file);
    require(mesh.vertices.allFinite(), "an accepted mesh has finite positions");
    require(!mesh.tetrahedra.empty(), "an accepted mesh has tetrahedra");
    for (const auto& tetrahedron : mesh.tetrahedra) {
      for (const Index corner : tetrahedron)
        require(corner >= 0 && corner < mesh.vertices.cols(), "an accepted mesh has its indices in range");
      require(tetrahedron_volume(mesh.vertices, tetrahedron) > 0.0, "accepted tetrahedra have a positive volume");
    }
    const Triangles boundary = boundary_triangles(mesh.tetrahedra);
    require(boundary.cols() > 0, "an accepted mesh has a boundary");
  } catch (const InputError& error) {
    require(!error.problems().empty(), "what is refused has a reason");
  }
}

}  // namespace
}  // namespace sprung::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace sprung::fuzz;
  static const sprung::ThreadLimit kOneThread(1);  // meshes are small, and libFuzzer repeats what one thread does
  [[maybe_unused]] static const bool kPairIsWritten = write_pair();
  const std::filesystem::path file = own_file(std::string("mesh") + SPRUNG_FUZZ_EXTENSION);
  write_bytes(file, bytes, size);
  check(file);
  return 0;
}
