// Writes the environments of this folder: generate_meshes FOLDER, or compares them with what it would write: generate_meshes
// --check FOLDER.
#include "dress_shapes.h"
#include "mesh_shapes.h"
#include "mesh_writers.h"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace sprung;
using namespace sprung::meshes;

std::string obj_of(const PolygonMesh& mesh) { return "# metres, Y up\n" + obj_text(mesh.vertices, mesh.faces, mesh.lines); }

PolygonMesh polygons_of(const TriangleMesh& mesh) {
  return {.vertices = mesh.vertices, .faces = to_polygons(mesh.triangles), .lines = Edges(2, 0)};
}

// The terrain lies in the unit square; its nodes stretch it to 4 m x 4 m, turn it by a quarter and centre it.
std::string terrain_text() {
  const Place outer{"[1, 1, 1]", "[0, 0, 0, 1]", "[-2, 0, 2]"};
  const Place inner{"[4, 0.3, 4]", "[0, 0.7071067811865476, 0, 0.7071067811865476]", "[0, 0, 0]"};
  return gltf_text(hills(), outer, inner);
}

std::vector<std::pair<std::string, std::string>> all_files() {
  std::vector<std::pair<std::string, std::string>> files{
      {"stairs.obj", obj_of(stairs())},          {"funnel.stl", stl_bytes(funnel())},
      {"torus.ply", ply_bytes(torus())},         {"terrain.gltf", terrain_text()},
      {"spike.off", off_text(spike())},          {"thin_sheet.obj", obj_of(thin_sheet())},
      {"ball.obj", obj_of(polygons_of(ball()))}, {"balloon.obj", obj_of(polygons_of(balloon()))},
      {"figure.ply", ply_bytes(figure())},       {"dress.obj", obj_of(dress())}};
  constexpr int kWaveFrames = 8;
  for (int frame = 0; frame < kWaveFrames; ++frame) {
    files.emplace_back("waves/waves." + std::to_string(frame + 1) + ".obj",
                       obj_of(waves(static_cast<double>(frame) / kWaveFrames)));
  }
  return files;
}

bool write(const std::filesystem::path& file, const std::string& bytes) {
  std::error_code ignored;  // the file cannot be written then
  std::filesystem::create_directories(file.parent_path(), ignored);
  return static_cast<bool>(std::ofstream(file, std::ios::binary) << bytes << std::flush);
}

bool is_same(const std::filesystem::path& file, const std::string& bytes) {
  std::ifstream stream(file, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(stream), {}) == bytes;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  const bool check = arguments.size() == 2 && arguments[0] == "--check";
  if (!check && arguments.size() != 1) {
    std::fputs("usage: generate_meshes [--check] FOLDER\n", stderr);
    return 2;
  }
  int failures = 0;
  for (const auto& [name, bytes] : all_files()) {
    const std::filesystem::path file = std::filesystem::path(arguments.back()) / name;
    if (check ? is_same(file, bytes) : write(file, bytes)) continue;
    std::fprintf(stderr, "%s %s\n", file.string().c_str(), check ? "differs from what is generated" : "cannot be written");
    ++failures;
  }
  return failures == 0 ? 0 : 1;
}
