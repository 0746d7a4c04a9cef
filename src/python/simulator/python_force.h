// A force that a Python function computes.
#pragma once

#include "dynamics/forces/force.h"
#include "network/model/body.h"

#include <pybind11/pybind11.h>

#include <optional>
#include <string>
#include <vector>

namespace sprung::python {

/// Calls `function(x, v, t)` with copies of positions [m] and velocities [m/s], (n, 3), and the time [s]. Adds the forces [N] that
/// it returns, (n, 3). Of one body alone, or of all particles. An exception of the function ends the step.
class PythonForce final : public Force {
 public:
  /// `body`: its first particle and their number.
  struct Range {
    Index first = 0;
    Index count = 0;
  };
  PythonForce(pybind11::function function, Range range, bool is_everywhere);
  ~PythonForce() override;

  [[nodiscard]] std::string name() const override { return name_; }
  [[nodiscard]] std::optional<std::vector<Index>> touched() const override;
  void add(const Kinematics& at, Points& forces) const override;

 private:
  pybind11::object function_;
  Range range_;
  bool is_everywhere_;
  std::string name_;
};

}  // namespace sprung::python
