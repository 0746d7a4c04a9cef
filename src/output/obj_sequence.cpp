#include "output/obj_sequence.h"

#include "base/error.h"
#include "base/format.h"
#include "base/parallel.h"
#include "output/file_pattern.h"
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

void check_names(const Simulator& simulator) {
  std::vector<std::string> bodies;
  std::vector<std::string> obstacles;
  for (const Body& body : simulator.network().bodies) bodies.push_back(body.name);
  for (const Obstacle& obstacle : simulator.environment().obstacles()) obstacles.push_back(obstacle.name);
  std::vector<Problem> problems;
  check_names("body", bodies, problems);
  check_names("obstacle", obstacles, problems);
  if (std::find(bodies.begin(), bodies.end(), kObstacleFolder) != bodies.end()) {
    problems.push_back({"", "body", '"' + kObstacleFolder + '"', "is reserved for the folder of the obstacles", "rename it"});
  }
  if (!problems.empty()) throw InputError(std::move(problems));
}

ObjSequence body_sequence(const Body& body, int frames) {
  const auto vertices = [first = body.first_particle, count = body.particle_count](const Simulator& simulator) -> Points {
    return simulator.positions().middleCols(first, count);
  };
  return {sequence_pattern(body.name + "/" + body.name, frames), vertices, body.surface.faces, body.surface.segments};
}

TriangleMesh surface_mesh(const Obstacle& obstacle, const Box3& scene) {
  const bool endless = std::holds_alternative<HalfSpaceGeometry>(obstacle.geometry);
  return obstacle_mesh(obstacle.geometry, endless ? half_space_extent(scene, obstacle) : 0.0);
}

ObjSequence obstacle_sequence(const Obstacle& obstacle, Index number, const Box3& scene, int frames) {
  const TriangleMesh mesh = surface_mesh(obstacle, scene);
  const auto vertices = [number, local = mesh.vertices](const Simulator& simulator) -> Points {
    const Obstacle& present = simulator.environment().obstacles()[static_cast<std::size_t>(number)];
    const RigidTransform pose = present.motion.pose(present.rest_pose, simulator.time());
    if (!std::holds_alternative<SequenceGeometry>(present.geometry)) return pose * local;
    return pose * obstacle_mesh(present.geometry, 0.0, simulator.time()).vertices;
  };
  const std::string name = kObstacleFolder + "/" + obstacle.name;
  const std::string pattern = obstacle.changes() ? sequence_pattern(name + "/" + obstacle.name, frames) : name + ".obj";
  return {pattern, vertices, to_polygons(mesh.triangles), Edges(2, 0)};
}

}  // namespace

ObjSequence::ObjSequence(std::string pattern, std::function<Points(const Simulator&)> vertices, const PolygonFaces& faces,
                         const Edges& lines)
    : pattern_(std::move(pattern)), vertices_(std::move(vertices)), elements_(obj_text(Points(3, 0), faces, lines)) {}

bool ObjSequence::changes() const { return pattern_.find('#') != std::string::npos; }

std::string ObjSequence::text(const Simulator& simulator) const { return vertex_lines(vertices_(simulator)) + elements_; }

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
  const char* const end = text.data() + text.size();
  for (const char* line = text.data(); line != end;) {
    const char* const line_end = std::find(line, end, '\n');
    if (line_end - line > 2 && line[0] == 'v' && line[1] == ' ') {
      const std::size_t before = numbers.size();
      const char* at = line + 2;
      double number = 0.0;
      while (numbers.size() < before + 3) {
        const auto read = std::from_chars(at, line_end, number);
        if (read.ec != std::errc{}) break;
        numbers.push_back(number);
        at = std::find_if(read.ptr, line_end, [](char letter) { return letter != ' '; });
      }
      if (numbers.size() < before + 3) numbers.resize(before);
    }
    line = line_end == end ? end : line_end + 1;
  }
  return Points::Map(numbers.data(), 3, static_cast<Eigen::Index>(numbers.size() / 3));
}

std::vector<ObjSequence> obj_sequences(const Simulator& simulator, int frames) {
  check_names(simulator);
  std::vector<ObjSequence> sequences;
  for (const Body& body : simulator.network().bodies) sequences.push_back(body_sequence(body, frames));
  const std::vector<Obstacle>& obstacles = simulator.environment().obstacles();
  const Box3 scene = scene_bounds(simulator);
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    sequences.push_back(obstacle_sequence(obstacles[i], static_cast<Index>(i), scene, frames));
  }
  return sequences;
}

}  // namespace sprung
