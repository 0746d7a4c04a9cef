#include "python/simulator/scripted_simulator.h"

#include "python/simulator/errors.h"
#include "python/simulator/interpreter.h"
#include "simulation/step/step_report.h"

#include <cstring>
#include <ctime>
#include <utility>

namespace py = pybind11;

namespace sprung::python {
namespace {

// Often enough for a person who presses Ctrl-C; to ask takes the interpreter's lock.
constexpr std::int64_t kSignalInterval = 50;  // [ms]

// Short steps do not look at the clock each time.
constexpr int kCallsPerLook = 4;
constexpr std::int64_t kSlow = 20;  // [ms] between two looks

/// [ms], of a clock that takes a few nanoseconds to read and ticks every few milliseconds.
std::int64_t coarse_now() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC_COARSE, &now);
  return std::int64_t{1000} * now.tv_sec + now.tv_nsec / 1'000'000;
}

bool are_same_bits(const Points& a, const Points& b) {
  return std::memcmp(a.data(), b.data(), sizeof(double) * static_cast<std::size_t>(a.size())) == 0;
}

}  // namespace

ScriptedSimulator::Use::Use(ScriptedSimulator& simulator) : simulator_(simulator) {
  if (simulator.in_use_.exchange(true)) {
    throw std::runtime_error("the simulator is in use: by another thread, by a batch, or by the step that calls this function");
  }
}

ScriptedSimulator::ScriptedSimulator(Simulator simulator, std::shared_ptr<const SceneOrigin> origin)
    : ScriptedSimulator(std::make_shared<Simulator>(std::move(simulator)), std::move(origin)) {}

ScriptedSimulator::ScriptedSimulator(std::shared_ptr<Simulator> simulator, std::shared_ptr<const SceneOrigin> origin)
    : simulator_(std::move(simulator)), origin_(std::move(origin)) {}

/// To change it. Does not need the interpreter's lock: nobody changes a simulator that several own, and only the one that is in use
/// could give its own to another.
Simulator& ScriptedSimulator::own() {
  if (is_owned_) return *simulator_;
  if (simulator_.use_count() > 1) simulator_ = std::make_shared<Simulator>(*simulator_);
  std::atomic_thread_fence(std::memory_order_acquire);  // after what a former owner read, in another thread
  simulator_->stop_when([this] { return is_interrupted(); });
  is_owned_ = true;
  return *simulator_;
}

const Simulator& ScriptedSimulator::peek() const {
  if (in_use_) throw std::runtime_error("the simulator is in use by another thread, a batch or a step");
  return *simulator_;
}

const Simulator& ScriptedSimulator::read() {
  const Use use(*this);
  adopt();
  return *simulator_;
}

Points& ScriptedSimulator::positions() {
  if (!is_shared_) {
    x_ = simulator_->state().x;
    v_ = simulator_->state().v;
    is_shared_ = true;
  }
  return x_;
}

Points& ScriptedSimulator::velocities() {
  static_cast<void>(positions());
  return v_;
}

/// Takes over what the program wrote.
void ScriptedSimulator::adopt() {
  if (!is_shared_) return;
  const SimulationState& state = simulator_->state();
  if (are_same_bits(x_, state.x) && are_same_bits(v_, state.v)) return;
  const Publish publish(*this);  // also if it is refused
  own().set_motion(x_, v_);
}

void ScriptedSimulator::publish() {
  if (!is_shared_) return;
  const SimulationState& state = simulator_->state();
  std::memcpy(x_.data(), state.x.data(), sizeof(double) * static_cast<std::size_t>(x_.size()));
  std::memcpy(v_.data(), state.v.data(), sizeof(double) * static_cast<std::size_t>(v_.size()));
}

/// Whether Ctrl-C, or another signal whose handler raises, or the end of a batch stops the steps.
bool ScriptedSimulator::is_interrupted() {
  wait_if_ending();
  if (batch_stopped_ != nullptr) return *batch_stopped_;
  if (signal_) return true;
  if (--until_clock_ > 0) return false;
  const std::int64_t now = coarse_now();
  until_clock_ = now - looked_ < kSlow ? kCallsPerLook : 1;
  looked_ = now;
  if (now - asked_ < kSignalInterval) return false;
  asked_ = now;
  const WithLock lock;
  if (PyErr_CheckSignals() != 0) signal_.emplace();
  return signal_.has_value();
}

template <class Steps>
void ScriptedSimulator::run_steps(const Steps& steps) {
  const Use use(*this);
  adopt();
  const Publish publish(*this);
  signal_.reset();
  Simulator& simulator = own();
  try {
    const WithoutLock without_lock;
    steps(simulator);
  } catch (const StoppedError&) {
    if (!signal_) throw;
    throw py::error_already_set(*std::exchange(signal_, std::nullopt));
  }
}

void ScriptedSimulator::step(std::int64_t steps) {
  if (steps < 0) refuse("steps", std::to_string(steps), "must not be negative", "give the number of steps");
  run_steps([&](Simulator& simulator) {
    for (std::int64_t k = 0; k < steps; ++k) {
      if (k > 0 && is_interrupted()) throw StoppedError();
      warnings_.note_step(simulator, simulator.step());
    }
  });
  if (show_) show_(*simulator_);
  warn();
}

FrameDiagnostics ScriptedSimulator::frame() {
  FrameDiagnostics diagnostics;
  run_steps([&](Simulator& simulator) {
    diagnostics = FrameRunner(simulator).next_frame();
    warnings_.note_frame(simulator, diagnostics);
  });
  if (show_) show_(*simulator_);
  warn();
  return diagnostics;
}

void ScriptedSimulator::warn() {
  while (const auto text = warnings_.next()) python::warn(*text);
}

void ScriptedSimulator::begin_batch() {
  if (in_use_.exchange(true)) throw std::runtime_error("a simulator of the batch is in use");
  try {
    adopt();
  } catch (...) {
    in_use_ = false;
    throw;
  }
}

void ScriptedSimulator::run_batch(std::int64_t steps, const std::atomic<bool>& stopped) {
  batch_stopped_ = &stopped;
  Simulator& simulator = own();  // here, as a copy takes as long as many steps
  for (std::int64_t k = 0; k < steps; ++k) {
    if (stopped) throw StoppedError();
    warnings_.note_step(simulator, simulator.step());
  }
}

void ScriptedSimulator::end_batch() {
  batch_stopped_ = nullptr;
  publish();
  in_use_ = false;
  if (show_) show_(*simulator_);
}

std::shared_ptr<ScriptedSimulator> ScriptedSimulator::copy() {
  const Use use(*this);
  adopt();
  const std::shared_ptr<ScriptedSimulator> copied(new ScriptedSimulator(simulator_, origin_));
  is_owned_ = false;
  copied->added_ = added_;
  copied->changes_ = changes_;
  copied->warnings_ = warnings_;
  return copied;
}

}  // namespace sprung::python
