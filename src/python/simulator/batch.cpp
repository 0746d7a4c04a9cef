#include "python/simulator/batch.h"

#include "base/parallel_tasks.h"
#include "python/simulator/errors.h"
#include "python/simulator/interpreter.h"
#include "simulation/step/step_report.h"

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <set>
#include <thread>
#include <utility>

namespace py = pybind11;

namespace sprung::python {
namespace {

constexpr std::chrono::milliseconds kSignalInterval{50};

/// The steps in threads of their own, so that the calling one, which alone runs handlers of signals, can ask for these.
class Run {
 public:
  explicit Run(const std::function<void(const std::atomic<bool>& stopped)>& steps)
      : thread_([this, steps] {
          try {
            steps(stopped_);
          } catch (...) {
            error_ = std::current_exception();
          }
          const std::lock_guard lock(mutex_);
          is_done_ = true;
          changed_.notify_all();
        }) {}
  ~Run() {
    stopped_ = true;
    thread_.join();
  }
  Run(const Run&) = delete;

  /// Returns whether the steps ended in this time.
  bool wait(std::chrono::milliseconds time) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, time, [this] { return is_done_; });
  }
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool is_done_ = false;
  std::atomic<bool> stopped_ = false;
  std::exception_ptr error_;
  std::thread thread_;  // last: it uses the others
};

void run_until_signal(const std::function<void(const std::atomic<bool>& stopped)>& steps) {
  std::optional<py::error_already_set> signal;
  {
    const WithoutLock without_lock;
    Run run(steps);
    while (!signal && !run.wait(kSignalInterval)) {
      const WithLock lock;
      if (PyErr_CheckSignals() != 0) signal.emplace();
    }
    if (!signal) run.rethrow();
  }
  if (signal) throw py::error_already_set(*signal);
}

}  // namespace

Batch::Batch(std::vector<std::shared_ptr<ScriptedSimulator>> simulators) : simulators_(std::move(simulators)) {
  std::set<const ScriptedSimulator*> known;
  for (std::size_t k = 0; k < simulators_.size(); ++k) {
    const std::string key = "simulators[" + std::to_string(k) + "]";
    if (!known.insert(simulators_[k].get()).second) refuse(key, "", "is there already", "give each once, or a copy() of it");
  }
}

void Batch::step(std::int64_t steps) {
  if (steps < 0) refuse("steps", std::to_string(steps), "must not be negative", "give the number of steps");
  run(std::vector<std::int64_t>(simulators_.size(), steps));
}

void Batch::frame() {
  std::vector<std::int64_t> steps;
  for (const auto& simulator : simulators_) {
    const SimulationState& state = simulator->peek().state();
    steps.push_back(state.steps_per_frame - state.step_in_frame);
  }
  run(steps);
}

void Batch::run(const std::vector<std::int64_t>& steps) {
  step_all(steps);
  for (const auto& simulator : simulators_) simulator->warn();
}

void Batch::step_all(const std::vector<std::int64_t>& steps) {
  struct Begun {
    std::vector<ScriptedSimulator*> simulators;
    ~Begun() {
      for (ScriptedSimulator* simulator : simulators) simulator->end_batch();
    }
  } begun;
  for (const auto& simulator : simulators_) {
    simulator->begin_batch();
    begun.simulators.push_back(simulator.get());
  }
  run_until_signal([&](const std::atomic<bool>& stopped) {
    parallel_tasks(static_cast<Index>(simulators_.size()), [&](Index k) {
      const auto number = static_cast<std::size_t>(k);
      simulators_[number]->run_batch(steps[number], stopped);
    });
  });
}

}  // namespace sprung::python
