// Simulator.step(): the one function that programs call a thousand times for small systems.
#pragma once

#include <pybind11/pybind11.h>

namespace sprung::python {

/// Gives the class of ScriptedSimulator a method `step` without the dispatch of pybind11, which takes a fifth of a step of a short
/// rope.
void add_step(pybind11::object simulator_class);

}  // namespace sprung::python
