#include "python/simulator/interpreter.h"

#include <atomic>
#include <chrono>
#include <thread>

namespace py = pybind11;

namespace sprung::python {
namespace {

using namespace std::chrono_literals;

// A function of the program that hangs in a thread does not keep the process from its end.
constexpr auto kPatience = 1s;

std::atomic<bool> is_ending = false;
std::atomic<std::thread::id> ending_thread{};
std::atomic<int> takers = 0;  // threads that take the lock, or have it in a function that C++ called

/// Counts before it looks whether the program ends, while end() does it the other way round: one of both sees the other.
void enter() {
  ++takers;
  if (!is_ending) return;
  --takers;
  wait_if_ending();
  ++takers;
}

/// With the lock, before the interpreter ends: lets those through that wait for it.
void end() {
  ending_thread = std::this_thread::get_id();
  is_ending = true;
  const auto latest = std::chrono::steady_clock::now() + kPatience;
  while (takers > 0 && std::chrono::steady_clock::now() < latest) {
    const py::gil_scoped_release release;
    std::this_thread::sleep_for(1ms);
  }
}

}  // namespace

void register_end() { py::module_::import("atexit").attr("register")(py::cpp_function(&end)); }

void wait_if_ending() {
  while (is_ending.load(std::memory_order_relaxed) && ending_thread.load() != std::this_thread::get_id()) {
    std::this_thread::sleep_for(1s);
  }
}

WithLock::WithLock() : enters_(PyGILState_Check() == 0) {
  if (enters_) enter();
  lock_.emplace();
}
WithLock::~WithLock() {
  lock_.reset();
  if (enters_) --takers;
}

WithoutLock::~WithoutLock() {
  enter();
  PyEval_RestoreThread(thread_);
  --takers;
}

}  // namespace sprung::python
