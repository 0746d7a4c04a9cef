// The command line: parses, calls, and turns errors into exit codes.
#include "app/command_line.h"
#include "app/commands.h"
#include "app/console.h"
#include "app/interrupt.h"

namespace sprung {
namespace {

ExitCode print(const PrintOptions& options) {
  if (options.is_usage_error) {
    print_to_standard_error(options.text);
    return ExitCode::usage;
  }
  print_result(options.text);
  return ExitCode::done;
}

struct Execute {
  ExitCode operator()(const RunOptions& options) const { return run(options); }
  ExitCode operator()(const ValidateOptions& options) const { return validate(options); }
  ExitCode operator()(const InfoOptions& options) const { return info(options); }
  ExitCode operator()(const ViewOptions& options) const { return view(options); }
  ExitCode operator()(const ExportOptions& options) const { return export_run(options); }
  ExitCode operator()(const PlotOptions& options) const { return plot(options); }
  ExitCode operator()(const SweepOptions& options) const { return sweep(options); }
  ExitCode operator()(const MaterialsOptions& options) const { return print_materials(options); }
  ExitCode operator()(const PrintOptions& options) const { return print(options); }
};

ExitCode execute(int argc, const char* const* argv) noexcept try {
  return std::visit(Execute{}, parse_command_line(argc, argv));
} catch (...) {
  return report_failure();
}

}  // namespace
}  // namespace sprung

int main(int argc, char** argv) {
  sprung::catch_signals();
  return static_cast<int>(sprung::execute(argc, argv));
}
