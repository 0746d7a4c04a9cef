#include "app/run_watch.h"

#include "app/console.h"
#include "base/files/binary_archive.h"
#include "base/format.h"
#include "base/grouped_warnings.h"
#include "dynamics/stretch_limit/stretch_limit.h"
#include "network/model/activity.h"
#include "simulation/monitoring/self_crossings.h"
#include "simulation/simulator.h"
#include "simulation/step/frame_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace sprung {

namespace {

// Many particles and many frames: these fractions of all.
constexpr double kManyParticles = 0.05;
constexpr double kManyFrames = 0.1;

// A resting particle falls by g dt^2 in a step before contact lifts it. Layers whose gap is less than so many times that use it up
// in a few steps; from then on truncation stops them at their surfaces.
constexpr double kFallsWithinGap = 16.0;

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

}  // namespace

template <Same<FrameEnergy> S, class Visit>
void visit_members(S& e, const Visit& visit) {
  visit(e.frame, e.energy);
}
template <Same<EnergyGainMemory> S, class Visit>
void visit_members(S& e, const Visit& visit) {
  visit(e.max_kinetic, e.lowest, e.rise_begin, e.rise_end);
}
template <Same<PinStretch> S, class Visit>
void visit_members(S& p, const Visit& visit) {
  visit(p.first, p.second, p.length, p.stretch);
}
template <Same<RunWatchMemory::Missed> S, class Visit>
void visit_members(S& m, const Visit& visit) {
  visit(m.frames, m.largest, m.worst_frame, m.pins);
}
template <Same<RunWatchMemory> S, class Visit>
void visit_members(S& m, const Visit& visit) {
  visit(m.infeasible, m.inverted, m.missed, m.energy, m.frames, m.truncated_frames, m.handed_over, m.last_break);
}

RunWatch::RunWatch(const Simulator& simulator, RunOutput& output, bool quiet)
    : simulator_(simulator),
      output_(output),
      quiet_(quiet),
      energy_(simulator.network(), simulator.settings(), simulator.obstacles()) {}

void RunWatch::note_frame(const FrameDiagnostics& frame) {
  note_infeasible(frame);
  note_inverted(frame);
  note_stretch(frame);
  note_handovers();
  note_broken(frame);
  note_truncated(frame);
  energy_.note_frame(frame.frame,
                     {.kinetic = frame.kinetic_energy,
                      .elastic = frame.elastic_energy,
                      .gravity = frame.gravity_energy,
                      .contact = frame.contact_energy},
                     memory_.energy);
}

void RunWatch::finish() {
  warn_of_thin_bodies();
  if (const auto gain = energy_.gain(simulator_.positions(), memory_.energy)) warn(*gain);
  warn_of_missed_limit();
  warn_of_self_crossings();
}

std::string RunWatch::memory() const { return to_bytes(memory_); }

void RunWatch::restore(const std::string& memory) { from_bytes(memory, memory_); }

void RunWatch::warn(const std::string& warning) {
  output_.add_warning(warning);
  print_warning(warning);
}

void RunWatch::note_infeasible(const FrameDiagnostics& frame) {
  if (memory_.infeasible || frame.infeasible == 0) return;
  memory_.infeasible = true;
  warn(
      fmt::format("frame {}: {} had no admissible position and may intersect (column infeasible in diagnostics.csv). Increase the "
                  "clearance, move pins out of obstacles, or slow the obstacles and pins that close on them.",
                  frame.frame, frame.max_infeasible == 1 ? "1 vertex" : fmt::format("{} vertices", frame.max_infeasible)));
}

void RunWatch::note_inverted(const FrameDiagnostics& frame) {
  if (memory_.inverted || frame.inverted_cells == 0) return;
  memory_.inverted = true;
  const bool preserved =
      std::ranges::all_of(simulator_.network().bodies, [](const Body& body) { return body.preserve_volume || body.cells.empty(); });
  warn(fmt::format(
      "frame {}: {} inside out (column inverted_cells in diagnostics.csv). Use {}.", frame.frame,
      frame.inverted_cells == 1 ? "1 cell is" : fmt::format("{} cells are", frame.inverted_cells),
      preserved ? "a smaller step, or more stiffness" : "\"volume\": { \"preserve\": true } for the solid, or more stiffness"));
}

void RunWatch::note_stretch(const FrameDiagnostics& frame) {
  const auto& limit = simulator_.settings().stretch_limit;
  if (!limit || frame.stretch_excess <= tolerated_excess(*limit, simulator_.settings().inner_substeps > 1)) return;
  ++memory_.missed.frames;
  if (frame.stretch_excess <= memory_.missed.largest) return;
  memory_.missed.largest = frame.stretch_excess;
  memory_.missed.worst_frame = frame.frame;
  memory_.missed.pins = largest_pin_stretch(find_tethers(simulator_.network(), limit->kinds), simulator_.positions());
}

void RunWatch::note_handovers() {
  const std::vector<StretchHandover>& handovers = simulator_.state().limit.handovers;
  memory_.handed_over.resize(handovers.size(), 0);
  std::map<std::int64_t, std::vector<std::string>> bodies;  // by step
  std::vector<std::string> back;
  for (std::size_t b = 0; b < handovers.size(); ++b) {
    const std::optional<std::int64_t>& since = handovers[b].solved_since;
    const std::string& name = simulator_.network().bodies[b].name;
    if (!quiet_ && since && memory_.handed_over[b] == 0) bodies[*since].push_back(name);
    if (!quiet_ && !since && memory_.handed_over[b] != 0) back.push_back(name);
    memory_.handed_over[b] = since ? 1 : 0;
  }
  for (const auto& [step, names] : bodies) {
    print_message(fmt::format("gauss_seidel kept missing the stretch limit of {}; newton solves it after step {}",
                              names_text("body", "bodies", names), step));
  }
  if (back.empty()) return;
  print_message(
      fmt::format("newton keeps the stretch limit of {} no better; gauss_seidel continues", names_text("body", "bodies", back)));
}

// What breaks is asked for, so it is no warning.
void RunWatch::note_broken(const FrameDiagnostics& frame) {
  std::map<std::string, std::size_t> counts;  // of links that broke since the frame before, by attachment
  std::int64_t last = memory_.last_break;
  for (const BrokenLink& link : simulator_.broken_links()) {
    if (link.step <= memory_.last_break) continue;
    ++counts[link.attachment];
    last = std::max(last, link.step);
  }
  memory_.last_break = last;
  if (quiet_) return;
  for (const auto& [name, count] : counts)
    print_message(fmt::format("frame {}: {} broke ({})", frame.frame, name, counted(count, "link")));
}

void RunWatch::note_truncated(const FrameDiagnostics& frame) {
  ++memory_.frames;
  // Inner substeps share one truncation.
  const double contact_steps = static_cast<double>(frame.substeps) / simulator_.settings().inner_substeps;
  const double particles = contact_steps * static_cast<double>(simulator_.network().particle_count());
  // Obstacles that close on a body stop many particles at any thickness; such frames have infeasible vertices.
  if (frame.infeasible == 0 && static_cast<double>(frame.truncated) > kManyParticles * particles) ++memory_.truncated_frames;
}

void RunWatch::warn_of_missed_limit() {
  if (memory_.missed.frames == 0) return;
  const StretchLimitSettings& limit = *simulator_.settings().stretch_limit;
  warn(
      fmt::format("the stretch limit was missed by more than {} % of a rest length in {}, at most by {} % in frame {} (column "
                  "stretch_excess in diagnostics.csv). {}",
                  format_number(100.0 * tolerated_excess(limit, simulator_.settings().inner_substeps > 1), 2),
                  counted(memory_.missed.frames, "frame"), format_number(100.0 * memory_.missed.largest, 2),
                  memory_.missed.worst_frame, remedy_for_stretch()));
}

std::string RunWatch::remedy_for_stretch() const {
  const StretchLimitSettings& limit = *simulator_.settings().stretch_limit;
  if (const PinStretch& pins = memory_.missed.pins; pins.stretch > limit.max_stretch) {
    const double allowed = (1.0 + limit.max_stretch) * pins.length;
    return fmt::format(
        "Two pins of body \"{}\" are {} m apart in that frame, but the springs between them are {} m long and may be {} m, so no "
        "solver can keep the limit. Keep these pins at most {} m apart.",
        simulator_.network().body_of(pins.first).name, format_number((1.0 + pins.stretch) * pins.length, 3),
        format_number(pins.length, 3), format_number(allowed, 3), format_upper_bound(allowed, 3));
  }
  const bool is_gauss_seidel = limit.solver == StretchLimitSettings::Solver::gauss_seidel;
  const bool can_be_solved = is_gauss_seidel && limit.max_compression == 1.0;
  if (can_be_solved)
    return "Raise \"iterations\" of \"stretch_limit\", use a smaller \"step\" or, for ropes and cloths, \"solver\": \"auto\".";
  if (simulator_.stretch_solver() != "newton") return "Raise \"iterations\" of \"stretch_limit\", or use a smaller \"step\".";
  // The excess that Newton's method leaves is proportional to the step; more iterations do not help.
  const double times = std::ceil(memory_.missed.largest / wanted_excess(limit));
  return fmt::format("Use a step {} times smaller{}.", format_number(times, 2),
                     moves_anything(simulator_) ? ", or let pins and obstacles move more slowly" : "");
}

void RunWatch::warn_of_self_crossings() {
  const bool uses_projection = simulator_.settings().contact.response == ContactSettings::Response::projection;
  for (const SelfCrossing& crossing : find_self_crossings(simulator_.network(), simulator_.positions())) {
    const Body& body = simulator_.network().bodies[static_cast<std::size_t>(crossing.body)];
    warn(
        fmt::format("body \"{}\" crosses itself: {} intersect others of the same body in the last frame. Set its "
                    "\"self_contact\" to true{}{}.",
                    body.name, counted(static_cast<std::size_t>(crossing.elements), "element"),
                    body.material.thickness > 0.0 ? "" : " and give it a \"thickness\"",
                    uses_projection ? "" : ", with contact.response \"projection\""));
  }
}

void RunWatch::warn_of_thin_bodies() {
  if (memory_.truncated_frames < kManyFrames * memory_.frames) return;
  const SimulatorSettings& settings = simulator_.settings();
  const double least = kFallsWithinGap * settings.gravity.norm() * settings.step * settings.step;
  const double gap = thinnest_gap(simulator_.network().bodies, simulator_.obstacles());
  if (gap >= least) return;
  // No step is small enough for a gap of 0. A given step has no inner substeps.
  const double enough = std::min(settings.step * std::sqrt(gap / least), settings.longest_substep());
  const auto step = gap > 0.0 ? step_to_type(settings.frame_rate, enough) : std::nullopt;
  warn(fmt::format(
      "thickness {} m is too small for the step: resting bodies fall through it in a few steps. Contact stopped more than {} % of "
      "the particles in {}, which is slow and overstretches them. Use a thickness of at least {} m{}.",
      format_number(gap, 3), format_number(100.0 * kManyParticles), counted(memory_.truncated_frames, "frame"),
      format_lower_bound(least, 2), step ? fmt::format(", or a step of at most {} s", format_number(*step)) : ""));
}

}  // namespace sprung
