#include "base/parallel.h"
#include "geometry/import/mesh_file.h"
#include "geometry/mesh/mesh_sequence.h"
#include "geometry/mesh/polygon_mesh.h"

#include <optional>
#include <string>
#include <utility>

namespace sprung {
namespace {

using Files = std::vector<std::filesystem::path>;

// The problems after these are only counted.
constexpr std::size_t kProblemsKept = 20;

constexpr const char* kOneTopology = "export all frames of one mesh, by a deformation that keeps its faces";

/// The frame; none if its file has problems, which are added.
std::optional<PolygonMesh> read_frame(const std::filesystem::path& file, std::vector<Problem>& problems) {
  if (lower_case_extension(file) != ".obj") {
    problems.push_back({.file = file.string(),
                        .value = file.extension().string(),
                        .rule = "must be an OBJ file, which keeps the order of vertices",
                        .remedy = "export the sequence as OBJ"});
    return std::nullopt;
  }
  try {
    return read_obj(file);
  } catch (const InputError& error) {
    problems = error.problems();
    return std::nullopt;
  }
}

/// The first face whose corners differ; kNone if there is none.
Index first_other_face(const PolygonFaces& faces, const PolygonFaces& expected) {
  for (Index face = 0; face < expected.face_count(); ++face) {
    const auto corners = [face](const PolygonFaces& of) {
      return std::vector<Index>(of.vertex.begin() + of.corner_begin[face], of.vertex.begin() + of.corner_begin[face + 1]);
    };
    if (corners(faces) != corners(expected)) return face;
  }
  return kNone;
}

/// Adds the differences of a file's frame from the first frame.
void compare(const PolygonMesh& frame, const PolygonMesh& first, const Files& files, std::size_t file,
             std::vector<Problem>& problems) {
  const std::string first_name = files.front().filename().string();
  const auto require_count = [&](Eigen::Index count, Eigen::Index expected, const char* what) {
    if (count == expected) return true;
    problems.push_back({.file = files[file].string(),
                        .value = std::to_string(count) + " " + what,
                        .rule = "must be equally many as in " + first_name + ", which has " + std::to_string(expected),
                        .remedy = kOneTopology});
    return false;
  };
  require_count(frame.vertices.cols(), first.vertices.cols(), "vertices");
  if (!require_count(frame.faces.face_count(), first.faces.face_count(), "faces")) return;
  const Index face = first_other_face(frame.faces, first.faces);
  if (face == kNone) return;
  problems.push_back({.file = files[file].string(),
                      .key = "face " + std::to_string(face + 1),
                      .rule = "must have the same corners as in " + first_name,
                      .remedy = kOneTopology});
}

void throw_all(const std::vector<std::vector<Problem>>& of_files) {
  std::vector<Problem> problems;
  for (const auto& of_file : of_files) problems.insert(problems.end(), of_file.begin(), of_file.end());
  if (problems.empty()) return;
  if (problems.size() > kProblemsKept) {
    const std::size_t more = problems.size() - kProblemsKept;
    problems.resize(kProblemsKept);
    problems.push_back({.rule = "the sequence has " + std::to_string(more) + " more problems like these"});
  }
  throw InputError(std::move(problems));
}

}  // namespace

ImportedSequence import_sequence(const Files& files) {
  std::vector<std::vector<Problem>> problems(files.size());
  const std::optional<PolygonMesh> first = read_frame(files.front(), problems.front());
  std::vector<Points> frames(files.size());
  parallel_chunks(static_cast<Index>(files.size()) - 1, 1, [&](Index begin, Index /*end*/) {
    const auto file = static_cast<std::size_t>(begin) + 1;
    std::optional<PolygonMesh> frame = read_frame(files[file], problems[file]);
    if (!first || !frame) return;
    compare(*frame, *first, files, file, problems[file]);
    frames[file] = std::move(frame->vertices);
  });
  throw_all(problems);

  frames.front() = first->vertices;
  ImportedSequence result = clean_sequence({.triangles = triangulate(first->faces), .frames = std::move(frames)});
  if (result.sequence.triangles.cols() > 0) return result;
  throw InputError(Problem{.file = files.front().string(),
                           .rule = first->faces.face_count() == 0 ? "has no faces" : "has no face with an area in any frame",
                           .remedy = "export it again, with its surface"});
}

}  // namespace sprung
