// Many simulators at once.
#pragma once

#include "python/simulator/scripted_simulator.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace sprung::python {

class Batch {
 public:
  /// Throws InputError if a simulator is there twice.
  explicit Batch(std::vector<std::shared_ptr<ScriptedSimulator>> simulators);

  [[nodiscard]] const std::vector<std::shared_ptr<ScriptedSimulator>>& simulators() const { return simulators_; }

  /// Makes `steps` steps of each, on all cores. A simulator whose step fails stays at its begin while the others go on; the error
  /// of the first of them is thrown.
  void step(std::int64_t steps);

  /// As many steps as each needs to the end of its frame.
  void frame();

 private:
  void run(const std::vector<std::int64_t>& steps);
  void step_all(const std::vector<std::int64_t>& steps);

  std::vector<std::shared_ptr<ScriptedSimulator>> simulators_;
};

}  // namespace sprung::python
