// The interpreter's lock, and its end. When a program ends, the interpreter ends threads that then take the lock by an exception
// that nothing may catch, which C++ answers by an abort. These wait instead, until the process ends.
#pragma once

#include <pybind11/pybind11.h>

#include <optional>

namespace sprung::python {

/// Lets threads wait from the end of the program on. Call it once.
void register_end();

/// Waits for ever if the program ends, unless this thread ends it. Costs a nanosecond.
void wait_if_ending();

/// Takes the interpreter's lock during its lifetime.
class WithLock {
 public:
  WithLock();
  ~WithLock();
  WithLock(const WithLock&) = delete;

 private:
  bool enters_;  ///< whether the thread did not have it before
  std::optional<pybind11::gil_scoped_acquire> lock_;
};

/// Gives the lock back during its lifetime. Cheaper than the one of pybind11, which counts in steps of a short rope.
class WithoutLock {
 public:
  WithoutLock() : thread_(PyEval_SaveThread()) {}
  ~WithoutLock();
  WithoutLock(const WithoutLock&) = delete;

 private:
  PyThreadState* thread_;
};

}  // namespace sprung::python
