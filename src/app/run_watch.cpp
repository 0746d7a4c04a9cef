#include "app/run_watch.h"

#include "app/console.h"
#include "base/format.h"
#include "dynamics/stretch_limit/stretch_limit.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string_view>

namespace sprung {

namespace {

// Many particles: this part of all. Many frames: this part of them.
constexpr double kManyParticles = 0.05;
constexpr double kManyFrames = 0.1;

// What rests falls by g dt^2 in a step before contact lifts it again. Layers with a gap of less than so many times that use it up
// in a few steps, and are stopped at their surfaces from then on.
constexpr double kFallsWithinGap = 16.0;

/// The smallest gap that bodies keep to obstacles, to each other or to themselves [m]; infinite where none meet.
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

std::string_view remedy_for_stretch(const StretchLimitSettings& limit) {
  const bool could_be_solved = limit.solver == StretchLimitSettings::Solver::gauss_seidel && limit.max_compression == 1.0;
  return could_be_solved ? "more iterations, smaller steps, or, of ropes and cloths, \"solver\": \"auto\" hold it better"
                         : "more iterations or smaller steps hold it better";
}

}  // namespace

RunWatch::RunWatch(const Simulator& simulator, RunOutput& output, bool quiet)
    : simulator_(simulator), output_(output), quiet_(quiet), gain_(simulator) {}

void RunWatch::see(const FrameDiagnostics& frame) {
  see_infeasible(frame);
  see_stretch(frame);
  see_handovers();
  see_held_back(frame);
  gain_.see(frame);
}

void RunWatch::tell() {
  tell_of_thin_bodies();
  if (const auto gained = gain_.warning()) warn(*gained);
  if (missed_.frames == 0) return;
  warn(fmt::format(
      "the stretch limit was missed by more than {} % of a rest length in {}, by at most {} % in frame {}; "
      "the column stretch_excess of diagnostics.csv tells by how much in each; {}",
      format_number(100.0 * wanted_excess(*simulator_.settings().stretch_limit), 2), counted(missed_.frames, "frame"),
      format_number(100.0 * missed_.most, 2), missed_.worst_frame, remedy_for_stretch(*simulator_.settings().stretch_limit)));
}

void RunWatch::warn(const std::string& warning) {
  output_.add_warning(warning);
  print_warning(warning);
}

void RunWatch::see_infeasible(const FrameDiagnostics& frame) {
  if (infeasible_ || frame.infeasible == 0) return;
  infeasible_ = true;
  warn(fmt::format(
      "frame {}: particles found no free place between obstacles, pins and each other {} times and may cross them; the column "
      "infeasible of diagnostics.csv counts them; leave them more room, or let what closes in on them stop before or go slower",
      frame.frame, frame.infeasible));
}

void RunWatch::see_stretch(const FrameDiagnostics& frame) {
  const auto& limit = simulator_.settings().stretch_limit;
  if (!limit || frame.stretch_excess <= wanted_excess(*limit)) return;
  ++missed_.frames;
  if (frame.stretch_excess <= missed_.most) return;
  missed_.most = frame.stretch_excess;
  missed_.worst_frame = frame.frame;
}

void RunWatch::see_handovers() {
  const std::vector<StretchHandover>& holds = simulator_.state().stretch_holds;
  handed_over_.resize(holds.size(), false);
  for (std::size_t b = 0; b < holds.size(); ++b) {
    if (quiet_ || handed_over_[b] || !holds[b].solved_since) continue;
    handed_over_[b] = true;
    print_message(fmt::format("passes kept missing the stretch limit of \"{}\"; newton holds it after step {}",
                              simulator_.network().bodies[b].name, *holds[b].solved_since));
  }
}

void RunWatch::see_held_back(const FrameDiagnostics& frame) {
  ++frames_;
  const double particles = static_cast<double>(frame.substeps) * static_cast<double>(simulator_.network().particle_count());
  // What closes in on bodies holds them back too, whatever their thickness.
  if (frame.infeasible == 0 && static_cast<double>(frame.truncated) > kManyParticles * particles) ++held_back_;
}

void RunWatch::tell_of_thin_bodies() {
  if (held_back_ < kManyFrames * frames_) return;
  const SimulatorSettings& settings = simulator_.settings();
  const double least = kFallsWithinGap * settings.gravity.norm() * settings.step * settings.step;
  const double gap = thinnest_gap(simulator_.network().bodies, simulator_.environment().obstacles());
  if (gap >= least) return;
  warn(fmt::format(
      "some bodies keep a gap of {} m to what they meet, which they use up as they fall in a step: contact held back more than "
      "{} % of the particles in each step of {} frames, which takes long and lets them stretch; a thickness of at least {} m, or "
      "smaller steps, would help",
      format_number(gap, 3), format_number(100.0 * kManyParticles), held_back_, format_number(least, 2)));
}

}  // namespace sprung
