#include "simulation/diagnostics.h"

#include "collision/obstacles/obstacle_frame.h"
#include "simulation/simulator.h"

#include <algorithm>
#include <chrono>

namespace sprung {
namespace {

// Search range of the distance from the environment [m]: the extent of the network and of its motion, plus some gaps.
double distance_range(const Simulator& simulator) {
  double thickest = 0.0;
  for (const Body& body : simulator.network().bodies) thickest = std::max(thickest, body.material.thickness);
  for (const Obstacle& obstacle : simulator.obstacles()) thickest = std::max(thickest, obstacle.material.thickness);
  const Box3 covered = bounds(simulator.positions()).merged(bounds(simulator.network().positions));
  return covered.diagonal().norm() + 10.0 * thickest;
}

}  // namespace

double kinetic_energy(const Simulator& simulator) {
  return 0.5 * simulator.network().masses.dot(simulator.state().v.colwise().squaredNorm().transpose());
}

double max_stretch(const Simulator& simulator) {
  const Springs& springs = simulator.network().springs;
  const Points& x = simulator.positions();
  double most = 0.0;
  for (std::size_t s = 0; s < springs.first.size(); ++s) {
    if (springs.kind[s] != SpringKind::structural || springs.rest_length[s] == 0.0) continue;
    const double length = (x.col(springs.first[s]) - x.col(springs.second[s])).norm();
    most = std::max(most, length / springs.rest_length[s] - 1.0);
  }
  return most;
}

Index inverted_cells(const Simulator& simulator) {
  Index count = 0;
  for (const Body& body : simulator.network().bodies) {
    count += count_inverted(body.cells, simulator.positions().middleCols(body.first_particle, body.particle_count));
  }
  return count;
}

FrameDiagnostics diagnostics_without_distance(const Simulator& simulator) {
  FrameDiagnostics diagnostics;
  diagnostics.frame = static_cast<int>(simulator.state().frame) + 1;
  diagnostics.time = simulator.time();
  diagnostics.kinetic_energy = kinetic_energy(simulator);
  diagnostics.elastic_energy = simulator.elastic_energy();
  diagnostics.gravity_energy = simulator.gravity_energy();
  diagnostics.contact_energy = simulator.contact_energy();
  diagnostics.max_stretch = max_stretch(simulator);
  diagnostics.contacts = simulator.contact_count();
  diagnostics.inverted_cells = inverted_cells(simulator);
  return diagnostics;
}

FrameDiagnostics present_diagnostics(const Simulator& simulator) {
  FrameDiagnostics diagnostics = diagnostics_without_distance(simulator);
  diagnostics.min_distance = simulator.obstacle_frame().min_distance(contact_positions(simulator.network(), simulator.positions()),
                                                                     distance_range(simulator));
  return diagnostics;
}

void StepSums::add(const StepReport& step) {
  if (sum_.substeps == 0 || step.substeps > max_substeps_) reason_ = step.reason;
  max_substeps_ = std::max(max_substeps_, step.substeps);
  sum_ += step;
}

void StepSums::write(double step, FrameDiagnostics& diagnostics) const {
  diagnostics.stretch_excess = sum_.stretch_excess;
  diagnostics.truncated = sum_.truncated;
  diagnostics.infeasible = sum_.infeasible;
  diagnostics.max_infeasible = sum_.max_infeasible;
  diagnostics.substeps = sum_.substeps;
  diagnostics.reason = reason_;
  diagnostics.smallest_step = sum_.substeps > 0 ? step / max_substeps_ : 0.0;
  diagnostics.limit_solves = sum_.limit_solves;
}

FrameRunner::FrameRunner(Simulator& simulator) : simulator_(simulator) {}

FrameDiagnostics FrameRunner::first_frame() const { return present_diagnostics(simulator_); }

FrameDiagnostics FrameRunner::next_frame() {
  const auto begin = std::chrono::steady_clock::now();
  simulator_.reset_forces();
  StepSums sums;
  do {
    sums.add(simulator_.step());
  } while (simulator_.state().step_in_frame != 0);
  simulator_.check();
  const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - begin;

  FrameDiagnostics diagnostics = present_diagnostics(simulator_);
  sums.write(simulator_.settings().step, diagnostics);
  diagnostics.frame_ms = elapsed.count();
  return diagnostics;
}

}  // namespace sprung
