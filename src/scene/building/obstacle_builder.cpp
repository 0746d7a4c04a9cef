#include "scene/building/obstacle_builder.h"

#include "geometry/tetrahedra/tetrahedra_mesh.h"
#include "scene/building/body_builder.h"
#include "scene/format/file_wildcard.h"
#include "scene/json/json_text.h"

#include <algorithm>
#include <utility>

namespace sprung {
namespace {

ObstacleGeometry scaled(const SphereGeometry& sphere, double scale) { return SphereGeometry{scale * sphere.radius}; }
ObstacleGeometry scaled(const BoxGeometry& box, double scale) { return BoxGeometry{scale * box.size}; }
ObstacleGeometry scaled(const CapsuleGeometry& capsule, double scale) {
  return CapsuleGeometry{scale * capsule.radius, scale * capsule.length};
}
ObstacleGeometry scaled(const CylinderGeometry& cylinder, double scale) {
  return CylinderGeometry{scale * cylinder.radius, scale * cylinder.height};
}
ObstacleGeometry scaled(const ConeGeometry& cone, double scale) { return ConeGeometry{scale * cone.radius, scale * cone.height}; }
ObstacleGeometry scaled(const EllipsoidGeometry& ellipsoid, double scale) { return EllipsoidGeometry{scale * ellipsoid.radii}; }
ObstacleGeometry scaled(const HalfSpaceGeometry& half_space, double scale) {
  return HalfSpaceGeometry{half_space.normal, scale * half_space.offset};
}

}  // namespace

template <class Primitive>
std::optional<ObstacleGeometry> ObstacleBuilder::geometry_of(const ObstacleScene& obstacle, const Primitive& primitive) const {
  return scaled(primitive, obstacle.place.scale);
}

std::optional<Obstacle> ObstacleBuilder::build(const ObstacleScene& obstacle) {
  const auto make = [&](const auto& shape) { return geometry_of(obstacle, shape); };
  std::optional<ObstacleGeometry> geometry = std::visit(make, obstacle.shape);
  if (!geometry) return std::nullopt;
  return Obstacle{obstacle.name, std::move(*geometry), pose_of(obstacle.place), obstacle.motion, obstacle.material};
}

std::optional<ObstacleGeometry> ObstacleBuilder::geometry_of(const ObstacleScene& obstacle, const MeshFile& mesh) {
  const std::string key = join_path("obstacles", obstacle.name) + ".shape.file";
  if (is_tetrahedra_file(mesh.file)) {
    problems_.push_back({scene_.file.string(), key, "\"" + mesh.file + "\"",
                         "has the format of tetrahedra, which only a body may be",
                         "save its surface as STL or OBJ, or make it a body of type \"tetrahedra\""});
    return std::nullopt;
  }
  const auto file = finder_.find(mesh.file, key, problems_);
  if (!file) return std::nullopt;
  const std::optional<Import>& imported = import(*file);
  if (!imported) return std::nullopt;
  const double scale = obstacle.place.scale;
  add_report(obstacle, {*file}, imported->report);
  if (scale == 1.0) return MeshGeometry{imported->mesh, imported->report.closed};
  TriangleMesh larger = *imported->mesh;
  larger.vertices *= scale;
  return MeshGeometry{std::make_shared<const TriangleMesh>(std::move(larger)), imported->report.closed};
}

const std::optional<ObstacleBuilder::Import>& ObstacleBuilder::import(const std::filesystem::path& file) {
  const auto [entry, is_new] = imports_.try_emplace(file);
  if (!is_new) return entry->second;
  try {
    ImportedMesh imported = import_mesh(file);
    entry->second = Import{std::make_shared<const TriangleMesh>(std::move(imported.mesh)), std::move(imported.report)};
  } catch (const InputError& error) {
    add_new_problems(error);
  }
  return entry->second;
}

std::optional<ObstacleGeometry> ObstacleBuilder::geometry_of(const ObstacleScene& obstacle, const MeshFiles& mesh) {
  const std::vector<std::filesystem::path> files = find_files(obstacle, mesh);
  if (files.empty()) return std::nullopt;
  try {
    auto [sequence, report] = import_sequence(files);
    add_report(obstacle, files, report);
    const auto* pattern = std::get_if<std::string>(&mesh.files);
    if (const auto last = pattern != nullptr ? file_before_gap(files, *pattern) : std::nullopt) {
      reports_.back().report.notes.push_back("the file numbers have a gap after " + last->filename().string() +
                                             ": the sequence plays without a pause");
    }
    if (!sequence.deforms()) reports_.back().report.notes.emplace_back("all frames are equal: it does not deform");
    for (Points& frame : sequence.frames) frame *= obstacle.place.scale;
    sequence.frame_rate = mesh.frame_rate;
    sequence.start = mesh.start;
    sequence.loop = mesh.loop;
    return SequenceGeometry{std::make_shared<const MeshSequence>(std::move(sequence)), report.closed};
  } catch (const InputError& error) {
    add_new_problems(error);
    return std::nullopt;
  }
}

/// The files in their order; none if one is missing.
std::vector<std::filesystem::path> ObstacleBuilder::find_files(const ObstacleScene& obstacle, const MeshFiles& mesh) const {
  const std::string key = join_path("obstacles", obstacle.name) + ".shape.files";
  if (const auto* pattern = std::get_if<std::string>(&mesh.files)) return finder_.find_all(*pattern, key, problems_);
  const auto& names = std::get<std::vector<std::string>>(mesh.files);
  std::vector<std::filesystem::path> files;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (auto file = finder_.find(names[i], join_path(key, i), problems_)) files.push_back(std::move(*file));
  }
  if (files.size() < names.size()) return {};
  return files;
}

void ObstacleBuilder::add_report(const ObstacleScene& obstacle, const std::vector<std::filesystem::path>& files,
                                 const MeshReport& report) {
  reports_.push_back({obstacle.name, files.front(), files.size(), report});
}

void ObstacleBuilder::add_new_problems(const InputError& error) {
  for (const Problem& problem : error.problems()) {
    if (std::find(problems_.begin(), problems_.end(), problem) == problems_.end()) problems_.push_back(problem);
  }
}

}  // namespace sprung
