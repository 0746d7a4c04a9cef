// Writes the files that the fuzz programs start from, a folder each: make_corpus FOLDER EXAMPLES. They are small, as damage to a
// small file is more often damage to its structure.
#include "geometry/mesh/polygon_mesh.h"
#include "geometry/tetrahedra/box_meshes.h"
#include "geometry/tetrahedra/tetrahedra_texts.h"
#include "mesh_writers.h"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace sprung;
using namespace sprung::meshes;

TriangleMesh tetrahedron() {
  TriangleMesh mesh;
  mesh.vertices = (Points(3, 4) << 0, 1, 0, 0, 0, 0, 1.5, 0, 0, 0, 0, 0.25).finished();
  mesh.triangles = (Triangles(3, 4) << 0, 0, 0, 1, 2, 1, 3, 2, 1, 3, 2, 3).finished();
  return mesh;
}

TriangleMesh triangle() { return {tetrahedron().vertices.leftCols(3), tetrahedron().triangles.leftCols(1)}; }

std::string gltf_of(const TriangleMesh& mesh) {
  return gltf_text(mesh, {"[1, -1, 2]", "[0, 0.6, 0, 0.8]", "[1, 0, 0]"}, {"[1, 1, 1]", "[0, 0, 0, 1]", "[0, 0.5, 0]"});
}

// The same meshes with their buffer beside the JSON, as exporters write it.
std::string glb_of(const TriangleMesh& mesh) {
  std::string json = gltf_of(mesh);
  const std::size_t uri = json.find(", \"uri\"");
  json.erase(uri, json.find('"', json.find("base64,")) + 1 - uri);
  std::string buffer;
  for (const double x : mesh.vertices.reshaped()) {
    const auto value = static_cast<float>(x);
    buffer.append(reinterpret_cast<const char*>(&value), sizeof(value));
  }
  for (const Index corner : mesh.triangles.reshaped()) buffer.append({static_cast<char>(corner), '\0'});
  return glb_bytes(std::move(json), std::move(buffer));
}

std::vector<std::pair<std::string, std::string>> mesh_files() {
  std::vector<std::pair<std::string, std::string>> files;
  for (const TriangleMesh& mesh : {triangle(), tetrahedron()}) {
    const std::string number = std::to_string(mesh.triangles.cols());
    files.emplace_back("obj/" + number, obj_text(mesh.vertices, to_polygons(mesh.triangles), (Edges(2, 1) << 0, 1).finished()));
    files.emplace_back("stl/" + number + "_binary", stl_bytes(mesh));
    files.emplace_back("stl/" + number + "_ascii", stl_text(mesh));
    files.emplace_back("ply/" + number + "_binary", ply_bytes(mesh));
    files.emplace_back("ply/" + number + "_ascii", ply_text(mesh));
    files.emplace_back("off/" + number, off_text(mesh));
    files.emplace_back("gltf/" + number, gltf_of(mesh));
    files.emplace_back("glb/" + number, glb_of(mesh));
    files.emplace_back("3ds/" + number, three_ds_bytes(mesh));
  }
  const TetrahedraMesh cube = test::make_box({1, 1, 1}, 1.0, test::Cut::five);
  files.emplace_back("msh/version_2", test::gmsh2(cube));
  files.emplace_back("msh/version_4", test::gmsh4(cube));
  files.emplace_back("vtk/version_3", test::vtk4(cube));
  files.emplace_back("vtk/version_5", test::vtk5(cube));
  files.emplace_back("node/cube", test::node_text(cube, 1));
  files.emplace_back("ele/cube", test::ele_text(cube, 1));
  files.emplace_back("obj/names",
                     "mtllib a.mtl\no one\ng left\nusemtl red\nv 0 0 0\nv 1 0 0 1\nv .5 1 0 1 0 0\nvt 0.5\nvt 0 1\nvn 0 0 1\ns 1\n"
                     "f 1/1/1 2/2/1 3//1\ng right\nf -1 -2 \\\n -3 # turned\nl 1/1 2/2 3\n");
  return files;
}

bool write(const std::filesystem::path& file, const std::string& bytes) {
  std::filesystem::create_directories(file.parent_path());
  return static_cast<bool>(std::ofstream(file, std::ios::binary) << bytes << std::flush);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("usage: make_corpus FOLDER EXAMPLES\n", stderr);
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  for (const auto& [name, bytes] : mesh_files()) {
    if (write(folder / name, bytes)) continue;
    std::fprintf(stderr, "%s cannot be written\n", (folder / name).c_str());
    return 1;
  }
  std::filesystem::create_directories(folder / "scene");
  for (const auto& entry : std::filesystem::directory_iterator(argv[2])) {
    if (entry.path().extension() != ".json") continue;
    std::filesystem::copy_file(entry, folder / "scene" / entry.path().filename(),
                               std::filesystem::copy_options::overwrite_existing);
  }
  return 0;
}
