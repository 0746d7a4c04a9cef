#include "sweep/process_pool.h"

#include "base/error.h"
#include "output/folder_lock.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <system_error>
#include <utility>

namespace sprung {
namespace {

constexpr int kInterrupted = 130;
constexpr int kNotStarted = 127;
constexpr int kTickMilliseconds = 1000;
constexpr int kLockMilliseconds = 50;  // between two looks at a lock

[[noreturn]] void fail_to_start(const std::string& program, int error) {
  throw FileError("start", program, std::generic_category().message(error));
}

/// Between fork() and exec, only calls that are safe in a signal handler.
[[noreturn]] void become(char* const* words, int errors, pid_t parent) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (::getppid() != parent) ::_exit(kInterrupted);  // it died before it was asked for
  const int nothing = ::open("/dev/null", O_RDWR);
  ::dup2(nothing, STDIN_FILENO);
  ::dup2(nothing, STDOUT_FILENO);
  ::dup2(errors, STDERR_FILENO);
  ::execv(words[0], words);
  ::_exit(kNotStarted);
}

std::string text_of(int file) {
  std::string text;
  std::array<char, 4096> part{};
  ssize_t size = 0;
  while ((size = ::pread(file, part.data(), part.size(), static_cast<off_t>(text.size()))) > 0) {
    text.append(part.data(), static_cast<std::size_t>(size));
  }
  return text;
}

}  // namespace

ProcessPool::ProcessPool(int jobs, PoolCalls calls) : jobs_(jobs), calls_(std::move(calls)) {}

ProcessPool::~ProcessPool() {
  end_all();
  for (const Process& process : processes_) {
    ::waitpid(process.id, nullptr, 0);
    ::close(process.handle);
    ::close(process.errors);
  }
}

void ProcessPool::run(const std::vector<int>& numbers) {
  next_ = 0;
  while (true) {
    const bool stops = calls_.stop();
    if (stops) {
      end_all();
      if (processes_.empty()) return;
    } else {
      start_what_fits(numbers);
      if (processes_.empty() && locked_.empty()) return;
    }
    wait();
    calls_.tick();
  }
}

void ProcessPool::start_what_fits(const std::vector<int>& numbers) {
  retry_locked();
  while (processes_.size() < static_cast<std::size_t>(jobs_)) {
    if (!ready_.empty()) {
      const int number = ready_.back();
      ready_.pop_back();
      start(number);
    } else if (next_ < numbers.size()) {
      const int number = numbers[next_++];
      if (is_locked(calls_.folder(number))) {
        locked_.push_back(number);
      } else {
        start(number);
      }
    } else {
      return;
    }
  }
}

void ProcessPool::retry_locked() {
  std::erase_if(locked_, [&](int number) {
    if (is_locked(calls_.folder(number))) return false;
    ready_.push_back(number);
    return true;
  });
}

void ProcessPool::start(int number) {
  std::vector<std::string> command = calls_.command(number);
  std::vector<char*> words;
  for (std::string& word : command) words.push_back(word.data());
  words.push_back(nullptr);
  Process process{.number = number, .start = Clock::now()};
  process.errors = ::memfd_create("errors", MFD_CLOEXEC);
  if (process.errors < 0) fail_to_start(command.front(), errno);
  const pid_t parent = ::getpid();
  process.id = ::fork();
  if (process.id == 0) become(words.data(), process.errors, parent);
  if (process.id < 0) {
    const int error = errno;
    ::close(process.errors);
    fail_to_start(command.front(), error);
  }
  process.handle = static_cast<int>(::syscall(SYS_pidfd_open, process.id, 0));
  const int error = errno;
  processes_.push_back(process);
  if (process.handle < 0) fail_to_start(command.front(), error);
  calls_.started(number);
}

/// Until a process has ended, a signal comes or time has passed.
void ProcessPool::wait() {
  std::vector<pollfd> handles;
  for (const Process& process : processes_) handles.push_back({.fd = process.handle, .events = POLLIN, .revents = 0});
  const int count = ::poll(handles.data(), handles.size(), locked_.empty() ? kTickMilliseconds : kLockMilliseconds);
  if (count <= 0) return;
  for (std::size_t place = handles.size(); place-- > 0;) {
    if (handles[place].revents != 0) reap(place);
  }
}

void ProcessPool::reap(std::size_t place) {
  const Process process = processes_[place];
  processes_.erase(processes_.begin() + static_cast<std::ptrdiff_t>(place));
  int status = 0;
  ::waitpid(process.id, &status, 0);
  ProcessEnd end{.seconds = std::chrono::duration<double>(Clock::now() - process.start).count(), .errors = text_of(process.errors)};
  if (WIFEXITED(status)) end.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) end.signal = WTERMSIG(status);
  ::close(process.handle);
  ::close(process.errors);
  if (calls_.ended(process.number, end)) locked_.push_back(process.number);
}

/// Once: a second SIGTERM would end a run before it has written its checkpoint.
void ProcessPool::end_all() {
  if (std::exchange(asked_to_end_, true)) return;
  for (const Process& process : processes_) ::kill(process.id, SIGTERM);
}

}  // namespace sprung
