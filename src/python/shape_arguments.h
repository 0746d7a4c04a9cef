// Arguments that functions for shapes and for networks share.
#pragma once

#include "base/contact_material.h"

#include <pybind11/pybind11.h>

namespace sprung::python {

/// (0, 0, 0), a default.
[[nodiscard]] const pybind11::tuple& origin();

/// `friction` is that of sliding and of sticking.
[[nodiscard]] ContactMaterial material_of(double thickness, double friction, double restitution);

}  // namespace sprung::python
