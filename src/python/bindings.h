// The parts of the module, each in a source of its own.
#pragma once

#include <pybind11/pybind11.h>

namespace sprung::python {

// Documentation has the signatures: those of pybind11 name C++ types.
void bind_parts(pybind11::module_& module);      ///< bodies, springs, pins, obstacles
void bind_simulator(pybind11::module_& module);  ///< simulators and their states, batches
void bind_scene(pybind11::module_& module);      ///< scenes, load(), restore()
void bind_shapes(pybind11::module_& module);     ///< bodies and obstacles for networks
void bind_builder(pybind11::module_& module);    ///< networks, and simulators of them
void bind_show(pybind11::module_& module);       ///< the viewer

}  // namespace sprung::python
