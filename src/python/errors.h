// Errors of the library as exceptions of the package.
#pragma once

#include <string>

namespace sprung::python {

/// Lets InputError, StepError and FileError become those of sprung._errors.
void register_errors();

/// Throws InputError with one problem.
[[noreturn]] void refuse(const std::string& key, const std::string& value, const std::string& rule, const std::string& remedy);

}  // namespace sprung::python
