#include "python/fast_step.h"

#include "python/simulator/errors.h"
#include "python/simulator/scripted_simulator.h"

#include <exception>

namespace py = pybind11;

namespace sprung::python {
namespace {

/// The argument `steps`, by position or by name. Returns whether the arguments are right; otherwise an exception is set.
bool read_steps(PyObject* const* arguments, Py_ssize_t count, PyObject* names, long long& steps) {
  const Py_ssize_t named = names != nullptr ? PyTuple_GET_SIZE(names) : 0;
  if (count + named > 1) {
    PyErr_SetString(PyExc_TypeError, "step() takes one argument, the number of steps");
    return false;
  }
  if (named == 1 && PyUnicode_CompareWithASCIIString(PyTuple_GET_ITEM(names, 0), "steps") != 0) {
    PyErr_Format(PyExc_TypeError, "step() has no argument %R", PyTuple_GET_ITEM(names, 0));
    return false;
  }
  if (count + named == 1) steps = PyLong_AsLongLong(arguments[0]);
  return PyErr_Occurred() == nullptr;
}

PyObject* step(PyObject* self, PyObject* const* arguments, Py_ssize_t count, PyObject* names) {
  long long steps = 1;
  if ((count > 0 || names != nullptr) && !read_steps(arguments, count, names, steps)) return nullptr;
  // The descriptor has checked the class, which has no bases and no derived class in C++.
  const void* value = reinterpret_cast<py::detail::instance*>(self)->get_value_and_holder().value_ptr();
  if (value == nullptr) {
    PyErr_SetString(PyExc_TypeError, "Simulator.__init__() was not called");
    return nullptr;
  }
  try {
    static_cast<ScriptedSimulator*>(const_cast<void*>(value))->step(steps);
  } catch (...) {
    set_error(std::current_exception());
    return nullptr;
  }
  Py_RETURN_NONE;
}

// The first line is the signature, as inspect.signature() and help() read it.
constexpr const char* kDocumentation = R"(step($self, /, steps=1)
--

Make so many steps. Raises StepError if the simulation diverged; the simulator then is at the begin of that step. Raises InputError
if arrays hold what the simulator refuses. Ctrl-C raises KeyboardInterrupt at the begin of a step; the simulator can go on. Warns by
SprungWarning, once for all simulators of a scene, of vertices without an admissible position, cells inside out, a missed stretch
limit, and a thickness that is too small for the step.)";

PyMethodDef method{"step", reinterpret_cast<PyCFunction>(reinterpret_cast<void (*)()>(&step)), METH_FASTCALL | METH_KEYWORDS,
                   kDocumentation};

}  // namespace

void add_step(py::object simulator_class) {
  const py::object descriptor =
      py::reinterpret_steal<py::object>(PyDescr_NewMethod(reinterpret_cast<PyTypeObject*>(simulator_class.ptr()), &method));
  if (!descriptor) throw py::error_already_set();
  simulator_class.attr("step") = descriptor;
}

}  // namespace sprung::python
