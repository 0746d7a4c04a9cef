// A state in a file, with what tells which simulators it fits.
#pragma once

#include "dynamics/state/simulation_state.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace sprung {

class Simulator;
struct Problem;

/// The name of a body, a pin or an obstacle, and the number of its particles; 0 of an obstacle.
struct NamedCount {
  std::string name;
  Index particles = 0;
  Index springs = 0;  ///< of a body, also those that broke
};

struct Checkpoint {
  std::vector<NamedCount> bodies;
  std::vector<NamedCount> obstacles;
  SimulationState state;
  /// The last state of a run, which the simulator reached after `state`; none if it is `state`.
  std::optional<SimulationState> last;
  std::string run;  ///< what the output of a run adds; empty if a program saved the state
};

/// With the present state.
[[nodiscard]] Checkpoint checkpoint_of(const Simulator& simulator);

/// Writes a file that is on the disk when this returns. Throws FileError; a former file then stays. Takes about 3 ms per megabyte,
/// and the time of the disk.
void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint);

/// Throws FileError that tells in one line whether the file cannot be read, is no checkpoint, is truncated or damaged, or was
/// written by another version. Such a state may still not fit a simulator: Simulator::restore() checks it.
[[nodiscard]] Checkpoint read_checkpoint(const std::filesystem::path& file);

/// Each difference between the bodies of a checkpoint and those of a network, by name: bodies that one of them lacks, and other
/// numbers of particles or springs. Empty if there is none.
[[nodiscard]] std::vector<std::string> differences(const std::vector<NamedCount>& bodies, const std::vector<NamedCount>& others);

/// The bodies of a network.
[[nodiscard]] std::vector<NamedCount> bodies_of(const SpringNetwork& network);

}  // namespace sprung
