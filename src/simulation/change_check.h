// The rules for changes that a program makes between two steps, and for a state with which it continues. Each function throws
// InputError.
#pragma once

#include "base/problem_list.h"
#include "dynamics/forces/force.h"
#include "dynamics/state/simulation_state.h"
#include "simulation/control.h"
#include "simulation/model.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace sprung {

/// Another network and other settings for a state of the model `before`: cached contacts and permitted crossings belong to its
/// elements, and time is counted in frames and steps. Its pins and attachments must hold particles that exist.
void check_change(const SpringNetwork& network, const SimulatorSettings& settings, const Model& before,
                  const SimulationState& state);

/// The number of one of `count` things. `key` is their plural, such as "obstacles", and `what` completes "the number of": "an
/// obstacle".
void check_entry(const std::string& key, const std::string& what, std::int64_t number, std::int64_t count);

/// Adds a problem if the number is negative or not finite; does not throw.
void check_number(const std::string& key, double number, ProblemList& problems);

/// Throws if the pose is no rotation and translation, or if a step between these poses moves a point within `reach` [m] of the
/// origin farther than the size [m] of the largest body. A longer step could stretch a body to more than twice its size.
void check_move(const std::string& key, const RigidTransform& from, const RigidTransform& to, double reach,
                const SpringNetwork& network);

/// Positions and velocities of all particles, 3 x n: as many columns as particles, finite, and pinned particles where they are.
void check_motion(const SpringNetwork& network, const SimulationState& state, const Points& positions, const Points& velocities);

/// The number of a particle.
void check_particle(const SpringNetwork& network, Index particle);

/// Whether a pin that holds this particle alone may have the name: none has it, or a former pin of this particle that was added.
[[nodiscard]] bool is_free_for(Index particle, const std::string& name, const Model& model, const SimulationState& state);

/// A force or a constraint that a program adds to those of the control. The elements of a force must be of particles.
void check_added(const std::shared_ptr<Force>& force, const Control& control, const SpringNetwork& network);
void check_added(const std::shared_ptr<Constraint>& constraint, const Control& control, const SpringNetwork& network);

/// Asks the added forces and constraints which particles they touch.
[[nodiscard]] TouchedParticles checked_touched(const Control& control, const SpringNetwork& network);

/// A pin that a program adds. `model` has the pins that no program added.
void check_pin(const SpringNetwork& model, const std::vector<Index>& particles, const std::string& name);

/// What a state must fit.
struct StateOwner {
  const Model& model;
  const Control& control;
  Index sleep_groups = 0;    ///< their number
  bool can_collide = false;  ///< whether there is anything that the network may touch
};

/// Names every number of the state that is not finite, and every count or index that does not fit its owner.
void check_state(const StateOwner& owner, const SimulationState& state);

}  // namespace sprung
