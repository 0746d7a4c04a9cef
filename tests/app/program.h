// Runs the program as users do, and returns its exit code and its texts.
#pragma once

#include "base/scratch_folder.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace sprung::testing {

struct Ending {
  int code = -1;    ///< exit code; -1 when a signal ended it
  int signal = 0;   ///< that ended the program
  std::string out;  ///< standard output
  std::string err;  ///< standard error
};

/// A running program. Its outputs go to files, so that it never waits for a reader.
class Program {
 public:
  struct Limits {
    std::optional<rlim_t> file_size{};                               ///< no file may grow beyond it [bytes]
    std::optional<std::string> input{};                              ///< file that standard input comes from
    std::optional<std::string> output{};                             ///< standard output goes here
    std::optional<int> error_descriptor{};                           ///< standard error goes here
    std::string mesh_path{};                                         ///< SPRUNG_MESH_PATH
    std::vector<std::pair<std::string, std::string>> environment{};  ///< more variables
  };

  explicit Program(const std::vector<std::string>& arguments) : Program(arguments, Limits{}) {}
  Program(const std::vector<std::string>& arguments, const Limits& limits) {
    write_text(files_ / "out", "");
    write_text(files_ / "err", "");
    child_ = ::fork();
    if (child_ == 0) become(arguments, limits);
  }
  ~Program() {
    if (child_ > 0) {
      ::kill(child_, SIGKILL);
      ::waitpid(child_, nullptr, 0);
    }
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  /// Standard output and standard error so far.
  [[nodiscard]] std::string out() const { return read_text(files_ / "out"); }
  [[nodiscard]] std::string err() const { return read_text(files_ / "err"); }

  void send(int signal) const { ::kill(child_, signal); }

  Ending wait() {
    int status = 0;
    ::waitpid(child_, &status, 0);
    child_ = -1;
    Ending ending;
    if (WIFEXITED(status)) ending.code = WEXITSTATUS(status);
    if (WIFSIGNALED(status)) ending.signal = WTERMSIG(status);
    ending.out = out();
    ending.err = err();
    return ending;
  }

 private:
  static void redirect(const std::string& file, int descriptor) {
    const int opened = ::open(file.c_str(), O_WRONLY | O_CREAT, 0600);
    ::dup2(opened, descriptor);
  }

  [[noreturn]] void become(const std::vector<std::string>& arguments, const Limits& limits) const {
    if (limits.input) ::dup2(::open(limits.input->c_str(), O_RDONLY), STDIN_FILENO);
    redirect(limits.output.value_or((files_ / "out").string()), STDOUT_FILENO);
    if (limits.error_descriptor) {
      ::dup2(*limits.error_descriptor, STDERR_FILENO);
    } else {
      redirect((files_ / "err").string(), STDERR_FILENO);
    }
    ::setenv("SPRUNG_MESH_PATH", limits.mesh_path.c_str(), 1);
    for (const auto& [name, value] : limits.environment) ::setenv(name.c_str(), value.c_str(), 1);
    if (limits.file_size) {
      const rlimit limit{*limits.file_size, *limits.file_size};
      ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    std::vector<char*> words{const_cast<char*>(SPRUNG_PROGRAM)};
    for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
    words.push_back(nullptr);
    ::execv(SPRUNG_PROGRAM, words.data());
    ::_exit(127);
  }

  ScratchFolder files_;
  pid_t child_ = -1;
};

}  // namespace sprung::testing
