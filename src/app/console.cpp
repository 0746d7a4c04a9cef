#include "app/console.h"

#include "app/command_line.h"
#include "base/error.h"

#include <cerrno>
#include <cstdio>
#include <new>
#include <sstream>
#include <system_error>

namespace sprung {
namespace {

void print_lines(const std::string& head, const std::string& text) {
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) std::fputs((head + line + '\n').c_str(), stderr);
}

ExitCode report(ExitCode code, const std::string& text) {
  print_error(text);
  return code;
}

}  // namespace

void print_result(const std::string& text) {
  if (std::fputs(text.c_str(), stdout) < 0 || std::fflush(stdout) != 0) {
    throw FileError("write", "standard output", std::generic_category().message(errno));
  }
}

void print_to_standard_error(const std::string& text) { std::fputs(text.c_str(), stderr); }

void print_message(const std::string& line) { print_lines("sprung: ", line); }

void print_warning(const std::string& text) { print_lines("sprung: warning: ", text); }

void print_error(const std::string& text) { print_lines("sprung: error: ", text); }

ExitCode report_failure() noexcept try { throw; } catch (const UsageError& error) {
  return report(ExitCode::usage, error.what());
} catch (const InputError& error) {
  return report(ExitCode::invalid, error.what());
} catch (const StepError& error) {
  return report(ExitCode::diverged, error.what());
} catch (const FileError& error) {
  return report(ExitCode::file, error.what());
} catch (const std::bad_alloc&) {
  std::fputs("sprung: error: not enough memory; lower the resolution of the bodies or use a smaller mesh\n", stderr);
  return ExitCode::unexpected;
} catch (const std::exception& error) {
  return report(ExitCode::unexpected, std::string("unexpected error: ") + error.what());
} catch (...) {
  std::fputs("sprung: error: unexpected error\n", stderr);
  return ExitCode::unexpected;
}

}  // namespace sprung
