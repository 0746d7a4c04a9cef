// The simulator: a network, its forces, its environment, and the step.
#pragma once

#include "collision/environment.h"
#include "dynamics/force.h"
#include "dynamics/integrator.h"
#include "dynamics/stable_step.h"
#include "dynamics/stretch_limit.h"
#include "network/simulation_state.h"
#include "network/spring_network.h"

#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace sprung {

struct ContactSettings {
  enum class Response : std::uint8_t {
    projection,  ///< particles are moved out of obstacles
    penalty      ///< f_coll: a spring and damper push them out
  };
  enum class Start : std::uint8_t {
    refuse,   ///< what intersects at the start is refused
    push_out  ///< what is in obstacles is led out of them before time 0
  };
  Response response = Response::projection;
  Start start = Start::refuse;
  double stiffness = 0.0;  ///< of the penalty [N/m]
  double damping = 0.0;    ///< of the penalty [N s/m]
};

enum class StabilityCheck : std::uint8_t { refuse, warn };

/// A step is not made in more parts.
inline constexpr int kMostParts = 1 << 16;

struct SimulatorSettings {
  double step = 1.0e-3;              ///< dt [s]
  Vector3 gravity{0.0, -9.81, 0.0};  ///< [m/s^2]
  double air_drag = 0.0;             ///< [kg/s] per particle of a rope, [kg/(m^2 s)] for surfaces
  Vector3 wind = Vector3::Zero();    ///< [m/s]
  IntegratorSettings integrator = VerletSettings{};
  std::optional<StretchLimitSettings> stretch_limit{};
  ContactSettings contact{};
  StabilityCheck stability = StabilityCheck::refuse;
  /// In [1, kMostParts]: steps are made in up to so many parts, see StepRefinement; in all of them while passes hold a limit that
  /// may be handed over to a global solve, which then needs fewer.
  int most_parts = 1;
};

/// What one step did: sums over its parts, and the largest excess.
struct StepReport {
  int parts = 0;                ///< that it was made in
  int iterations = 0;           ///< passes of stretch limit and contact
  int limit_solves = 0;         ///< linear systems that the stretch limit solved in turn
  double stretch_excess = 0.0;  ///< beyond the stretch limit at the end of a part, as a part of the rest length
  Index truncated = 0;          ///< particles stopped at a surface
  Index squeezed = 0;           ///< particles that found no free place between obstacles, pins and each other
  Index most_squeezed = 0;      ///< of those, the most in one part
  double turn = 0.0;            ///< of what a global solve holds, in a part at the pace of the last one, see StretchLimit::turn

  StepReport& operator+=(const StepReport& part);
};

/// A step was left off, as somebody asked for; the state it left behind must not be used.
class StoppedError : public std::runtime_error {
 public:
  StoppedError() : std::runtime_error("the step was stopped") {}
};

class Simulator {
 public:
  /// Throws InputError when settings are out of their bounds, the step is not positive or beyond the largest stable one (unless
  /// `stability` is warn: then `warnings` says so), or when anything intersects at the start that is not pushed
  /// out. Then `warnings` says what was.
  explicit Simulator(SpringNetwork network, SimulatorSettings settings = {}, std::vector<Obstacle> obstacles = {});
  ~Simulator();
  Simulator(Simulator&&) noexcept;
  Simulator& operator=(Simulator&&) noexcept;

  /// Advances by one step, in as many parts as the step before asks for (see StepRefinement), or as it takes for no obstacle or pin
  /// to turn by more than 45 degrees in one, 64 times as many at most. One that squeezes particles is made again in 4, 16 and 64
  /// times as many, until none is: obstacles that come fast, or near pins, leave a place that a long step passes by. While that
  /// does not help those that squeeze no more are tried ever more rarely. Throws StepError when the network diverged; its state is
  /// of no use then.
  StepReport step();

  /// From now on step() asks this between its parts, and throws StoppedError where it is true; its state is of no use then. A step
  /// of something that is knotted may take long.
  void stop_when(std::function<bool()> stops);

  [[nodiscard]] const SpringNetwork& network() const;
  [[nodiscard]] const SimulatorSettings& settings() const;
  [[nodiscard]] const SimulationState& state() const;
  [[nodiscard]] const Environment& environment() const;
  [[nodiscard]] const std::vector<std::string>& warnings() const;

  /// state().step * settings().step [s], between steps
  [[nodiscard]] double time() const;

  /// Positions [m], 3 x n.
  [[nodiscard]] const Points& positions() const { return state().x; }

  /// What solves the stretch limit of this network, as StretchLimit::chosen_solver; empty without a limit.
  [[nodiscard]] std::string stretch_solver() const;

  /// Particles that obstacles push at present.
  [[nodiscard]] Index contact_count() const;

  /// Throws StepError when a spring gave way, or the energy exploded, that the check of the steps, which looks at large networks
  /// only now and then, has not seen yet.
  void check() const;

  /// Elastic energy [J], sum 1/2 k_s (|s| - d)^2 and that of angle bends, and -m g . x.
  [[nodiscard]] double elastic_energy() const;
  [[nodiscard]] double gravity_energy() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace sprung
