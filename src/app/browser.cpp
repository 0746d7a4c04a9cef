#include "app/browser.h"

#include "app/console.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <sstream>
#include <utility>

namespace sprung {
namespace {

constexpr const char* kOpener = "xdg-open";

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

/// The path of a program of the PATH; empty if there is none.
std::string find_program(const char* name) {
  std::istringstream folders(environment("PATH"));
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::string file = (folder.empty() ? "." : folder) + "/" + name;
    if (::access(file.c_str(), X_OK) == 0) return file;
  }
  return "";
}

/// Runs in the child; discards its output. Between fork and exec of a program with threads, only calls that are safe in a signal
/// handler are allowed.
[[noreturn]] void execute(const char* program, char* const* arguments) {
  const int null_device = ::open("/dev/null", O_RDWR);
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(null_device, descriptor);
  ::close_range(STDERR_FILENO + 1, ~0U, 0);  // a browser that outlives the server must not hold its port
  ::setpgid(0, 0);                           // Ctrl-C ends the server, not the browser
  ::execv(program, arguments);
  ::_exit(127);
}

}  // namespace

Browser::Browser(std::string address) : address_(std::move(address)) {
  const bool can_open = std::ranges::any_of(std::array{"DISPLAY", "WAYLAND_DISPLAY", "BROWSER"},
                                            [](const char* name) { return !environment(name).empty(); });
  std::string program = find_program(kOpener);
  if (program.empty()) {
    explain("no browser was opened: xdg-open is not installed");
  } else if (!can_open) {
    explain("no browser was opened: there is no screen, as DISPLAY is not set");
  } else {
    start(program);
  }
}

void Browser::start(std::string& program) {
  char* const arguments[] = {program.data(), address_.data(), nullptr};
  child_ = ::fork();
  if (child_ == 0) execute(program.c_str(), arguments);
  if (child_ < 0) explain("no browser was opened: xdg-open cannot be started");
}

void Browser::check() {
  int status = 0;
  if (child_ < 0 || ::waitpid(child_, &status, WNOHANG) != child_) return;
  child_ = -1;
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  explain("xdg-open failed" + (WIFEXITED(status) ? fmt::format(" (exit code {})", WEXITSTATUS(status)) : ""));
}

void Browser::explain(const std::string& cause) const {
  const std::size_t port_begin = address_.rfind(':') + 1;
  const std::string port = address_.substr(port_begin, address_.find('/', port_begin) - port_begin);
  print_message(cause + ". Open the address above in a browser of this machine.");
  print_message(
      fmt::format("To open it on another machine, run ssh -L {}:127.0.0.1:{} HOST there first; HOST is this machine.", port, port));
}

}  // namespace sprung
