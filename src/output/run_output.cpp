#include "output/run_output.h"

#include "base/error.h"
#include "dynamics/state/simulation_state.h"
#include "output/diagnostics_csv.h"
#include "output/file_pattern.h"
#include "output/forces_csv.h"
#include "output/record/record_encoding.h"
#include "output/record/record_format.h"
#include "simulation/simulator.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <utility>

namespace sprung {
namespace {

constexpr const char* kDiagnosticsFile = "diagnostics.csv";
constexpr const char* kForcesFile = "forces.csv";

std::string content_of(const MaterialFile& file) {
  if (file.text) return *file.text;
  errno = 0;
  std::ifstream stream(file.source, std::ios::binary);
  std::ostringstream bytes;
  if (stream.peek() != std::ifstream::traits_type::eof()) bytes << stream.rdbuf();
  if (!stream.is_open() || stream.bad()) throw FileError("copy", file.source.string(), std::strerror(errno));
  return std::move(bytes).str();
}

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

std::vector<ObjSequence> sequences_of(const Simulator& simulator, const RunFacts& facts) {
  check_output_names(simulator);
  return facts.write_obj ? obj_sequences(simulator, facts.sources, facts.frames) : std::vector<ObjSequence>();
}

std::optional<RunRecorder> recorder_of(const Simulator& simulator, const RunFacts& facts) {
  if (!facts.write_record) return std::nullopt;
  return RunRecorder(simulator, facts.sources, facts.materials);
}

}  // namespace

RunOutput::RunOutput(OutputFolder folder, const RunFacts& facts, const Simulator& simulator)
    : folder_(std::move(folder)),
      sequences_(sequences_of(simulator, facts)),
      copies_(facts.write_obj ? copied_files(facts.sources) : std::vector<CopiedFile>()),
      has_forces_(simulator.settings().record_forces),
      recorder_(recorder_of(simulator, facts)),
      summary_(facts, simulator.settings().step, patterns()) {
  folder_.expect_free(patterns());
  const std::string head = recorder_ ? encode_head(recorder_->model(), recorder_->frame(simulator)) : "";
  if (recorder_) summary_.set_record(fingerprint(head));
  try {
    write_summary();
    if (recorder_) folder_.write(kRecordFile, head);
    folder_.write(kDiagnosticsFile, csv_head());
    if (has_forces_) folder_.write(kForcesFile, forces_csv_head());
  } catch (...) {
    for (const char* file : {kForcesFile, kDiagnosticsFile, kRecordFile, kRunSummaryFile}) folder_.remove(file);
    throw;
  }
}

std::vector<std::string> RunOutput::patterns() const {
  std::vector<std::string> patterns{kRunSummaryFile, kDiagnosticsFile, kAnimationFile};
  if (recorder_) patterns.emplace_back(kRecordFile);
  if (has_forces_) patterns.emplace_back(kForcesFile);
  for (const ObjSequence& sequence : sequences_) patterns.push_back(sequence.pattern());
  for (const CopiedFile& copy : copies_) patterns.push_back(copy.path);
  return patterns;
}

void RunOutput::write_frame(const Simulator& simulator, const FrameDiagnostics& diagnostics) {
  const RunProgress before = progress_;
  std::vector<std::string> written;
  std::optional<std::uintmax_t> forces_before;  // size [bytes]
  std::optional<std::uintmax_t> record_before;
  ++progress_.frames_written;
  progress_.steps = simulator.state().step;
  progress_.substeps += diagnostics.substeps;
  if (diagnostics.substeps > 0) {
    progress_.smallest_step =
        before.substeps > 0 ? std::min(before.smallest_step, diagnostics.smallest_step) : diagnostics.smallest_step;
  }
  progress_.limit_solves += diagnostics.limit_solves;
  progress_.newton_from = handed_over(simulator);
  list_torn(simulator, progress_.frames_written, progress_.torn_faces);
  progress_.broken_attachments = broken_attachments(simulator);
  try {
    for (const ObjSequence& sequence : sequences_) {
      if (before.frames_written > 0 && !sequence.changes()) continue;
      const std::string file = fill_pattern(sequence.pattern(), progress_.frames_written);
      folder_.write(file, sequence.text(simulator));
      written.push_back(file);
    }
    if (before.frames_written == 0) {
      for (const CopiedFile& copy : copies_) {
        folder_.write(copy.path, content_of(copy.file));
        written.push_back(copy.path);
      }
    }
    // run.json never counts a frame that the record lacks, even if the program is killed.
    if (recorder_) record_before = folder_.append(kRecordFile, encode_frame(recorder_->frame(simulator)));
    write_summary();
    if (has_forces_) {
      forces_before = folder_.append(kForcesFile, forces_csv_rows(diagnostics.frame, diagnostics.time, simulator.reactions()));
    }
    folder_.append(kDiagnosticsFile, csv_row(diagnostics));
  } catch (...) {
    if (forces_before) folder_.shorten(kForcesFile, *forces_before);
    if (record_before) folder_.shorten(kRecordFile, *record_before);
    for (const std::string& file : written) folder_.remove(file);
    progress_ = before;
    throw;
  }
}

void RunOutput::finish(const std::string& outcome) {
  progress_.outcome = outcome;
  write_summary();
}

void RunOutput::write_summary() {
  progress_.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  folder_.write(kRunSummaryFile, summary_.text(progress_));
}

}  // namespace sprung
