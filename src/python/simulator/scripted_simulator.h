// A simulator that a Python program steps: with arrays that the program writes, signals, and the scene that it comes from.
#pragma once

#include "dynamics/forces/force.h"
#include "python/simulator/frame_warnings.h"
#include "python/simulator/scene_origin.h"
#include "simulation/diagnostics.h"
#include "simulation/simulator.h"

#include <pybind11/pybind11.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sprung::python {

/// All members need the interpreter's lock, which those that make steps give back meanwhile. While a thread uses the simulator, all
/// others, and the forces that it calls, are refused.
class ScriptedSimulator : public std::enable_shared_from_this<ScriptedSimulator> {
 public:
  ScriptedSimulator(Simulator simulator, std::shared_ptr<const SceneOrigin> origin);
  ScriptedSimulator(const ScriptedSimulator&) = delete;

  /// To read, with what the program wrote: checks it first. Throws InputError if it is refused; the arrays then hold the state
  /// again.
  [[nodiscard]] const Simulator& read();

  /// To read what the program cannot write.
  [[nodiscard]] const Simulator& peek() const;

  /// Makes a change, with what the program wrote before.
  template <class Change>
  auto change(const Change& change) {
    const Use use(*this);
    adopt();
    const Publish publish(*this);
    return change(own());
  }

  // Both warn at their end.
  void step(std::int64_t steps);
  FrameDiagnostics frame();

  /// Tells what the steps of a batch found, by Python's `warnings`.
  void warn();

  /// The steps of a batch: without the interpreter's lock. `stopped` ends them before the next substep, with StoppedError.
  void begin_batch();
  void run_batch(std::int64_t steps, const std::atomic<bool>& stopped);
  void end_batch();

  /// Shares the simulator until one of both changes it, who then makes a copy.
  [[nodiscard]] std::shared_ptr<ScriptedSimulator> copy();

  /// All particles' positions [m] and velocities [m/s] that the program may write, 3 x n. Their addresses never change.
  [[nodiscard]] Points& positions();
  [[nodiscard]] Points& velocities();

  /// A force that a program added, its callable, and the body that it acts on; empty: all.
  struct Added {
    std::shared_ptr<Force> force;
    pybind11::object function;
    std::string body;
  };
  [[nodiscard]] std::vector<Added>& added_forces() { return added_; }

  [[nodiscard]] const std::shared_ptr<const SceneOrigin>& origin() const { return origin_; }

  /// What changed since the scene was loaded and a checkpoint lacks: the present values as JSON texts, by names.
  [[nodiscard]] std::map<std::string, std::string>& changes() { return changes_; }

  /// Called after each call that stepped, with the interpreter's lock.
  void on_step(std::function<void(const Simulator&)> show) { show_ = std::move(show); }

 private:
  /// A thread that uses the simulator.
  class Use {
   public:
    explicit Use(ScriptedSimulator& simulator);
    ~Use() { simulator_.in_use_ = false; }
    Use(const Use&) = delete;

   private:
    ScriptedSimulator& simulator_;
  };
  /// Copies the state into the arrays at the end of its lifetime.
  class Publish {
   public:
    explicit Publish(ScriptedSimulator& simulator) : simulator_(simulator) {}
    ~Publish() { simulator_.publish(); }
    Publish(const Publish&) = delete;

   private:
    ScriptedSimulator& simulator_;
  };

  ScriptedSimulator(std::shared_ptr<Simulator> simulator, std::shared_ptr<const SceneOrigin> origin);

  [[nodiscard]] Simulator& own();
  void adopt();
  void publish();
  [[nodiscard]] bool is_interrupted();
  template <class Steps>
  void run_steps(const Steps& steps);

  std::shared_ptr<Simulator> simulator_;  ///< only own() may change it
  bool is_owned_ = false;                 ///< by this one alone, and it asks this one whether to stop
  std::shared_ptr<const SceneOrigin> origin_;
  std::vector<Added> added_;
  std::map<std::string, std::string> changes_;
  std::function<void(const Simulator&)> show_;
  FrameWarnings warnings_;
  bool is_shared_ = false;  ///< whether the program has an array
  Points x_{3, 0};
  Points v_{3, 0};
  std::atomic<bool> in_use_ = false;
  const std::atomic<bool>* batch_stopped_ = nullptr;
  std::int64_t asked_ = 0;   ///< for signals [ms]
  std::int64_t looked_ = 0;  ///< at the clock [ms]
  int until_clock_ = 0;      ///< calls
  std::optional<pybind11::error_already_set> signal_;
};

using Shared = std::shared_ptr<ScriptedSimulator>;

}  // namespace sprung::python
