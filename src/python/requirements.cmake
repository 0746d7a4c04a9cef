# Sets SPRUNG_PYTHON to OFF, with the reason, where something is missing that the Python module needs.
if(NOT Python_EXECUTABLE AND EXISTS /usr/bin/python3)
  set(Python_EXECUTABLE /usr/bin/python3) # that of Debian's packages, whatever else is in the PATH
endif()
find_package(Python 3.9 COMPONENTS Interpreter Development.Module NumPy QUIET)
find_package(pybind11 2.10 CONFIG QUIET)

function(sprung_no_python reason)
  message(STATUS "The Python module is not built: ${reason}. `examples/install_packages.sh python` installs what is missing.")
  set(SPRUNG_PYTHON OFF PARENT_SCOPE)
endfunction()

if(SPRUNG_SANITIZE OR SPRUNG_COVERAGE)
  sprung_no_python("the interpreter is not instrumented")
elseif(NOT Python_Development.Module_FOUND)
  sprung_no_python("the headers of Python 3 are missing")
elseif(NOT Python_NumPy_FOUND)
  sprung_no_python("NumPy is missing")
elseif(NOT pybind11_FOUND)
  sprung_no_python("pybind11 is missing")
endif()
