#include "python/simulator/errors.h"

#include "base/error.h"

#include <pybind11/pybind11.h>

#include <exception>
#include <utility>

namespace py = pybind11;

namespace sprung::python {
namespace {

py::object class_of(const char* name) { return py::module_::import("sprung._errors").attr(name); }

void raise(const py::object& error) { PyErr_SetObject(py::type::of(error).ptr(), error.ptr()); }

void raise(const InputError& error) {
  const py::object problem = class_of("Problem");
  py::list problems;
  for (const Problem& each : error.problems()) problems.append(problem(each.file, each.key, each.value, each.rule, each.remedy));
  raise(class_of("InputError")(error.what(), py::tuple(problems)));
}

void raise(const StepError& error) {
  const StepFailure& failure = error.failure();
  const auto number = [](Index index) { return index == kNone ? py::object(py::none()) : py::object(py::int_(index)); };
  raise(class_of("StepError")(error.what(), failure.step, failure.time, failure.body, number(failure.particle),
                              number(failure.spring), failure.cause, failure.remedy));
}

void translate(std::exception_ptr thrown) try {
  if (thrown) std::rethrow_exception(std::move(thrown));
} catch (const InputError& error) {
  raise(error);
} catch (const StepError& error) {
  raise(error);
} catch (const FileError& error) {
  raise(class_of("FileError")(error.what()));
}

}  // namespace

void set_error(std::exception_ptr thrown) try { translate(std::move(thrown)); } catch (py::error_already_set& error) {
  error.restore();
} catch (const std::exception& error) {
  PyErr_SetString(PyExc_RuntimeError, error.what());
}

void register_errors() { py::register_exception_translator(&translate); }

void warn(const std::string& text) {
  if (PyErr_WarnEx(class_of("SprungWarning").ptr(), text.c_str(), 1) != 0) throw py::error_already_set();
}

void refuse(const std::string& key, const std::string& value, const std::string& rule, const std::string& remedy) {
  throw InputError({.key = key, .value = value, .rule = rule, .remedy = remedy});
}

}  // namespace sprung::python
