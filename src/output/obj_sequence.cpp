#include "output/obj_sequence.h"

#include "base/error.h"
#include "base/files/file_pattern.h"
#include "base/format.h"
#include "base/parallel.h"
#include "geometry/import/text_words.h"
#include "output/scene_extent.h"

#include <algorithm>
#include <charconv>
#include <numeric>
#include <set>
#include <utility>

namespace sprung {
namespace {

constexpr Index kVerticesPerChunk = 4096;
constexpr std::size_t kBytesPerVertex = 64;
const std::string kObstacleFolder = "obstacles";

std::string chunk_lines(const Points& vertices, Index begin, Index end) {
  std::string text;
  text.reserve(static_cast<std::size_t>(end - begin) * kBytesPerVertex);
  for (Index i = begin; i < end; ++i) {
    text += 'v';
    for (int axis = 0; axis < 3; ++axis) {
      text += ' ';
      append_number(text, vertices(axis, i));
    }
    text += '\n';
  }
  return text;
}

bool is_folder_name(const std::string& name) {
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  return !name.empty() && std::all_of(name.begin(), name.end(), allowed);
}

void check_names(const char* key, const std::vector<std::string>& names, std::vector<Problem>& problems) {
  std::set<std::string> seen;
  for (const std::string& name : names) {
    if (!is_folder_name(name)) {
      problems.push_back(
          {"", key, '"' + name + '"', "must consist of letters, digits, _ and -, because it names a folder", "rename it"});
    } else if (!seen.insert(name).second) {
      problems.push_back({"", key, '"' + name + '"', "must be unique, because it names a folder", "rename one of them"});
    }
  }
}

Points exported_positions(const Simulator& simulator, const Body& body) {
  return simulator.positions().middleCols(body.first_particle, body.exported_vertex_count());
}

std::string surface_text(const Simulator& simulator, const Body& body, const std::string& elements) {
  return vertex_lines(exported_positions(simulator, body)) + elements;
}

std::string element_lines(const Body& body) {
  const Surface& surface = body.surface;
  if (surface.torn.empty()) return obj_text(Points(3, 0), surface.faces, surface.segments);
  return obj_text(Points(3, 0), without_faces(surface.faces, surface.torn), surface.segments);
}

ObjSequence body_sequence(const Simulator& simulator, std::size_t number, const ObjSources& sources, int frames) {
  const Body& body = simulator.network().bodies[number];
  const std::string pattern = sequence_pattern(body.name + "/" + body.name, frames);
  if (const auto source = sources.find(body.name); source != sources.end()) {
    return {pattern, [number, source = source->second](const Simulator& present) {
              return body_obj_text(present, present.network().bodies[number], source.get());
            }};
  }
  return {pattern, [number, elements = element_lines(body)](const Simulator& present) {
            const Body& now = present.network().bodies[number];
            return surface_text(present, now, present.state().springs.broken_count() == 0 ? elements : element_lines(now));
          }};
}

ObjSequence obstacle_sequence(const Obstacle& obstacle, Index number, const Box3& scene, int frames) {
  const TriangleMesh mesh = surface_mesh(obstacle, scene);
  const auto vertices = [number, local = mesh.vertices](const Simulator& simulator) -> Points {
    const Obstacle& present = simulator.obstacles()[static_cast<std::size_t>(number)];
    const RigidTransform pose = present.motion.pose(present.rest_pose, simulator.time());
    if (!std::holds_alternative<SequenceGeometry>(present.geometry)) return pose * local;
    return pose * obstacle_mesh(present.geometry, 0.0, simulator.time()).vertices;
  };
  const std::string name = kObstacleFolder + "/" + obstacle.name;
  const std::string pattern = obstacle.changes() ? sequence_pattern(name + "/" + obstacle.name, frames) : name + ".obj";
  const auto text = [vertices, elements = obj_text(Points(3, 0), to_polygons(mesh.triangles), Edges(2, 0))](
                        const Simulator& simulator) { return vertex_lines(vertices(simulator)) + elements; };
  return {pattern, text};
}

}  // namespace

ObjSequence::ObjSequence(std::string pattern, std::function<std::string(const Simulator&)> text)
    : pattern_(std::move(pattern)), text_(std::move(text)) {}

bool ObjSequence::changes() const { return pattern_.find('#') != std::string::npos; }

std::string vertex_lines(const Points& vertices) {
  const Index count = static_cast<Index>(vertices.cols());
  std::vector<std::string> chunks(static_cast<std::size_t>((count + kVerticesPerChunk - 1) / kVerticesPerChunk));
  parallel_chunks(count, kVerticesPerChunk, [&](Index begin, Index end) {
    chunks[static_cast<std::size_t>(begin / kVerticesPerChunk)] = chunk_lines(vertices, begin, end);
  });
  return std::accumulate(chunks.begin(), chunks.end(), std::string());
}

Points read_vertex_lines(const std::string& text) {
  std::vector<double> numbers;
  const auto ends_line = [](char letter) { return letter == '\n' || letter == '\r'; };
  const char* const end = text.data() + text.size();
  for (const char* line = text.data(); line != end;) {
    const char* const line_end = std::find_if(line, end, ends_line);
    const char* at = std::find_if_not(line, line_end, is_blank);
    if (line_end - at > 2 && at[0] == 'v' && is_blank(at[1])) {
      const std::size_t before = numbers.size();
      double number = 0.0;
      for (++at; numbers.size() < before + 3;) {
        const auto read = std::from_chars(std::find_if_not(at, line_end, is_blank), line_end, number);
        if (read.ec != std::errc{}) break;
        numbers.push_back(number);
        at = read.ptr;
      }
      if (numbers.size() < before + 3) numbers.resize(before);
    }
    line = line_end == end ? end : line_end + 1;
  }
  return Points::Map(numbers.data(), 3, static_cast<Eigen::Index>(numbers.size() / 3));
}

std::string body_obj_text(const Simulator& simulator, const Body& body, const ObjSource* source) {
  if (source == nullptr) return surface_text(simulator, body, element_lines(body));
  const Surface& surface = body.surface;
  return source->text(exported_positions(simulator, body), body.contact_only == 0 ? surface.triangles : triangulate(surface.faces),
                      surface.torn);
}

void check_output_names(const Simulator& simulator) {
  std::vector<std::string> bodies;
  std::vector<std::string> obstacles;
  for (const Body& body : simulator.network().bodies) bodies.push_back(body.name);
  for (const Obstacle& obstacle : simulator.obstacles()) obstacles.push_back(obstacle.name);
  std::vector<Problem> problems;
  check_names("body", bodies, problems);
  check_names("obstacle", obstacles, problems);
  if (std::find(bodies.begin(), bodies.end(), kObstacleFolder) != bodies.end()) {
    problems.push_back({"", "body", '"' + kObstacleFolder + '"', "is reserved for the folder of the obstacles", "rename it"});
  }
  if (!problems.empty()) throw InputError(std::move(problems));
}

std::vector<ObjSequence> obj_sequences(const Simulator& simulator, const ObjSources& sources, int frames) {
  std::vector<ObjSequence> sequences;
  for (std::size_t i = 0; i < simulator.network().bodies.size(); ++i) {
    sequences.push_back(body_sequence(simulator, i, sources, frames));
  }
  const std::vector<Obstacle>& obstacles = simulator.obstacles();
  const Box3 scene = scene_bounds(simulator);
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    sequences.push_back(obstacle_sequence(obstacles[i], static_cast<Index>(i), scene, frames));
  }
  return sequences;
}

std::vector<CopiedFile> copied_files(const ObjSources& sources) {
  std::vector<CopiedFile> files;
  for (const auto& [body, source] : sources) {
    for (const MaterialFile& file : source->materials.files) files.push_back({.path = body + "/" + file.place, .file = file});
  }
  return files;
}

}  // namespace sprung
