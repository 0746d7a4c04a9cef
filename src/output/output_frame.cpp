#include "output/output_frame.h"

#include "dynamics/state/simulation_state.h"
#include "output/diagnostics_csv.h"
#include "output/forces_csv.h"
#include "output/run_recorder.h"
#include "simulation/simulator.h"

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

namespace sprung {
namespace {

std::vector<NewtonFrom> handed_over(const Simulator& simulator) {
  std::vector<NewtonFrom> bodies;
  for (std::size_t b = 0; b < simulator.network().bodies.size(); ++b) {
    const StretchHandover& handover = simulator.state().limit.handovers[b];
    if (handover.solved_since) bodies.push_back({.body = simulator.network().bodies[b].name, .step = *handover.solved_since});
  }
  return bodies;
}

/// Adds the faces of bodies that are gone and not yet listed.
void list_torn(const Simulator& simulator, int frame, std::vector<TornFaces>& torn_faces) {
  if (simulator.state().springs.broken_count() == 0) return;
  for (const Body& body : simulator.network().bodies) {
    std::vector<Index> listed;
    for (const TornFaces& torn : torn_faces) {
      if (torn.body == body.name) listed.insert(listed.end(), torn.faces.begin(), torn.faces.end());
    }
    std::ranges::sort(listed);
    TornFaces now{.body = body.name, .frame = frame, .faces = {}};
    std::ranges::set_difference(body.surface.torn, listed, std::back_inserter(now.faces));
    if (!now.faces.empty()) torn_faces.push_back(std::move(now));
  }
}

std::vector<BrokenAttachment> broken_attachments(const Simulator& simulator) {
  std::vector<BrokenAttachment> all;
  for (const BrokenLink& link : simulator.broken_links()) {
    const Body& body = simulator.network().body_of(link.particle);
    all.push_back({.name = link.attachment, .body = body.name, .particle = link.particle - body.first_particle, .step = link.step});
  }
  return all;
}

/// The progress after one more frame.
RunProgress progress_after(const RunProgress& before, const Simulator& simulator, const FrameDiagnostics& diagnostics) {
  RunProgress next = before;
  ++next.frames_written;
  next.steps = simulator.state().step;
  next.substeps += diagnostics.substeps;
  if (diagnostics.substeps > 0) {
    next.smallest_step =
        before.substeps > 0 ? std::min(before.smallest_step, diagnostics.smallest_step) : diagnostics.smallest_step;
  }
  next.limit_solves += diagnostics.limit_solves;
  next.newton_from = handed_over(simulator);
  list_torn(simulator, next.frames_written, next.torn_faces);
  next.broken_attachments = broken_attachments(simulator);
  return next;
}

}  // namespace

OutputFrame output_frame(const Simulator& simulator, const FrameDiagnostics& diagnostics, const RunProgress& before,
                         bool with_state) {
  OutputFrame frame{
      .state = {}, .diagnostics = csv_row(diagnostics), .forces = {}, .progress = progress_after(before, simulator, diagnostics)};
  if (with_state) frame.state = RunRecorder::frame(simulator);
  if (simulator.settings().record_forces) {
    frame.forces = forces_csv_rows(diagnostics.frame, diagnostics.time, simulator.reactions());
  }
  return frame;
}

}  // namespace sprung
