// The rules for changes that a program makes between two steps. Each function throws InputError.
#pragma once

#include "base/problem_list.h"
#include "dynamics/forces/force.h"
#include "dynamics/state/simulation_state.h"
#include "simulation/model.h"

#include <cstddef>
#include <string>
#include <vector>

namespace sprung {

/// Another network and other settings for a state of the model `before`: cached contacts and permitted crossings belong to its
/// elements, and time is counted in frames and steps. Its pins and attachments must hold particles that exist.
void check_change(const SpringNetwork& network, const SimulatorSettings& settings, const Model& before,
                  const SimulationState& state);

/// The number of an entry of a list of `count` entries.
void check_entry(const std::string& key, std::size_t number, std::size_t count);

/// Adds a problem instead, if a number is negative or not finite.
void check_number(const std::string& key, double number, ProblemList& problems);

/// The elements of a force that a program adds.
void check_elements(const Force& force, const std::vector<LinearElement>& elements, Index particle_count);

/// A rotation and a translation.
void check_pose(const std::string& key, const RigidTransform& pose);

/// The way between two poses in a step, of points that are up to `reach` [m] from their origin. It must not stretch a body to more
/// than twice its size, so it is at most the size of the largest body.
void check_travel(const std::string& key, const RigidTransform& from, const RigidTransform& to, double reach,
                  const SpringNetwork& network);

/// The number of a particle.
void check_particle(const SpringNetwork& network, Index particle);

/// Whether a pin that holds this particle alone may have the name: none has it, or a former pin of this particle that was added.
[[nodiscard]] bool is_free_for(Index particle, const std::string& name, const Model& model, const SimulationState& state);

/// A pin that a program adds. `model` has the pins that no program added.
void check_pin(const SpringNetwork& model, const std::vector<Index>& particles, const std::string& name);

}  // namespace sprung
