// Parses the command line.
#pragma once

#include "scene/load_scene.h"
#include "sweep/slurm.h"
#include "sweep/sweep_plan.h"

#include <optional>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

namespace sprung {

struct RunOptions {
  SceneSource scene;
  std::string out;
  std::vector<std::string> formats;  ///< of the frames; none, alone: none; empty: obj, or those of the run that is resumed
  std::optional<int> frames;
  std::optional<int> threads;
  bool quiet = false;
  bool overwrite = false;
  bool resume = false;
  double checkpoint = 60.0;  ///< at most so often a checkpoint is written [s]; 0: never
};

struct ValidateOptions {
  SceneSource scene;
  std::optional<int> threads;  ///< of the steps that are measured
};

struct InfoOptions {
  std::vector<std::string> meshes;      ///< one, or the frames of a sequence
  std::vector<std::string> mesh_paths;  ///< folders
};

struct ViewOptions {
  SceneSource scene;    ///< its file may be the folder of a run; empty with a lesson
  std::string lesson;   ///< name of a lesson to open instead
  std::string save_to;  ///< folder that the page may save into; empty: that of the scene
  int port = 0;         ///< 0: any free one
  std::string token;    ///< empty: a random one
  std::optional<int> threads;
  bool open = true;  ///< in the browser
};

struct ExportOptions {
  std::string folder;  ///< of a run
  std::vector<std::string> formats;
  std::string out;  ///< html alone: a file; else a folder; empty: the folder of the run
  bool overwrite = false;
};

struct PlotOptions {
  std::vector<std::string> folders;  ///< of runs
  std::string out;                   ///< empty: diagnostics.png in the folder of the first run
  bool overwrite = false;
};

struct SweepOptions {
  SceneSource scene;
  SweepRequest request;
  std::string out;
  std::vector<std::string> formats{"none"};
  std::optional<int> frames;
  double checkpoint = 60.0;  ///< as of RunOptions
  std::string engine = "local";
  std::optional<int> jobs;        ///< processes at the same time; by default all cores, of a task of Slurm one
  std::optional<int> array_size;  ///< tasks of Slurm
  SlurmOptions slurm;
  bool dry_run = false;
  bool retry_failed = false;
  bool quiet = false;
  std::string status;       ///< folder of a sweep to describe; empty: run one
  std::optional<int> task;  ///< of an array job, of which this process does the runs
};

struct MaterialsOptions {
  std::string name;  ///< empty: all
};

/// The text of --help or --version, to print.
struct PrintOptions {
  std::string text;
  bool is_usage_error = false;  ///< there was no command: the text goes to standard error
};

using Command = std::variant<RunOptions, ValidateOptions, InfoOptions, ViewOptions, ExportOptions, PlotOptions, SweepOptions,
                             MaterialsOptions, PrintOptions>;

/// An invalid command line; one problem per line.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// As given, or one for each core.
[[nodiscard]] int thread_count(const std::optional<int>& given);

/// Throws UsageError.
[[nodiscard]] Command parse_command_line(int argc, const char* const* argv);

}  // namespace sprung
