// Changes of a simulator that a checkpoint lacks: a file repeats them. Each throws InputError; nothing has changed then.
#pragma once

#include "python/simulator/scripted_simulator.h"

#include <pybind11/pybind11.h>

#include <string>

namespace sprung::python {

/// Acceleration of gravity [m/s^2], (3,).
void set_gravity(ScriptedSimulator& simulator, const pybind11::object& value);

/// Gives springs of a body other stiffness [N/m] and damping [N s/m], as a new model. None keeps them; `kind` None: of all kinds.
/// Takes a copy of the name, as that of the network goes with its model.
void set_springs(const Shared& simulator, std::string body, const pybind11::object& stiffness, const pybind11::object& damping,
                 const pybind11::object& kind);

/// Makes a change again that ScriptedSimulator::changes() recorded.
void repeat_change(const Shared& simulator, const std::string& what, const std::string& value);

/// Adds a force of a Python function: of one body, or of all particles if it is None.
void add_force(const Shared& simulator, const pybind11::function& function, const pybind11::object& body);

void remove_force(ScriptedSimulator& simulator, const pybind11::object& function);

}  // namespace sprung::python
