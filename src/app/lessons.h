// The lessons: scenes with a text each, which belong to the program.
#pragma once

#include <string>

namespace sprung {

/// The scene file of a lesson by its name, with or without its number: `3_damping`, `damping`, `3`. The lessons of an installed
/// program lie where the installation puts them, those of a program in its build folder in the sources. Throws UsageError that
/// lists the names if there is none of this name, and FileError if the program has no lessons.
[[nodiscard]] std::string lesson_file(const std::string& name);

}  // namespace sprung
