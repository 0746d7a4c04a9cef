#include "geometry/import/mesh_file.h"
#include "geometry/import/obj_numbers.h"
#include "geometry/mesh/polygon_mesh.h"

#include <tiny_obj_loader.h>

#include <algorithm>
#include <sstream>

namespace sprung {
namespace {

// Builds the faces from the callbacks of tinyobjloader, which arrive in the order of the file.
class FaceBuilder {
 public:
  explicit FaceBuilder(const std::filesystem::path& file, const ObjNumbers& numbers)
      : problems_(file), vertex_count_(std::ssize(numbers.positions)), texcoord_count_(std::ssize(numbers.texcoords)) {}

  PolygonFaces build(const std::string& plain_text) {
    tinyobj::callback_t callbacks;
    callbacks.vertex_cb = [](void* self, auto...) { ++static_cast<FaceBuilder*>(self)->vertices_so_far_; };
    callbacks.texcoord_cb = [](void* self, auto...) { ++static_cast<FaceBuilder*>(self)->texcoords_so_far_; };
    callbacks.index_cb = [](void* self, tinyobj::index_t* corners, int count) {
      static_cast<FaceBuilder*>(self)->add_face(corners, count);
    };
    callbacks.object_cb = [](void* self, const char* name) { static_cast<FaceBuilder*>(self)->begin_group(name); };
    callbacks.group_cb = [](void* self, const char** names, int count) {
      std::string joined;
      for (int i = 0; i < count; ++i) joined += std::string(names[i]) + ' ';
      static_cast<FaceBuilder*>(self)->begin_group(joined);
    };
    std::istringstream stream(plain_text);
    tinyobj::LoadObjWithCallback(stream, callbacks, this);
    problems_.throw_if_any();
    if (std::all_of(faces_.texcoord.begin(), faces_.texcoord.end(), [](Index t) { return t == kNone; })) faces_.texcoord.clear();
    return std::move(faces_);
  }

 private:
  void begin_group(const std::string& name) {
    std::istringstream words(name);
    group_.clear();
    for (std::string word; words >> word;) group_ += (group_.empty() ? "" : " ") + word;
    if (group_.empty()) group_ = "default";  // the format's name for faces without a group
    group_begins_ = true;
  }

  void add_face(const tinyobj::index_t* corners, int count) {
    if (group_begins_) {
      faces_.groups.push_back(group_);
      faces_.group_begin.push_back(faces_.face_count());
      group_begins_ = false;
    }
    for (int corner = 0; corner < count; ++corner) {
      faces_.vertex.push_back(resolve(corners[corner].vertex_index, vertices_so_far_, vertex_count_, "vertices"));
      const int texcoord = corners[corner].texcoord_index;
      faces_.texcoord.push_back(texcoord == 0 ? kNone
                                              : resolve(texcoord, texcoords_so_far_, texcoord_count_, "texture coordinates"));
    }
    check_corners(faces_.vertex.end() - count, faces_.vertex.end());
    faces_.corner_begin.push_back(static_cast<Index>(faces_.vertex.size()));
  }

  // Positive numbers count from 1 in the whole file, negative ones back from the last element before the face.
  Index resolve(int written, std::int64_t so_far, std::int64_t in_file, const std::string& kind) {
    const std::int64_t index = written > 0 ? written - std::int64_t{1} : so_far + written;
    if (index >= 0 && index < in_file) return static_cast<Index>(index);
    problems_.add(location(), std::to_string(written), "must refer to one of the " + std::to_string(in_file) + " " + kind);
    return kNone;
  }

  void check_corners(std::vector<Index>::const_iterator begin, std::vector<Index>::const_iterator end) {
    std::vector<Index> sorted(begin, end);
    std::sort(sorted.begin(), sorted.end());
    const auto twice = std::adjacent_find(sorted.begin(), sorted.end(), [](Index a, Index b) { return a == b && a != kNone; });
    if (twice == sorted.end()) return;
    problems_.add(location(), std::to_string(*twice + 1), "a face must not use a vertex twice",
                  "remove degenerate faces and export again");
  }

  [[nodiscard]] std::string location() const { return "face " + std::to_string(faces_.face_count() + 1); }

  FileProblems problems_;
  PolygonFaces faces_;
  std::string group_;
  bool group_begins_ = false;
  std::int64_t vertex_count_;
  std::int64_t texcoord_count_;
  std::int64_t vertices_so_far_ = 0;
  std::int64_t texcoords_so_far_ = 0;
};

}  // namespace

PolygonMesh read_obj(const std::filesystem::path& file) {
  const std::string text = plain_obj_text(read_mesh_text(file));
  ObjNumbers numbers = read_obj_numbers(file, text);
  if (numbers.positions.empty()) {
    throw InputError(
        Problem{.file = file.string(), .rule = "has no vertices", .remedy = "simulated bodies are read from OBJ files"});
  }
  PolygonMesh mesh;
  mesh.faces = FaceBuilder(file, numbers).build(text);
  mesh.faces.texcoords = std::move(numbers.texcoords);
  mesh.vertices.resize(3, std::ssize(numbers.positions));
  for (Index i = 0; i < mesh.vertices.cols(); ++i) mesh.vertices.col(i) = numbers.positions[i];
  mesh.lines.resize(2, std::ssize(numbers.lines));
  for (Index e = 0; e < mesh.lines.cols(); ++e) mesh.lines.col(e) << numbers.lines[e][0], numbers.lines[e][1];
  return mesh;
}

}  // namespace sprung
