// The names of bodies and obstacles, which name folders and files of a run.
#pragma once

namespace sprung {

class Simulator;

/// Throws InputError for names of bodies and obstacles that are not valid folder names, that are used twice, or for a body with the
/// name `obstacles`.
void check_output_names(const Simulator& simulator);

}  // namespace sprung
