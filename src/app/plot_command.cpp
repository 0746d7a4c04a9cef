#include "app/commands.h"
#include "app/console.h"
#include "app/run_folder.h"
#include "base/error.h"
#include "base/files/file_writer.h"
#include "base/format.h"
#include "output/output_folder.h"
#include "output/plot_script.h"
#include "output/run_summary.h"

#include <fmt/format.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>
#include <vector>

namespace sprung {
namespace {

namespace fs = std::filesystem;

constexpr int kNotFound = 127;  // of a shell that does not find the program

constexpr std::size_t kRandomLetters = 6;  // that mkdtemp() puts in the place of as many X

PlotFormat format_of(const fs::path& file) {
  if (file.extension() == ".png") return PlotFormat::png;
  if (file.extension() == ".svg") return PlotFormat::svg;
  throw UsageError(fmt::format("--out {}: must end in .png or .svg", file.string()));
}

/// Runs gnuplot on a script. Throws FileError with what it said.
void draw(const fs::path& script, const fs::path& picture) {
  const std::string command = "gnuplot '" + script.string() + "' 2>&1";
  std::FILE* output = ::popen(command.c_str(), "r");
  if (output == nullptr) throw FileError("write", picture.string(), "gnuplot cannot be started");
  std::string said;
  for (std::array<char, 256> part{}; std::fgets(part.data(), static_cast<int>(part.size()), output) != nullptr;)
    said += part.data();
  const int status = ::pclose(output);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  if (WIFEXITED(status) && WEXITSTATUS(status) == kNotFound) {
    throw FileError("write", picture.string(),
                    "gnuplot draws it and is not installed; install it, on Debian with apt install gnuplot-nox");
  }
  throw FileError("write", picture.string(), "gnuplot failed: " + said.substr(0, said.find('\n')));
}

/// A folder for the script, which vanishes with its content.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (fs::temp_directory_path() / ("sprung-plot-" + std::string(kRandomLetters, 'X'))).string();
    if (::mkdtemp(name.data()) == nullptr) throw FileError("write", name, "the folder for temporary files cannot be used");
    path_ = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

}  // namespace

ExitCode plot(const PlotOptions& options) {
  const fs::path picture = options.out.empty() ? fs::path(options.folders.front()) / "diagnostics.png" : fs::path(options.out);
  const PlotFormat format = format_of(picture);
  std::error_code ignored;
  if (!options.overwrite && fs::exists(picture, ignored)) {
    throw FileError("write", picture.string(), "it exists; replace it with --overwrite, or give another file by --out");
  }
  std::vector<PlottedRun> runs;
  for (const std::string& folder : options.folders) {
    check_exists(folder);
    check_replaces_no_file_of_run(picture, folder);
    const RecordedRun run(folder, RunParts::diagnostics);
    runs.push_back({.title = options.folders.size() == 1 ? run.title() : folder, .diagnostics = run.diagnostics()});
  }
  const ScratchFolder scratch;
  const fs::path drawn = scratch.path() / ("picture" + picture.extension().string());
  write_file(scratch.path() / "script", plot_script(runs, drawn.string(), format));
  draw(scratch.path() / "script", picture);
  std::ifstream stream(drawn, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (fs::equivalent(picture.parent_path().empty() ? "." : picture.parent_path(), options.folders.front(), ignored)) {
    const OutputFolder locked = OutputFolder::as_it_is(options.folders.front());  // no run writes into it meanwhile
    add_files_to_run(options.folders.front(), {picture.filename().string()});
  }
  write_file(picture, bytes);
  print_message(fmt::format("{} shows {}", picture.string(), counted(runs.size(), "run")));
  return ExitCode::done;
}

}  // namespace sprung
