#include "app/command_line.h"

#include "output/exporters/exporter.h"
#include "scene/json/nearest_name.h"
#include "simulation/step/frame_steps.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <string_view>
#include <thread>

namespace sprung {
namespace {

constexpr int kMaxThreads = 1'024;
constexpr double kMostSeconds = 1e9;

constexpr const char* kExamples = R"(Examples:
  sprung run examples/rope_over_torus.json --out frames
  sprung run scene.json --out frames --overwrite --frames 30 --set 'bodies.banner.shape.resolution=[128,128]'
  sprung run scene.json --out frames --resume
  sprung validate scene.json --mesh-path ~/meshes
  sprung info bunny.obj
  sprung view examples/hanging_cloth.json
  sprung view frames
  sprung view --lesson 3_damping
  sprung export frames --format html
  sprung export frames --format gltf,npz --out elsewhere
  sprung plot frames others --out compared.svg
  sprung sweep scene.json --vary bodies.rope.mass=0.1,0.2 --sample 'bodies.rope.springs.structural.damping=uniform(0,0.1)' --count 20 --out swept
  sprung sweep --status swept
  sprung materials cotton

Meshes are searched beside the scene file (by info: where you are), in each --mesh-path, then in the folders of SPRUNG_MESH_PATH.

Exit codes: 0 done, 2 wrong usage, 3 invalid scene or mesh, 4 the simulation diverged or runs of a sweep failed, 5 the scene file or a run
cannot be read or the output cannot be written, 130 interrupted, 1 anything else.)";

/// The options of all commands, and the parser that fills them.
class Parser {
 public:
  Parser() {
    app_.footer(kExamples);
    app_.set_version_flag("--version", "sprung " SPRUNG_VERSION);
    app_.require_subcommand(1);
    add_run();
    add_validate();
    add_info();
    add_view();
    add_export();
    add_plot();
    add_sweep();
    add_materials();
    add_help();
  }

  [[nodiscard]] Command parse(int argc, const char* const* argv) {
    const std::string help_of_all = app_.help();  // once a command is parsed, this is the command's
    if (argc < 2) return PrintOptions{.text = help_of_all, .is_usage_error = true};
    try {
      app_.parse(argc, argv);
    } catch (const CLI::CallForVersion& version) {
      return PrintOptions{std::string(version.what()) + "\n"};
    } catch (const CLI::CallForHelp&) {
      return PrintOptions{app_.help()};
    } catch (const CLI::ParseError& error) {
      throw UsageError(explain(error));
    }
    check_formats(run_.formats);
    check_formats(export_.formats);
    check_formats(sweep_.formats);
    if (app_.got_subcommand("run")) return run_;
    if (app_.got_subcommand("validate")) return validate_;
    if (app_.got_subcommand("view")) {
      if (view_.scene.file.empty() == view_.lesson.empty()) {
        throw UsageError("give a scene file, the folder of a run, or --lesson NAME alone; see sprung view --help");
      }
      return view_;
    }
    if (app_.got_subcommand("export")) {
      if (export_.formats.empty()) {
        throw UsageError(fmt::format("--format is required: choose from {}; see sprung export --help", joined(export_formats())));
      }
      return export_;
    }
    if (app_.got_subcommand("plot")) return plot_;
    if (app_.got_subcommand("sweep")) {
      check_sweep();
      return sweep_;
    }
    if (app_.got_subcommand("materials")) return materials_;
    if (app_.got_subcommand("help")) return help_of_.empty() ? PrintOptions{help_of_all} : help_of_command();
    return info_;
  }

 private:
  void add_run() {
    CLI::App* run = app_.add_subcommand("run", "Simulates a scene and writes its frames, as OBJ sequences or other formats");
    add_scene(run, run_.scene);
    run->add_option("--out", run_.out, "Folder for the frames; must be empty or not exist, unless the run is resumed")
        ->required()
        ->type_name("DIR");
    run->add_option("--format", run_.formats,
                    "obj: OBJ sequences, the default; none: record.bin and diagnostics alone; or any of those of export, as "
                    "obj,npz. With --resume: those of the run")
        ->delimiter(',')
        ->check(CLI::IsMember(run_formats()))
        ->type_name("FORMAT,...");
    run->add_option("--frames", run_.frames, "Number of frames, instead of the scene's duration")
        ->check(CLI::Range(1, kMostFrames))
        ->type_name("N");
    run->add_option("--threads", run_.threads, "Maximum number of threads; results do not depend on it")
        ->check(CLI::Range(1, kMaxThreads))
        ->type_name("N");
    run->add_flag("--quiet", run_.quiet, "Print errors only");
    auto* overwrite =
        run->add_flag("--overwrite", run_.overwrite, "Remove the files of an earlier run from the folder, and nothing else");
    run->add_flag("--resume", run_.resume, "Go on with the run in the folder from its last checkpoint, or begin it")
        ->excludes(overwrite);
    run->add_option("--checkpoint", run_.checkpoint, "Seconds between two checkpoints, 60 by default; 0: none")
        ->check(is_interval)
        ->type_name("SECONDS");
  }

  void add_validate() {
    CLI::App* validate = app_.add_subcommand("validate", "Checks a scene: prints every problem, or a summary of the scene");
    add_scene(validate, validate_.scene);
    validate->add_option("--threads", validate_.threads, "Maximum number of threads while the cost of a frame is measured")
        ->check(CLI::Range(1, kMaxThreads))
        ->type_name("N");
  }

  void add_info() {
    CLI::App* info = app_.add_subcommand("info", "Describes a mesh: size, closed or open, repairs by the import; or tetrahedra");
    info->add_option("MESH", info_.meshes,
                     "File of a mesh or of tetrahedra; several meshes are checked as the frames of a sequence")
        ->required()
        ->type_name("");
    add_mesh_path(info, info_.mesh_paths);
  }

  void add_view() {
    CLI::App* view = app_.add_subcommand("view", "Shows a scene live in the browser, or replays a run");
    view->add_option("SCENE|DIR", view_.scene.file, "Scene file, or the folder of a run")->type_name("");
    view->add_option("--lesson", view_.lesson, "Shows one of the lessons instead, such as 3_damping; any other name lists them")
        ->type_name("NAME");
    view->add_option("--save-to", view_.save_to, "Folder that the page may save runs into; by default that of the scene")
        ->check(CLI::ExistingDirectory)
        ->type_name("DIR");
    add_scene_options(view, view_.scene);
    view->add_option("--port", view_.port, "Port to listen on; 0, the default, takes a free one")
        ->check(CLI::Range(0, 65535))
        ->type_name("N");
    view->add_option("--token", view_.token, "Secret in the address: letters, digits, - and _; random by default")
        ->check(is_token)
        ->type_name("T");
    view->add_option("--threads", view_.threads, "Maximum number of threads; results do not depend on it")
        ->check(CLI::Range(1, kMaxThreads))
        ->type_name("N");
    view->add_flag_callback(
        "--no-open", [this] { view_.open = false; }, "Print the address, but open no browser");
  }

  void add_export() {
    CLI::App* command = app_.add_subcommand("export", "Writes a run in another file format");
    command->add_option("DIR", export_.folder, "Folder of a run")->required()->type_name("");
    command
        ->add_option("--format", export_.formats,
                     "Required. html: one file that plays in a browser; obj, ply, vtk: a file for each body and frame; pc2, mdd: a "
                     "point cache for each body; gltf, npz (float32), npz64, usda: one file")
        ->delimiter(',')
        ->check(CLI::IsMember(export_formats()))
        ->type_name("FORMAT,...");
    command->add_option("--out", export_.out, "Folder to write into, of html alone the file; by default the folder of the run")
        ->type_name("PATH");
    command->add_option("--mesh-path", unused_mesh_paths_)->group("");  // hidden: an export needed meshes once
    command->add_flag("--overwrite", export_.overwrite, "Replace files that exist");
  }

  void add_plot() {
    CLI::App* command = app_.add_subcommand("plot", "Draws energies, stretch, contacts and time a frame of runs");
    command->add_option("DIR", plot_.folders, "Folders of runs; several are drawn over each other")->required()->type_name("");
    command->add_option("--out", plot_.out, "Picture to write, .png or .svg; diagnostics.png in the first folder by default")
        ->type_name("FILE");
    command->add_flag("--overwrite", plot_.overwrite, "Replace the file if it exists");
  }

  void add_sweep() {
    CLI::App* sweep = app_.add_subcommand("sweep", "Runs a scene once for each combination of values, as processes or on Slurm");
    sweep
        ->add_option("SCENE", sweep_.scene.file,
                     "Scene file; -: from standard input, kept as scene.json in the folder of the sweep")
        ->type_name("");
    const auto add_list = [&](const char* name, std::vector<std::string>& list, const char* text, const char* type) {
      sweep->add_option(name, list, text)->allow_extra_args(false)->type_name(type);
    };
    add_list("--vary", sweep_.request.vary, "Values of a key, as of --set; all combinations are run; may be repeated",
             "KEY=V1,V2,...");
    add_list("--sample", sweep_.request.sample,
             "Random values of a key: uniform(a,b), log_uniform(a,b), integer(a,b), normal(mean,deviation); may be repeated",
             "KEY=uniform(a,b)");
    sweep->add_option("--count", sweep_.request.count, "Number of samples, each with every combination")
        ->check(CLI::Range(1, kMostRuns))
        ->type_name("N");
    sweep->add_option("--seed", sweep_.request.seed, "Seed of the samples, 0 by default")->check(is_seed)->type_name("S");
    sweep->add_option("--out", sweep_.out, "Folder of the sweep; the same command goes on with what is there")->type_name("DIR");
    add_scene_options(sweep, sweep_.scene);
    sweep
        ->add_option("--format", sweep_.formats,
                     "Frames of each run, as of run; none, the default: diagnostics.csv and run.json alone")
        ->delimiter(',')
        ->check(CLI::IsMember(run_formats()))
        ->type_name("FORMAT,...");
    sweep->add_option("--frames", sweep_.frames, "Number of frames, instead of the scene's duration")
        ->check(CLI::Range(1, kMostFrames))
        ->type_name("N");
    sweep->add_option("--checkpoint", sweep_.checkpoint, "Seconds between two checkpoints of a run, 60 by default; 0: none")
        ->check(is_interval)
        ->type_name("SECONDS");
    sweep
        ->add_option("--jobs", sweep_.jobs,
                     "Runs at the same time, by default one for each core; on Slurm: of a task, 1 by default")
        ->check(CLI::Range(1, kMaxThreads))
        ->type_name("N");
    sweep->add_flag("--retry-failed", sweep_.retry_failed, "Run those again that failed");
    sweep->add_option("--engine", sweep_.engine, "local, the default: processes; slurm: an array job")
        ->check(CLI::IsMember(std::vector<std::string>{"local", "slurm"}))
        ->type_name("ENGINE");
    sweep->add_option("--array-size", sweep_.array_size, "Tasks of the array job, which share the runs; needed with --engine slurm")
        ->check(CLI::Range(1, kMostRuns))
        ->type_name("N");
    const auto add_slurm = [&](const char* name, std::string& value, const char* text) {
      sweep->add_option(name, value, text)->check(is_slurm_word)->type_name("TEXT");
    };
    add_slurm("--account", sweep_.slurm.account, "Account of the array job");
    add_slurm("--partition", sweep_.slurm.partition, "Partition of the array job");
    add_slurm("--time", sweep_.slurm.time, "Time limit of a task of the array job, as 2:00:00");
    sweep->add_flag("--dry-run", sweep_.dry_run, "Print the script of the array job, or the commands of the runs; write nothing");
    sweep->add_flag("--quiet", sweep_.quiet, "Print errors only");
    sweep->add_option("--status", sweep_.status, "Print what is done of the sweep in a folder, and the time left")
        ->type_name("DIR");
    sweep->add_option("--task", sweep_.task)->check(CLI::Range(0, kMostRuns))->group("");  // hidden: for the script of an array job
  }

  /// Throws UsageError.
  void check_sweep() {
    std::string problems;
    const auto refuse_without = [&](const std::string& value, const char* text) {
      if (value.empty()) problems += fmt::format("{} is missing; see sprung sweep --help\n", text);
    };
    if (!sweep_.status.empty()) {
      if (!sweep_.scene.file.empty() || !sweep_.out.empty()) {
        problems = "--status DIR goes with no scene and no --out; leave them out";
      }
    } else {
      refuse_without(sweep_.out, "--out DIR");
      if (!sweep_.task) refuse_without(sweep_.scene.file, "the scene file");
      const bool on_slurm = sweep_.engine == "slurm";
      if (!sweep_.task && on_slurm && !sweep_.array_size) {
        problems += "--engine slurm needs the number of tasks that share the runs; give --array-size N\n";
      }
      const SlurmOptions& slurm = sweep_.slurm;
      if (!on_slurm && (sweep_.array_size || !(slurm.account + slurm.partition + slurm.time).empty())) {
        problems += "--array-size, --account, --partition and --time are of array jobs; add --engine slurm, or leave them out\n";
      }
    }
    const bool has_none = std::ranges::find(sweep_.formats, "none") != sweep_.formats.end();
    if (has_none && sweep_.formats.size() > 1) problems += "--format none goes with no other format; leave it out\n";
    if (!problems.empty()) throw UsageError(problems);
  }

  void add_materials() {
    CLI::App* command = app_.add_subcommand("materials", "Lists the materials of bodies, or the values of one and their sources");
    command->add_option("NAME", materials_.name, "Name of a material; or cloth, rope or solid: all of this kind; all by default")
        ->type_name("");
  }

  void add_help() {
    CLI::App* command = app_.add_subcommand("help", "Prints this help, or that of a command");
    command->add_option("COMMAND", help_of_, "Command; all by default")->type_name("");
  }

  [[nodiscard]] PrintOptions help_of_command() const {
    for (const CLI::App* command : app_.get_subcommands({})) {
      if (command->get_name() == help_of_) return PrintOptions{command->help(app_.get_name())};
    }
    throw UsageError(unexpected(help_of_, app_) + "see sprung --help");
  }

  static void check_formats(const std::vector<std::string>& formats) {
    const auto has = [&](const char* name) { return std::ranges::find(formats, name) != formats.end(); };
    if (has("npz") && has("npz64"))
      throw UsageError("--format npz and npz64 write the same file; leave out one; see sprung --help");
  }

  static std::vector<std::string> export_formats() {
    std::vector<std::string> formats{"html"};
    formats.insert(formats.end(), exporter_formats().begin(), exporter_formats().end());
    return formats;
  }

  static std::vector<std::string> run_formats() {
    std::vector<std::string> formats = export_formats();
    formats.emplace_back("none");
    return formats;
  }

  static std::string is_seed(const std::string& text) {
    const bool good = !text.empty() && std::ranges::all_of(text, [](unsigned char letter) { return std::isdigit(letter) != 0; });
    return good ? "" : "must be a whole number from 0";
  }

  static std::string is_interval(const std::string& text) {
    char* end = nullptr;
    const double seconds = std::strtod(text.c_str(), &end);
    const bool good = !text.empty() && *end == '\0' && seconds >= 0.0 && seconds <= kMostSeconds;
    return good ? "" : "must be a number of seconds from 0 to 1e9";
  }

  static std::string is_token(const std::string& token) {
    const bool good = !token.empty() && std::ranges::all_of(token, [](unsigned char letter) {
      return std::isalnum(letter) != 0 || letter == '-' || letter == '_';
    });
    return good ? "" : "must be letters, digits, - and _";
  }

  static std::string is_slurm_word(const std::string& text) {
    const bool good = !text.empty() && std::ranges::all_of(text, [](unsigned char letter) {
      return std::isalnum(letter) != 0 || std::string_view("-_.:,").find(static_cast<char>(letter)) != std::string_view::npos;
    });
    return good ? "" : "must be letters, digits, and - _ . : ,";
  }

  static void add_scene(CLI::App* command, SceneSource& scene) {
    command->add_option("SCENE", scene.file, "Scene file")->required()->type_name("");
    add_scene_options(command, scene);
  }

  static void add_scene_options(CLI::App* command, SceneSource& scene) {
    command->add_option("--set", scene.overrides, "Replaces a value of the scene; may be repeated")
        ->allow_extra_args(false)
        ->type_name("KEY=VALUE");
    add_mesh_path(command, scene.mesh_paths);
  }

  static void add_mesh_path(CLI::App* command, std::vector<std::string>& mesh_paths) {
    command->add_option("--mesh-path", mesh_paths, "Folder to search for meshes; may be repeated")
        ->allow_extra_args(false)
        ->type_name("DIR");
  }

  [[nodiscard]] std::string explain(const CLI::ParseError& error) const {
    const std::vector<CLI::App*> chosen = app_.get_subcommands();
    const CLI::App& command = chosen.empty() ? app_ : *chosen.front();
    std::string help = "see sprung ";
    if (!chosen.empty()) help += command.get_name() + " ";
    help += "--help";
    std::string text;
    for (const std::string& word : app_.remaining(true)) text += unexpected(word, command) + help + "\n";
    return text.empty() ? std::string(error.what()) + "; " + help : text;
  }

  [[nodiscard]] static std::string unexpected(const std::string& word, const CLI::App& command) {
    const auto name = nearest_name(word, known_names(command));
    return fmt::format("unexpected argument {}; {}", word, name ? fmt::format("did you mean {}? ", *name) : "");
  }

  [[nodiscard]] static std::vector<std::string> known_names(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::App* subcommand : command.get_subcommands({})) names.push_back(subcommand->get_name());
    for (const CLI::Option* option : command.get_options()) {
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
    return names;
  }

  CLI::App app_{"Simulates spring-damper networks that collide with meshes, and writes animations.", "sprung"};
  RunOptions run_;
  ValidateOptions validate_;
  InfoOptions info_;
  ViewOptions view_;
  ExportOptions export_;
  PlotOptions plot_;
  SweepOptions sweep_;
  std::vector<std::string> unused_mesh_paths_;
  MaterialsOptions materials_;
  std::string help_of_;
};

}  // namespace

int thread_count(const std::optional<int>& given) {
  return given.value_or(std::max(1, static_cast<int>(std::thread::hardware_concurrency())));
}

Command parse_command_line(int argc, const char* const* argv) { return Parser().parse(argc, argv); }

}  // namespace sprung
