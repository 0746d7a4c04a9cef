// The commands of the program.
#pragma once

#include "app/command_line.h"
#include "app/exit_code.h"

#include <filesystem>
#include <string>

namespace sprung {

/// Simulates a scene and writes its frames. Throws InputError, StepError, FileError.
ExitCode run(const RunOptions& options);

/// Prints a summary of a scene. Throws InputError with every problem, and FileError.
ExitCode validate(const ValidateOptions& options);

/// Prints a description of a mesh. Throws InputError.
ExitCode info(const InfoOptions& options);

/// Shows a scene or a run in the browser until SIGINT or SIGTERM. Throws InputError if the port is not free or the folder is no
/// run, and in a program that was built without the viewer; FileError if the scene cannot be read.
ExitCode view(const ViewOptions& options);

/// Writes what a run wrote in other formats. Throws InputError if the folder is no run, or as view(); FileError if a file cannot be
/// written.
ExitCode export_run(const ExportOptions& options);

/// Draws the diagnostics of runs by gnuplot. Throws UsageError for an unknown kind of picture, InputError if a folder is no run,
/// FileError without gnuplot, or if the picture cannot be written.
ExitCode plot(const PlotOptions& options);

/// Runs a scene for many values, or prints what is done of it. Throws InputError if values or the folder do not fit, FileError if
/// files cannot be written or Slurm cannot be asked. ExitCode::diverged if runs failed.
ExitCode sweep(const SweepOptions& options);

/// Writes a run as one HTML file. Throws InputError if the folder is no run, and in a program that was built without the viewer;
/// FileError if the file cannot be written.
void export_html(const std::string& folder, const std::filesystem::path& file);

/// Prints the materials of bodies, or the values of one with their sources. Throws UsageError for an unknown name.
ExitCode print_materials(const MaterialsOptions& options);

}  // namespace sprung
