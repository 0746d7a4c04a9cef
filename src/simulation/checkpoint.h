// A state and caches in a file, with what tells which simulators they fit.
#pragma once

#include "dynamics/state/simulation_state.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace sprung {

class Model;
struct Obstacle;

/// The name of a body or an obstacle, and of a body what must be the same in a simulation that gets its state.
struct NamedCount {
  std::string name;
  Index particles = 0;
  Index springs = 0;              ///< also those that broke
  std::uint64_t spring_ends = 0;  ///< fingerprint of the particles at their ends, counted in the body; 0: not known
};

struct Checkpoint {
  std::vector<NamedCount> bodies;
  std::vector<NamedCount> obstacles;
  SimulationState state;
  std::string caches;       ///< regions, pairs and factors that former steps left behind
  std::uint64_t model = 0;  ///< fingerprint of the network and the obstacles: caches are of no use in another one
  std::string run;          ///< what the output of a run adds; empty if a program saved the state
};

/// Writes a file that is on the disk when this returns. Throws FileError; a former file then stays. Takes about 5 ms per megabyte,
/// and the time of the disk.
void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint);

/// Throws FileError that tells in one line whether the file cannot be read, is no checkpoint, is truncated or damaged, or was
/// written by another version, with the remedy. Such a state may still not fit a simulator: Simulator::restore() checks it.
[[nodiscard]] Checkpoint read_checkpoint(const std::filesystem::path& file, std::string_view remedy = {});

/// The fingerprint of what caches depend on: particles, springs, surfaces and the shapes of obstacles.
[[nodiscard]] std::uint64_t fingerprint_of(const Model& model);

/// The fingerprint of a mesh or a sequence of meshes; 0 for a primitive.
[[nodiscard]] std::uint64_t fingerprint_of_shape(const Obstacle& obstacle);

/// The fingerprint of the springs of a body; `ends` are particles, counted in the body.
[[nodiscard]] std::uint64_t fingerprint_of_springs(const std::vector<Index>& ends);

/// Each difference between two lists of bodies, by name: bodies that one of them lacks, other numbers of particles or springs, and
/// springs between other particles. Empty if there is none.
[[nodiscard]] std::vector<std::string> differences(const std::vector<NamedCount>& bodies, const std::vector<NamedCount>& others);

/// The bodies of a network.
[[nodiscard]] std::vector<NamedCount> bodies_of(const SpringNetwork& network);

}  // namespace sprung
