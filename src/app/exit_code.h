// How the program ends, as scripts see it.
#pragma once

namespace sprung {

enum class ExitCode : int {
  done = 0,
  unexpected = 1,     ///< out of memory, or an error of our own
  usage = 2,          ///< the command line is wrong
  invalid = 3,        ///< the scene or a mesh is invalid
  diverged = 4,       ///< the simulation diverged
  file = 5,           ///< the scene file cannot be read, or the output cannot be written
  interrupted = 130,  ///< by SIGINT or SIGTERM; the frame at hand is left off
};

}  // namespace sprung
