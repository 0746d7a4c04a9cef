// The extension module sprung._core; sprung/__init__.py shows what programs use of it.
#include "python/bindings.h"
#include "python/simulator/errors.h"
#include "python/simulator/interpreter.h"

namespace py = pybind11;

PYBIND11_MODULE(_core, module) {
  py::options options;
  options.disable_function_signatures();
  module.doc() = "The compiled part of sprung.";
  module.attr("version") = SPRUNG_VERSION;
  const py::object name = module.attr("__name__");
  module.attr("__name__") = "sprung";  // of classes in messages and in help()
  sprung::python::register_end();
  sprung::python::register_errors();
  sprung::python::bind_parts(module);
  sprung::python::bind_simulator(module);
  sprung::python::bind_scene(module);
  sprung::python::bind_builder(module);
  sprung::python::bind_show(module);
  module.attr("__name__") = name;
}
