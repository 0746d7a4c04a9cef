// Builds the obstacles of a scene.
#pragma once

#include "collision/shapes/obstacle.h"
#include "scene/building/mesh_finder.h"
#include "scene/building/scene_builder.h"

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sprung {

/// Builds obstacles; imports a mesh once if several obstacles use it.
class ObstacleBuilder {
 public:
  /// Keeps references to all arguments.
  ObstacleBuilder(const Scene& scene, const MeshFinder& finder, std::vector<Problem>& problems)
      : scene_(scene), finder_(finder), problems_(problems) {}

  /// The obstacle with its scale applied. Adds all problems; none if there are any.
  [[nodiscard]] std::optional<Obstacle> build(const ObstacleScene& obstacle);

  /// Reports on the imported meshes.
  [[nodiscard]] const std::vector<NamedReport>& reports() const { return reports_; }

 private:
  struct Import {
    std::shared_ptr<const TriangleMesh> mesh;
    MeshReport report;
  };
  [[nodiscard]] std::optional<ObstacleGeometry> geometry_of(const ObstacleScene& obstacle, const MeshFile& mesh);
  [[nodiscard]] std::optional<ObstacleGeometry> geometry_of(const ObstacleScene& obstacle, const MeshFiles& mesh);
  template <class Primitive>
  [[nodiscard]] std::optional<ObstacleGeometry> geometry_of(const ObstacleScene& obstacle, const Primitive& primitive) const;
  [[nodiscard]] std::vector<std::filesystem::path> find_files(const ObstacleScene& obstacle, const MeshFiles& mesh) const;
  void add_report(const ObstacleScene& obstacle, const std::vector<std::filesystem::path>& files, const MeshReport& report);
  void add_new_problems(const InputError& error);
  [[nodiscard]] const std::optional<Import>& import(const std::filesystem::path& file);

  const Scene& scene_;
  const MeshFinder& finder_;
  std::vector<Problem>& problems_;
  std::map<std::filesystem::path, std::optional<Import>> imports_;  ///< none: the import failed and was reported
  std::vector<NamedReport> reports_;
};

}  // namespace sprung
