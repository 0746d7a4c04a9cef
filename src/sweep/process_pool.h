// Runs processes side by side, so that a crash loses one of them.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace sprung {

/// How a process ended.
struct ProcessEnd {
  int exit_code = -1;    ///< -1 if a signal ended it
  int signal = 0;        ///< that ended it
  double seconds = 0.0;  ///< wall time
  std::string errors{};  ///< its standard error
};

/// What a pool asks and tells. `number` is that of a process, as given to ProcessPool::run.
struct PoolCalls {
  std::function<std::vector<std::string>(int number)> command;  ///< path of the program and its arguments
  std::function<std::filesystem::path(int number)> folder;      ///< that the process locks while it writes
  std::function<void(int number)> started;
  std::function<bool(int number, const ProcessEnd& end)> ended;  ///< whether to start it again when its folder is free
  std::function<void()> tick;                                    ///< after each event, and each second
  std::function<bool()> stop;  ///< no more processes are started; those that run are asked to end by SIGTERM
};

/// A process gets SIGTERM when this one dies, however that happens. It is in a process group of its own, so that Ctrl-C in a
/// terminal reaches this process alone, which passes it on once.
class ProcessPool {
 public:
  /// At most `jobs` processes at a time.
  ProcessPool(int jobs, PoolCalls calls);
  /// Asks those that run to end, and waits for them.
  ~ProcessPool();
  ProcessPool(const ProcessPool&) = delete;
  ProcessPool& operator=(const ProcessPool&) = delete;

  /// Starts each process when there is room and its folder is not locked: a process of a killed pool that still ends is waited for.
  /// Returns when all have ended. Throws FileError if the system starts none, and what the calls throw.
  void run(const std::vector<int>& numbers);

 private:
  using Clock = std::chrono::steady_clock;
  struct Process {
    int number = 0;
    pid_t id = -1;
    int handle = -1;  ///< pidfd, readable when the process has ended
    int errors = -1;  ///< file without a name
    Clock::time_point start{};
  };

  void start(int number);
  void start_what_fits(const std::vector<int>& numbers);
  void retry_locked();
  void wait();
  void reap(std::size_t place);
  void end_all();

  int jobs_;
  PoolCalls calls_;
  std::vector<Process> processes_{};
  std::size_t next_ = 0;       ///< of the numbers
  std::vector<int> ready_{};   ///< their folders are free again
  std::vector<int> locked_{};  ///< wait for the process of a killed pool
  bool asked_to_end_ = false;
};

}  // namespace sprung
