#include "app/run_watch.h"

#include "app/console.h"
#include "base/format.h"

#include <fmt/format.h>

namespace sprung {

RunWatch::RunWatch(const Simulator& simulator, RunOutput& output, bool quiet)
    : simulator_(simulator), output_(output), quiet_(quiet) {}

void RunWatch::see(const FrameDiagnostics& frame) {
  see_squeezing(frame);
  see_stretch(frame);
  see_handovers();
}

void RunWatch::tell() {
  if (missed_.frames == 0) return;
  warn(fmt::format(
      "the stretch limit was missed by more than its tolerance in {} {}, by at most {} % of a rest length in frame {}; "
      "the column stretch_excess of diagnostics.csv tells by how much in each",
      missed_.frames, missed_.frames == 1 ? "frame" : "frames", format_number(100.0 * missed_.most, 2), missed_.worst_frame));
}

void RunWatch::warn(const std::string& warning) {
  output_.add_warning(warning);
  print_warning(warning);
}

void RunWatch::see_squeezing(const FrameDiagnostics& frame) {
  if (squeezed_ || frame.squeezed == 0) return;
  squeezed_ = true;
  warn(fmt::format(
      "frame {}: particles found no free place between obstacles, pins and each other {} times and may cross them; the column "
      "squeezed of diagnostics.csv counts them",
      frame.frame, frame.squeezed));
}

void RunWatch::see_stretch(const FrameDiagnostics& frame) {
  const auto& limit = simulator_.settings().stretch_limit;
  if (!limit || frame.stretch_excess <= limit->tolerance) return;
  ++missed_.frames;
  if (frame.stretch_excess <= missed_.most) return;
  missed_.most = frame.stretch_excess;
  missed_.worst_frame = frame.frame;
}

void RunWatch::see_handovers() {
  const std::vector<StretchHold>& holds = simulator_.state().stretch_holds;
  handed_over_.resize(holds.size(), false);
  for (std::size_t b = 0; b < holds.size(); ++b) {
    if (quiet_ || handed_over_[b] || !holds[b].solved_since) continue;
    handed_over_[b] = true;
    print_message(fmt::format("passes kept missing the stretch limit of \"{}\"; newton holds it after step {}",
                              simulator_.network().bodies[b].name, *holds[b].solved_since));
  }
}

}  // namespace sprung
