// What the program says. Messages go to standard error and never fail; what was asked for goes to standard output.
#pragma once

#include "app/exit_code.h"

#include <string>

namespace sprung {

/// Prints to standard output. Throws FileError when it cannot be written.
void print_result(const std::string& text);

/// Prints `sprung: ` and a line.
void print_message(const std::string& line);

/// Prints each line of `text` behind `sprung: warning: `.
void print_warning(const std::string& text);

/// Prints each line of `text` behind `sprung: error: `.
void print_error(const std::string& text);

/// Reports the exception that is being handled, and tells how to end. Call it in a catch block.
[[nodiscard]] ExitCode report_failure() noexcept;

}  // namespace sprung
