#include "python/simulator/python_force.h"

#include "python/simulator/arrays.h"
#include "python/simulator/errors.h"
#include "python/simulator/interpreter.h"

#include <numeric>
#include <utility>

namespace py = pybind11;

namespace sprung::python {

PythonForce::PythonForce(py::function function, Range range, bool is_everywhere)
    : function_(std::move(function)), range_(range), is_everywhere_(is_everywhere) {
  name_ = py::str(py::getattr(function_, "__name__", py::str(py::type::of(function_).attr("__name__")))).cast<std::string>();
}

PythonForce::~PythonForce() {
  const WithLock lock;  // a model may be dropped by any thread
  function_ = py::object();
}

std::optional<std::vector<Index>> PythonForce::touched() const {
  if (is_everywhere_) return std::nullopt;
  std::vector<Index> particles(static_cast<std::size_t>(range_.count));
  std::iota(particles.begin(), particles.end(), range_.first);
  return particles;
}

void PythonForce::add(const Kinematics& at, Points& forces) const {
  const WithLock lock;
  const std::string key = "added force \"" + name_ + "\"";
  const py::object result = function_(copy_of(at.x.middleCols(range_.first, range_.count)),
                                      copy_of(at.v.middleCols(range_.first, range_.count)), at.time);
  const Points added = points_of(result, key, range_.count);
  for (Index i = 0; i < range_.count; ++i) {
    if (added.col(i).allFinite()) continue;
    refuse(key, "particle " + std::to_string(i), "must return finite forces", "correct the function");
  }
  forces.middleCols(range_.first, range_.count) += added;
}

}  // namespace sprung::python
