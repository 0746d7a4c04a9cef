#include "dynamics/constraints/carried_surface.h"

#include "base/parallel.h"
#include "network/model/activity.h"

#include <algorithm>

namespace sprung {
namespace {

constexpr double kTolerance = 1.0e-3;  // of the cell's diagonal
constexpr Index kCellsPerChunk = 64;

Vector3 carried_position(const CellPoint& point, const Points& positions) {
  Vector3 sum = Vector3::Zero();
  for (std::size_t c = 0; c < point.corners.size(); ++c) sum += point.weights[c] * positions.col(point.corners[c]);
  return sum;
}

}  // namespace

CarriedSurface::CarriedSurface(const SpringNetwork& network) : network_(network) {
  for (const Body& body : network.bodies) {
    if (is_asleep(network, body)) continue;
    for (std::size_t v = 0; v < body.carried.size(); ++v) {
      CellPoint point = body.carried[v];
      for (Index& corner : point.corners) corner += body.first_particle;
      const double diagonal = (network.positions.col(point.corners.front()) - network.positions.col(point.corners.back())).norm();
      vertices_.push_back({body.first_particle + static_cast<Index>(v), point, kTolerance * diagonal});
    }
  }
  std::ranges::stable_sort(vertices_, {}, [](const Vertex& vertex) { return vertex.point.corners; });
  for (std::size_t v = 0; v < vertices_.size(); ++v) {
    if (v == 0 || vertices_[v].point.corners != vertices_[v - 1].point.corners) cell_begin_.push_back(v);
  }
  cells_ = colour_groups(cell_begin_.size(), network.particle_count(),
                         [&](std::size_t cell) { return std::span<const Index>(vertices_[cell_begin_[cell]].point.corners); });
  cell_begin_.push_back(vertices_.size());
}

double CarriedSurface::project(const Points& /*before*/, Points& positions, const ImpulseRecorder& recorder) const {
  std::vector<double> residuals(cells_.order.size(), 0.0);
  for (std::size_t c = 0; c + 1 < cells_.colour_begin.size(); ++c) {
    const std::size_t first = cells_.colour_begin[c];
    parallel_chunks(static_cast<Index>(cells_.colour_begin[c + 1] - first), kCellsPerChunk, [&](Index begin, Index end) {
      for (std::size_t k = first + begin; k < first + end; ++k) {
        const std::size_t cell = cells_.order[k];
        for (std::size_t v = cell_begin_[cell]; v < cell_begin_[cell + 1]; ++v) {
          residuals[k] = std::max(residuals[k], project(vertices_[v], positions, recorder));
        }
      }
    });
  }
  return residuals.empty() ? 0.0 : std::ranges::max(residuals);
}

double CarriedSurface::project(const Vertex& vertex, Points& positions, const ImpulseRecorder& recorder) const {
  const Scalars& inverse_masses = network_.inverse_masses;
  const Vector3 off = positions.col(vertex.particle) - carried_position(vertex.point, positions);
  double sum = inverse_masses[vertex.particle];
  for (std::size_t c = 0; c < vertex.point.corners.size(); ++c) {
    sum += vertex.point.weights[c] * vertex.point.weights[c] * inverse_masses[vertex.point.corners[c]];
  }
  if (sum > 0.0) {
    positions.col(vertex.particle) -= inverse_masses[vertex.particle] / sum * off;
    for (std::size_t c = 0; c < vertex.point.corners.size(); ++c) {
      positions.col(vertex.point.corners[c]) += vertex.point.weights[c] * inverse_masses[vertex.point.corners[c]] / sum * off;
    }
    if (recorder.on()) record_pinned(vertex, off / sum, recorder);
  }
  return off.norm() / vertex.tolerance;
}

/// `multiplier` [kg m] is the momentum that the projection gives to the corners, minus that of the particle.
void CarriedSurface::record_pinned(const Vertex& vertex, const Vector3& multiplier, const ImpulseRecorder& recorder) const {
  if (network_.is_fixed(vertex.particle)) recorder.add_to_pinned(vertex.particle, -multiplier);
  for (std::size_t c = 0; c < vertex.point.corners.size(); ++c) {
    const Index corner = vertex.point.corners[c];
    if (network_.is_fixed(corner)) recorder.add_to_pinned(corner, vertex.point.weights[c] * multiplier);
  }
}

double CarriedSurface::residual(const Points& positions) const {
  double largest = 0.0;
  for (const Vertex& vertex : vertices_) {
    const Vector3 off = positions.col(vertex.particle) - carried_position(vertex.point, positions);
    largest = std::max(largest, off.norm() / vertex.tolerance);
  }
  return largest;
}

}  // namespace sprung
