#include "app/run_watch.h"

#include "app/console.h"
#include "base/files/binary_archive.h"
#include "base/format.h"
#include "base/grouped_warnings.h"
#include "simulation/monitoring/self_crossings.h"
#include "simulation/simulator.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace sprung {

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
template <Same<FrameMemory::Missed> S, class Visit>
void visit_members(S& m, const Visit& visit) {
  visit(m.frames, m.largest, m.worst_frame, m.pins);
}
template <Same<RunWatchMemory> S, class Visit>
void visit_members(S& m, const Visit& visit) {
  visit(m.infeasible, m.inverted, m.frames.missed, m.energy, m.frames.frames, m.frames.truncated_frames, m.handed_over,
        m.last_break);
}

RunWatch::RunWatch(const Simulator& simulator, RunOutput& output, bool quiet)
    : simulator_(simulator),
      output_(output),
      quiet_(quiet),
      energy_(simulator.network(), simulator.settings(), simulator.obstacles()) {}

void RunWatch::note_frame(const FrameDiagnostics& frame) {
  note_infeasible(frame);
  note_inverted(frame);
  note_handovers();
  note_broken(frame);
  sprung::note_frame(simulator_, frame, memory_.frames);
  energy_.note_frame(frame.frame,
                     {.kinetic = frame.kinetic_energy,
                      .elastic = frame.elastic_energy,
                      .gravity = frame.gravity_energy,
                      .contact = frame.contact_energy},
                     memory_.energy);
}

void RunWatch::finish() {
  if (const auto thin = thin_bodies_warning(simulator_, memory_.frames)) warn(*thin);
  if (const auto gain = energy_.gain(simulator_.positions(), memory_.energy)) warn(*gain);
  if (const auto missed = missed_limit_warning(simulator_, memory_.frames)) warn(*missed);
  warn_of_self_crossings();
}

std::string RunWatch::memory() const { return to_bytes(memory_); }

void RunWatch::restore(const std::string& memory) { from_bytes(memory, memory_); }

void RunWatch::warn(const std::string& warning) {
  output_.add_warning(warning);
  print_warning(warning);
}

void RunWatch::note_infeasible(const FrameDiagnostics& frame) {
  if (memory_.infeasible) return;
  const auto warning = infeasible_warning(frame);
  memory_.infeasible = warning.has_value();
  if (warning) warn(*warning);
}

void RunWatch::note_inverted(const FrameDiagnostics& frame) {
  if (memory_.inverted) return;
  const auto warning = inverted_warning(simulator_, frame);
  memory_.inverted = warning.has_value();
  if (warning) warn(*warning);
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

}  // namespace sprung
