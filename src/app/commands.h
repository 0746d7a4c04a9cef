// The commands of the program.
#pragma once

#include "app/command_line.h"
#include "app/exit_code.h"

namespace sprung {

/// Simulates a scene and writes its frames. Throws InputError, StepError, FileError.
ExitCode run(const RunOptions& options);

/// Prints a summary of a scene. Throws InputError with every problem, and FileError.
ExitCode validate(const ValidateOptions& options);

/// Prints a description of a mesh. Throws InputError.
ExitCode info(const InfoOptions& options);

}  // namespace sprung
