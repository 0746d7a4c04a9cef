// The verbs of the command line.
#pragma once

#include "app/command_line.h"
#include "app/exit_code.h"

namespace sprung {

/// Simulates a scene and writes it. Throws InputError, StepError, FileError.
ExitCode run(const RunOptions& options);

/// Prints what follows from a scene. Throws InputError with every problem, FileError.
ExitCode validate(const ValidateOptions& options);

/// Prints what a mesh is. Throws InputError.
ExitCode info(const InfoOptions& options);

}  // namespace sprung
