#include "app/commands.h"
#include "app/console.h"
#include "app/interrupt.h"
#include "app/run_folder.h"
#include "base/error.h"
#include "base/files/file_pattern.h"
#include "base/files/file_writer.h"
#include "base/format.h"
#include "output/output_folder.h"
#include "output/run_export.h"
#include "output/run_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

namespace sprung {
namespace {

namespace fs = std::filesystem;

const std::string kHtml = "html";

/// Throws UsageError if the folder of the export is named like one of its files.
void check_is_folder(const fs::path& out, const Exporter& exporter) {
  for (const std::string& pattern : exporter.patterns()) {
    if (fs::path(pattern).extension() != out.extension() || out.extension().empty()) continue;
    throw UsageError(
        fmt::format("--out {} must name a folder, into which the export writes {}", out.string(), fill_pattern(pattern, 1)));
  }
}

/// Throws FileError if a file that the export writes is there or belongs to the run.
void check_free(const fs::path& file, const ExportOptions& options) {
  std::error_code ignored;
  if (fs::exists(file, ignored) && !fs::is_regular_file(file, ignored)) {
    throw FileError("write", file.string(), "it is a folder, a pipe or a device; give another name by --out");
  }
  check_replaces_no_file_of_run(file, options.folder);
  if (!options.overwrite && fs::exists(file, ignored)) {
    throw FileError("write", file.string(), "it exists; replace it with --overwrite, or give another place by --out");
  }
}

/// Existing files of an export in a folder.
std::vector<fs::path> files_in(const fs::path& out, const std::string& pattern) {
  std::error_code error;
  if (!fs::is_directory(out, error)) return {};
  try {
    return matching_files(out, pattern);
  } catch (const fs::filesystem_error& failure) {
    throw FileError("read", out.string(), failure.code().message());
  }
}

void check_free(const fs::path& out, const Exporter& exporter, const ExportOptions& options) {
  for (const std::string& pattern : exporter.patterns()) {
    check_free(out / fill_pattern(pattern, 1), options);
    for (const fs::path& file : files_in(out, pattern)) check_free(file, options);
  }
}

/// Files of an export that ends early, which are removed.
class Unfinished {
 public:
  Unfinished() = default;
  ~Unfinished() {
    std::error_code ignored;
    for (const fs::path& file : files_) fs::remove(file, ignored);
  }
  Unfinished(const Unfinished&) = delete;
  Unfinished& operator=(const Unfinished&) = delete;

  void add(const fs::path& file) { files_.push_back(file); }
  void keep() { files_.clear(); }

 private:
  std::vector<fs::path> files_;
};

/// The user interrupts an export.
struct Interrupted {};

/// Files that formats share, as the OBJ file of frame 1 of pc2 and mdd, are written twice with the same bytes.
void export_with(const RecordedRun& run, Exporter& exporter, const fs::path& out, Unfinished& unfinished) {
  for (const std::string& loss : exporter.losses(!run.torn_faces().empty())) print_message(loss);
  // Those of an export that this one replaces: it may be longer, and after an interrupt none is left.
  for (const std::string& pattern : exporter.patterns()) {
    std::error_code ignored;
    for (const fs::path& file : files_in(out, pattern)) fs::remove(file, ignored);
  }
  export_frames(run, exporter, [&](const ExportedFile& file) {
    if (interrupted()) throw Interrupted{};
    write_file(out / file.path, content_of(file));
    unfinished.add(out / file.path);
  });
}

}  // namespace

ExitCode export_run(const ExportOptions& options) {
  check_exists(options.folder);
  const bool is_html_alone = options.formats.size() == 1 && options.formats.front() == kHtml;
  const fs::path out = options.out.empty() ? fs::path(options.folder) : fs::path(options.out);
  const fs::path html = is_html_alone && !options.out.empty() ? out : out / kAnimationFile;
  const bool wants_html = std::ranges::find(options.formats, kHtml) != options.formats.end();
  if (wants_html) check_free(html, options);
  if (is_html_alone) {
    export_html(options.folder, html);
    return ExitCode::done;
  }
  const RecordedRun run(options.folder);
  warn_of_missing(run);
  std::vector<std::unique_ptr<Exporter>> exporters;
  std::vector<std::string> patterns;
  for (const std::string& format : exporter_formats()) {
    if (std::ranges::find(options.formats, format) == options.formats.end()) continue;
    exporters.push_back(make_exporter(format, exported_run(run)));
    for (const std::string& pattern : exporters.back()->patterns()) patterns.push_back(pattern);
    check_is_folder(out, *exporters.back());
    check_free(out, *exporters.back(), options);
  }
  std::error_code ignored;
  std::optional<OutputFolder> locked;  // no run writes into it meanwhile
  if (fs::equivalent(out, options.folder, ignored)) {
    locked.emplace(OutputFolder::as_it_is(options.folder));
    add_files_to_run(options.folder, patterns);
  }
  Unfinished unfinished;
  try {
    for (const std::unique_ptr<Exporter>& exporter : exporters) export_with(run, *exporter, out, unfinished);
  } catch (const Interrupted&) {
    print_message("interrupted; the files of the export were removed");
    return ExitCode::interrupted;
  }
  unfinished.keep();
  if (wants_html) export_html(options.folder, html);
  print_message(fmt::format("{} of {} are in {}", counted(run.frames(), "frame"), run.title(), out.string()));
  return ExitCode::done;
}

}  // namespace sprung
