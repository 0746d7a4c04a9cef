#include "simulation/frame_watch.h"

#include "base/format.h"
#include "dynamics/stretch_limit/stretch_limit.h"
#include "network/model/activity.h"
#include "simulation/simulator.h"
#include "simulation/step/frame_steps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace sprung {
namespace {

// Many particles and many frames: these fractions of all.
constexpr double kManyParticles = 0.05;
constexpr double kManyFrames = 0.1;

// A resting particle falls by g dt^2 in a step before contact lifts it. Layers whose gap is less than so many times that use it up
// in a few steps; from then on truncation stops them at their surfaces.
constexpr double kFallsWithinGap = 16.0;

// A step that has to be smaller by more than this factor is no remedy that anyone can wait for.
constexpr double kMostTimesSmaller = 4096.0;

/// The smallest gap [m] between any body and obstacle, two bodies, or two sheets of a body; infinite if nothing can collide.
double thinnest_gap(const std::vector<Body>& bodies, const std::vector<Obstacle>& obstacles) {
  double gap = std::numeric_limits<double>::infinity();
  for (const Obstacle& obstacle : obstacles) {
    for (const Body& body : bodies) gap = std::min(gap, body.material.thickness + obstacle.material.thickness);
  }
  for (std::size_t a = 0; a < bodies.size(); ++a) {
    if (bodies[a].contact.self) gap = std::min(gap, bodies[a].material.thickness);
    for (std::size_t b = 0; b < a; ++b) {
      if (!bodies[a].contact.others || !bodies[b].contact.others) continue;
      gap = std::min(gap, 0.5 * (bodies[a].material.thickness + bodies[b].material.thickness));
    }
  }
  return gap;
}

bool moves_anything(const Simulator& simulator) {
  return has_moving_pin(simulator.network().pins) ||
         std::ranges::any_of(simulator.obstacles(), [](const Obstacle& obstacle) { return obstacle.motion.moves(); });
}

void note_stretch(const Simulator& simulator, const FrameDiagnostics& frame, FrameMemory::Missed& missed) {
  const auto& limit = simulator.settings().stretch_limit;
  if (!limit || frame.stretch_excess <= tolerated_excess(*limit, simulator.settings().inner_substeps > 1)) return;
  ++missed.frames;
  if (frame.stretch_excess <= missed.largest) return;
  missed.largest = frame.stretch_excess;
  missed.worst_frame = frame.frame;
  missed.pins = largest_pin_stretch(find_tethers(simulator.network(), limit->kinds), simulator.positions());
}

std::string remedy_for_stretch(const Simulator& simulator, const FrameMemory::Missed& missed) {
  const StretchLimitSettings& limit = *simulator.settings().stretch_limit;
  if (const PinStretch& pins = missed.pins; pins.stretch > limit.max_stretch) {
    const double allowed = (1.0 + limit.max_stretch) * pins.length;
    return "Two pins of body \"" + simulator.network().body_of(pins.first).name + "\" are " +
           format_number((1.0 + pins.stretch) * pins.length, 3) + " m apart in that frame, but the springs between them are " +
           format_number(pins.length, 3) + " m long and may be " + format_number(allowed, 3) +
           " m, so no solver can keep the limit. Keep these pins at most " + format_upper_bound(allowed, 3) + " m apart.";
  }
  const bool is_gauss_seidel = limit.solver == StretchLimitSettings::Solver::gauss_seidel;
  const bool can_be_solved = is_gauss_seidel && limit.max_compression == 1.0;
  const double times = std::max(2.0, std::ceil(missed.largest / wanted_excess(limit)));
  if (can_be_solved || simulator.stretch_solver() != "newton") {
    // What passes leave falls at least in proportion to the step. A step that is typed has no inner substeps.
    const SimulatorSettings& settings = simulator.settings();
    const auto step =
        times <= kMostTimesSmaller ? step_to_type(settings.frame_rate, settings.longest_substep() / times) : std::nullopt;
    const std::string smaller = step ? "use a \"step\" of " + format_number(*step) + " s" : "use a smaller \"step\"";
    return std::string("Raise \"iterations\" of \"stretch_limit\", ") +
           (can_be_solved ? smaller + " or, for ropes and cloths, \"solver\": \"auto\"." : "or " + smaller + ".");
  }
  // The excess that Newton's method leaves is proportional to the step; more iterations do not help.
  return "Use a step " + format_number(times, 2) + " times smaller" +
         (moves_anything(simulator) ? ", or let pins and obstacles move more slowly." : ".");
}

}  // namespace

void note_frame(const Simulator& simulator, const FrameDiagnostics& frame, FrameMemory& memory) {
  note_stretch(simulator, frame, memory.missed);
  ++memory.frames;
  // Inner substeps share one truncation.
  const double contact_steps = static_cast<double>(frame.substeps) / simulator.settings().inner_substeps;
  const double particles = contact_steps * static_cast<double>(simulator.network().particle_count());
  // Obstacles that close on a body stop many particles at any thickness; such frames have infeasible vertices.
  if (frame.infeasible == 0 && static_cast<double>(frame.truncated) > kManyParticles * particles) ++memory.truncated_frames;
}

std::optional<std::string> infeasible_warning(const FrameDiagnostics& frame) {
  if (frame.infeasible == 0) return std::nullopt;
  return "frame " + std::to_string(frame.frame) + ": " +
         counted(static_cast<std::size_t>(frame.max_infeasible), "vertex", "vertices") +
         " had no admissible position and may intersect (column infeasible in diagnostics.csv). Increase the clearance, move pins "
         "out "
         "of obstacles, or slow the obstacles and pins that close on them.";
}

std::optional<std::string> inverted_warning(const Simulator& simulator, const FrameDiagnostics& frame) {
  if (frame.inverted_cells == 0) return std::nullopt;
  const bool preserved =
      std::ranges::all_of(simulator.network().bodies, [](const Body& body) { return body.preserve_volume || body.cells.empty(); });
  return "frame " + std::to_string(frame.frame) + ": " +
         counted(static_cast<std::size_t>(frame.inverted_cells), "cell is", "cells are") +
         " inside out (column inverted_cells in diagnostics.csv). Use " +
         (preserved ? "a smaller step, or more stiffness."
                    : "\"volume\": { \"preserve\": true } for the solid, or more stiffness.");
}

std::optional<std::string> missed_limit_warning(const Simulator& simulator, const FrameMemory& memory) {
  const FrameMemory::Missed& missed = memory.missed;
  if (missed.frames == 0) return std::nullopt;
  const StretchLimitSettings& limit = *simulator.settings().stretch_limit;
  return "the stretch limit was missed by more than " +
         format_number(100.0 * tolerated_excess(limit, simulator.settings().inner_substeps > 1), 2) + " % of a rest length in " +
         counted(static_cast<std::size_t>(missed.frames), "frame") + ", at most by " + format_number(100.0 * missed.largest, 2) +
         " % in frame " + std::to_string(missed.worst_frame) + " (column stretch_excess in diagnostics.csv). " +
         remedy_for_stretch(simulator, missed);
}

std::optional<std::string> thin_bodies_warning(const Simulator& simulator, const FrameMemory& memory) {
  if (memory.truncated_frames < kManyFrames * memory.frames) return std::nullopt;
  const SimulatorSettings& settings = simulator.settings();
  const double least = kFallsWithinGap * settings.gravity.norm() * settings.step * settings.step;
  const double gap = thinnest_gap(simulator.network().bodies, simulator.obstacles());
  if (gap >= least) return std::nullopt;
  // No step is small enough for a gap of 0. A given step has no inner substeps.
  const double enough = std::min(settings.step * std::sqrt(gap / least), settings.longest_substep());
  const auto step = gap > 0.0 ? step_to_type(settings.frame_rate, enough) : std::nullopt;
  return "thickness " + format_number(gap, 3) +
         " m is too small for the step: resting bodies fall through it in a few steps. Contact stopped more than " +
         format_number(100.0 * kManyParticles) + " % of the particles in " +
         counted(static_cast<std::size_t>(memory.truncated_frames), "frame") +
         ", which is slow and overstretches them. Use a thickness of at least " + format_lower_bound(least, 2) + " m" +
         (step ? ", or a step of at most " + format_number(*step) + " s." : ".");
}

}  // namespace sprung
