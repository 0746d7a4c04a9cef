// Bodies, pins and obstacles of a simulator, by number. They keep the simulator alive.
#pragma once

#include "python/simulator/scripted_simulator.h"

#include <pybind11/numpy.h>

#include <memory>
#include <string>

namespace sprung::python {

struct BodyPart {
  Shared simulator;
  std::size_t number = 0;
};

struct PinPart {
  Shared simulator;
  std::size_t number = 0;
};

struct ObstaclePart {
  Shared simulator;
  std::size_t number = 0;
};

/// The springs of a body, copied.
struct SpringTable {
  pybind11::array indices;
  pybind11::array rest_lengths;
  pybind11::array stiffness;
  pybind11::array damping;
  pybind11::array kinds;
};

/// The name of each part and the part, read-only.
[[nodiscard]] pybind11::object bodies_of(const Shared& simulator);
[[nodiscard]] pybind11::object pins_of(const Shared& simulator);
[[nodiscard]] pybind11::object obstacles_of(const Shared& simulator);

}  // namespace sprung::python
