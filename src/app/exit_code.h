// Exit codes of the program.
#pragma once

namespace sprung {

enum class ExitCode : int {
  done = 0,
  unexpected = 1,     ///< out of memory, or a bug in Sprung
  usage = 2,          ///< the command line is wrong
  invalid = 3,        ///< the scene, a mesh or the files of a run are invalid
  diverged = 4,       ///< the simulation diverged, or runs of a sweep failed
  file = 5,           ///< the scene file or a run cannot be read, or the output cannot be written
  interrupted = 130,  ///< by a signal; a frame that does not end soon is not written
};

}  // namespace sprung
