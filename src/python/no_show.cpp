// The module of a build without the viewer.
#include "python/bindings.h"
#include "python/simulator/scripted_simulator.h"

#include <memory>
#include <stdexcept>

namespace py = pybind11;

namespace sprung::python {
namespace {

struct Viewer {};

Viewer show(const std::shared_ptr<ScriptedSimulator>& /*simulator*/, bool /*open*/, int /*port*/) {
  throw std::runtime_error("this build has no viewer; examples/view.sh installs what it needs and builds it");
}

}  // namespace

void bind_show(py::module_& module) {
  py::class_<Viewer>(module, "Viewer", "Not in this build.");
  module.def("show", &show, py::arg("simulator"), py::kw_only(), py::arg("open") = true, py::arg("port") = 0,
             "show(simulator, *, open=True, port=0)\n--\n\nNot in this build.");
}

}  // namespace sprung::python
