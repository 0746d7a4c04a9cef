// Console output. Messages go to standard error and never fail; results go to standard output.
#pragma once

#include "app/exit_code.h"

#include <string>

namespace sprung {

/// Prints to standard output. Throws FileError if it cannot be written.
void print_result(const std::string& text);

/// Prints a text as it is.
void print_to_standard_error(const std::string& text);

/// Prints `sprung: ` and a line.
void print_message(const std::string& line);

/// Prints each line of `text` with the prefix `sprung: warning: `.
void print_warning(const std::string& text);

/// Prints each line of `text` with the prefix `sprung: error: `.
void print_error(const std::string& text);

/// Prints the exception that is being handled and returns its exit code. Call it in a catch block.
[[nodiscard]] ExitCode report_failure() noexcept;

}  // namespace sprung
