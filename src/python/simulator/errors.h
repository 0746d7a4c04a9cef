// Errors of the library as exceptions of the package.
#pragma once

#include <exception>
#include <string>

namespace sprung::python {

/// Lets InputError, StepError and FileError become those of sprung._errors.
void register_errors();

/// Sets the exception that Python raises for an error of the library, or of Python itself.
void set_error(std::exception_ptr thrown);

/// Warns by Python's `warnings`. Throws what a filter of these raises.
void warn(const std::string& text);

/// Throws InputError with one problem.
[[noreturn]] void refuse(const std::string& key, const std::string& value, const std::string& rule, const std::string& remedy);

}  // namespace sprung::python
