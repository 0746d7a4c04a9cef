#include "collision/shapes/mesh_validation.h"

#include "base/error.h"
#include "base/format.h"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace sprung {

namespace {

// The search computes squared distances in single precision first. The square of a larger coordinate would not be finite.
constexpr double kLargestCoordinate = 1e15;

/// Adds a problem for the first invalid vertex only.
void check_vertices(const std::string& key, const Points& vertices, std::vector<Problem>& problems) {
  for (Index i = 0; i < vertices.cols(); ++i) {
    if ((vertices.col(i).array().abs() <= kLargestCoordinate).all()) continue;
    const bool finite = vertices.col(i).allFinite();
    problems.push_back(
        {.key = key + ": vertex " + std::to_string(i),
         .rule = finite ? "must be within " + format_number(kLargestCoordinate) + " m of the origin" : "must be finite",
         .remedy = finite ? "use a smaller scale" : "import and clean the mesh"});
    return;
  }
}

void check_triangles(const std::string& key, const Triangles& triangles, Eigen::Index vertices, std::vector<Problem>& problems) {
  if (triangles.cols() == 0) problems.push_back({.key = key, .rule = "must have triangles"});
  for (Index t = 0; t < triangles.cols(); ++t) {
    const auto corners = triangles.col(t);
    if (corners.minCoeff() >= 0 && corners.maxCoeff() < vertices) continue;
    problems.push_back({.key = key + ": triangle " + std::to_string(t),
                        .rule = "must use vertices from 0 to " + std::to_string(vertices - 1),
                        .remedy = "import and clean the mesh"});
  }
}

}  // namespace

void require_usable(const TriangleMesh& mesh) {
  std::vector<Problem> problems;
  check_vertices("mesh", mesh.vertices, problems);
  check_triangles("mesh", mesh.triangles, mesh.vertices.cols(), problems);
  if (!problems.empty()) throw InputError(std::move(problems));
}

void require_usable(const MeshSequence& sequence) {
  if (sequence.frames.empty()) throw InputError(Problem{.key = "sequence", .rule = "must have frames"});
  std::vector<Problem> problems;
  const Eigen::Index vertices = sequence.frames.front().cols();
  for (std::size_t k = 0; k < sequence.frames.size(); ++k) {
    const std::string key = "sequence: frame " + std::to_string(k);
    check_vertices(key, sequence.frames[k], problems);
    if (sequence.frames[k].cols() == vertices) continue;
    problems.push_back({.key = key,
                        .value = std::to_string(sequence.frames[k].cols()) + " vertices",
                        .rule = "must have as many as the first frame, " + std::to_string(vertices)});
  }
  check_triangles("sequence", sequence.triangles, vertices, problems);
  if (!(std::isfinite(sequence.frame_rate) && sequence.frame_rate > 0.0)) {
    problems.push_back(
        {.key = "frame_rate", .value = format_number(sequence.frame_rate), .rule = "must be greater than 0 and finite"});
  }
  if (!std::isfinite(sequence.start)) {
    problems.push_back({.key = "start", .value = format_number(sequence.start), .rule = "must be finite"});
  }
  if (!problems.empty()) throw InputError(std::move(problems));
}

}  // namespace sprung
