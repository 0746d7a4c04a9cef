#include "output/run_output.h"

#include "base/error.h"
#include "base/files/file_pattern.h"
#include "base/files/file_writer.h"
#include "output/diagnostics_csv.h"
#include "output/forces_csv.h"
#include "output/output_names.h"
#include "output/record/record_encoding.h"
#include "output/record/record_format.h"
#include "output/record/record_reader.h"
#include "output/run_export.h"
#include "simulation/simulator.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace sprung {
namespace {

constexpr const char* kForcesFile = "forces.csv";

// Each has a copy of all positions and velocities.
constexpr std::size_t kMostWaitingFrames = 2;

// The outcome of a run begins so if its files could not be written.
constexpr const char* kFailed = "failed";

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

std::optional<RunRecorder> recorder_of(const Simulator& simulator, const RunFacts& facts) {
  check_output_names(simulator);
  if (!facts.write_record && facts.formats.empty()) return std::nullopt;
  return RunRecorder(simulator, facts.sources, facts.materials);
}

std::vector<std::unique_ptr<Exporter>> exporters_of(const RunFacts& facts, const std::optional<RunRecorder>& recorder) {
  std::vector<std::unique_ptr<Exporter>> exporters;
  for (const std::string& format : facts.formats) {
    exporters.push_back(
        make_exporter(format, {.model = recorder->model(), .frame_rate = facts.frame_rate, .frames = facts.frames}));
  }
  return exporters;
}

}  // namespace

RunOutput::RunOutput(const RunFacts& facts, const Simulator& simulator, OutputFolder folder)
    : folder_(std::move(folder)),
      has_forces_(simulator.settings().record_forces),
      recorder_(recorder_of(simulator, facts)),
      has_record_(facts.write_record),
      formats_(facts.formats),
      exporters_(exporters_of(facts, recorder_)),
      summary_(facts, simulator.settings().step, patterns()),
      checkpoint_interval_(facts.checkpoint_interval),
      worker_(kMostWaitingFrames) {}

RunOutput::RunOutput(OutputFolder folder, const RunFacts& facts, const Simulator& simulator)
    : RunOutput(facts, simulator, std::move(folder)) {
  if (checkpoint_interval_ > 0.0) identity_ = identity_of(facts.scene, simulator);
  folder_.expect_free(patterns());
  const std::string head = has_record_ ? encode_head(recorder_->model(), RunRecorder::frame(simulator)) : "";
  if (has_record_) summary_.set_record(fingerprint(head));
  try {
    write_summary(progress_);
    if (has_record_) folder_.write(kRecordFile, head);
    folder_.write(kDiagnosticsFile, csv_head());
    if (has_forces_) folder_.write(kForcesFile, forces_csv_head());
  } catch (...) {
    for (const char* file : {kForcesFile, kDiagnosticsFile, kRecordFile, kRunSummaryFile}) folder_.remove(file);
    throw;
  }
}

RunOutput::RunOutput(OutputFolder folder, const RunFacts& facts, const Simulator& simulator, const Checkpoint& from,
                     std::string& monitor)
    : RunOutput(facts, simulator, std::move(folder)) {
  last_checkpoint_ = start_;
  RunCheckpoint run = run_checkpoint(from, folder_);
  const auto fail = [&](const std::string& reason) { throw FileError("resume the run", folder_.path().string(), reason); };
  if (run.files != patterns()) {
    fail(
        "its files would get other names; give the --format with which it began, and no more frames than the digits of their names "
        "count");
  }
  for (const auto& [file, size] : {std::pair(kRecordFile, run.record_size), std::pair(kDiagnosticsFile, run.diagnostics_size),
                                   std::pair(kForcesFile, run.forces_size)}) {
    if (folder_.size(file) >= size) continue;
    fail(std::string(file) +
         " is shorter than it was at the checkpoint, so frames are missing; run the scene again with --overwrite");
  }
  if (has_record_) summary_.set_record(RecordReader(folder_.path() / kRecordFile).fingerprint());
  summary_.set_exports(exports_of_run(folder_.path() / kRunSummaryFile));
  identity_ = std::move(run.identity);
  monitor = std::move(run.monitor);
  progress_ = run.progress;
  progress_.outcome = "running";
  written_ = progress_;
  seconds_before_ = progress_.wall_seconds;
  write_summary(progress_);
  take_back_frames(run);
}

/// Whoever stops it can resume again: it needs only what was written before the checkpoint.
void RunOutput::take_back_frames(const RunCheckpoint& to) {
  if (has_record_) folder_.cut(kRecordFile, to.record_size);
  folder_.cut(kDiagnosticsFile, to.diagnostics_size);
  if (has_forces_) folder_.cut(kForcesFile, to.forces_size);
  for (const std::string& pattern : patterns()) {
    if (pattern.find('#') == std::string::npos) continue;
    const std::filesystem::path last = folder_.path() / fill_pattern(pattern, progress_.frames_written);
    for (const std::filesystem::path& file : matching_files(folder_.path(), pattern)) {
      if (file > last) folder_.remove(file.lexically_relative(folder_.path()));
    }
  }
  for (const std::unique_ptr<Exporter>& exporter : exporters_) {  // of the run as it ended before
    if (exporter->writes_each_frame()) continue;
    for (const std::string& pattern : exporter->patterns()) folder_.remove(pattern);
  }
  for (const std::string& pattern : patterns()) {  // of a program that was killed
    for (const std::filesystem::path& file : matching_files(folder_.path(), temporary_path(pattern).string())) {
      folder_.remove(file.lexically_relative(folder_.path()));
    }
  }
}

std::vector<std::string> RunOutput::patterns() const {
  std::vector<std::string> patterns{kRunSummaryFile, kDiagnosticsFile, kAnimationFile, kCheckpointFile};
  if (has_record_) patterns.emplace_back(kRecordFile);
  if (has_forces_) patterns.emplace_back(kForcesFile);
  for (const std::unique_ptr<Exporter>& exporter : exporters_) {
    for (const std::string& pattern : exporter->patterns()) {
      if (std::ranges::find(patterns, pattern) == patterns.end()) patterns.push_back(pattern);
    }
  }
  return patterns;
}

void RunOutput::write_frame(const Simulator& simulator, const FrameDiagnostics& diagnostics) {
  write_frame(output_frame(simulator, diagnostics, progress_, recorder_.has_value()));
}

void RunOutput::write_frame(OutputFrame output) {
  output.progress.warnings = progress_.warnings;
  RunProgress next = output.progress;
  Frame frame{.exported = {.number = next.frames_written, .state = std::move(output.state)},
              .diagnostics = std::move(output.diagnostics),
              .forces = std::move(output.forces),
              .progress = std::move(output.progress)};
  if (recorder_) frame.exported.torn = torn_in(recorder_->model(), next.torn_faces, frame.exported.number);
  try {
    worker_.add([this, frame = std::move(frame)] { write(frame); });
  } catch (const FileError&) {  // of a frame before
    take_back_progress();
    throw;
  }
  progress_ = std::move(next);
}

void RunOutput::flush() {
  try {
    worker_.wait();
  } catch (const std::exception&) {
    take_back_progress();
    throw;
  }
}

/// To the last frame that is written. Requires that the worker has nothing to do.
void RunOutput::take_back_progress() {
  std::vector<std::string> warnings = std::move(progress_.warnings);
  progress_ = written_;
  progress_.warnings = std::move(warnings);
}

void RunOutput::write(const Frame& frame) {
  std::vector<std::string> files;
  std::optional<std::uintmax_t> forces_before;  // size [bytes]
  std::optional<std::uintmax_t> record_before;
  RunProgress progress = frame.progress;
  try {
    for (const std::unique_ptr<Exporter>& exporter : exporters_) {
      if (!exporter->writes_each_frame()) continue;
      for (const ExportedFile& file : exporter->frame(frame.exported)) {
        folder_.write(file.path, content_of(file));
        files.push_back(file.path);
      }
    }
    // run.json never counts a frame that the record lacks, even if the program is killed.
    if (has_record_) record_before = folder_.append(kRecordFile, encode_frame(frame.exported.state));
    write_summary(progress);
    if (has_forces_) forces_before = folder_.append(kForcesFile, frame.forces);
    folder_.append(kDiagnosticsFile, frame.diagnostics);
  } catch (...) {
    if (forces_before) folder_.shorten(kForcesFile, *forces_before);
    if (record_before) folder_.shorten(kRecordFile, *record_before);
    for (const std::string& file : files) folder_.remove(file);
    throw;
  }
  written_ = std::move(progress);
}

std::string RunOutput::write_due_checkpoint(const Simulator& simulator, const std::string& monitor) {
  if (last_checkpoint_ && seconds_since(*last_checkpoint_) < checkpoint_interval_) return "";
  return write_checkpoint_now(simulator, monitor);
}

std::string RunOutput::write_checkpoint_now(const Simulator& simulator, const std::string& monitor) {
  if (checkpoint_interval_ <= 0.0) return "";
  flush();
  last_checkpoint_ = std::chrono::steady_clock::now();
  try {
    RunCheckpoint run;
    run.identity = identity_;
    run.files = patterns();
    run.progress = progress_;
    run.monitor = monitor;
    if (has_record_) run.record_size = folder_.size(kRecordFile);
    run.diagnostics_size = folder_.size(kDiagnosticsFile);
    if (has_forces_) run.forces_size = folder_.size(kForcesFile);
    Checkpoint checkpoint = simulator.checkpoint();
    checkpoint.run = bytes_of(run);
    write_checkpoint(folder_.path() / kCheckpointFile, checkpoint);
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

void RunOutput::finish(const std::string& outcome) {
  flush();
  // Whoever kills the program here finds a run that has not ended, which --resume ends.
  if (progress_.frames_written > 0 && !outcome.starts_with(kFailed)) write_whole_files();
  progress_.outcome = outcome;
  write_summary(progress_);
}

/// Each gets a new exporter, which knows how many frames there are.
void RunOutput::write_whole_files() {
  const auto write = [this](const ExportedFile& file) { folder_.write(file.path, content_of(file)); };
  std::optional<RecordedRun> run;
  for (std::size_t k = 0; k < exporters_.size(); ++k) {
    if (exporters_[k]->writes_each_frame()) {
      std::ranges::for_each(exporters_[k]->end(progress_.frames_written), write);
      continue;
    }
    if (!run) run.emplace(folder_.path());
    export_frames(*run, *make_exporter(formats_[k], exported_run(*run)), write);
  }
}

std::vector<std::string> RunOutput::losses(bool tears) const {
  std::vector<std::string> all;
  for (const std::unique_ptr<Exporter>& exporter : exporters_) {
    const std::vector<std::string> losses = exporter->losses(tears);
    all.insert(all.end(), losses.begin(), losses.end());
  }
  return all;
}

void RunOutput::write_summary(RunProgress& progress) {
  progress.wall_seconds = seconds_before_ + seconds_since(start_);
  folder_.write(kRunSummaryFile, summary_.text(progress));
}

}  // namespace sprung
