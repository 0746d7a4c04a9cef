// The interface of forces on particles.
#pragma once

#include "base/types.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace sprung {

struct ForceDerivatives;
struct ParticlePair;
class Wind;

/// The state at which forces are evaluated.
struct Kinematics {
  const Points& x;    ///< positions [m], 3 x n
  const Points& v;    ///< velocities [m/s], 3 x n
  double time = 0.0;  ///< [s]
};

/// External conditions that may change between two steps.
struct Conditions {
  const Vector3& gravity;  ///< [m/s^2]
  const Wind& wind;
};

/// A spring and a damper on one weighted sum w_1 u_1 + w_2 u_2 + ... of displacements u [m]: stiffness k and damping c have the
/// matrices k w w^T and c w w^T.
struct LinearElement {
  std::array<Index, 6> particles{};
  std::array<double, 6> weights{};
  std::size_t count = 0;   ///< of particles
  double stiffness = 0.0;  ///< k [N/m] for weights without a unit
  double damping = 0.0;    ///< c [N s/m]
  /// Whether the damper is that of a material: see Body::has_material_dampers.
  bool of_material = false;

  /// On at most six particles.
  [[nodiscard]] static LinearElement of(std::span<const Index> particles, std::span<const double> weights, double stiffness,
                                        double damping);
  /// On the position of one particle.
  [[nodiscard]] static LinearElement anchor(Index particle, double stiffness, double damping);
  /// On the difference of the positions of two particles.
  [[nodiscard]] static LinearElement pair(Index first, Index second, double stiffness, double damping);
};

/// The column of diagnostics in which the energy of a force counts.
enum class EnergyKind : std::uint8_t { elastic, gravity, contact };

/// A force on particles. A simulator calls a force from one thread at a time. If none of its members changes it, `prepare` and
/// `note_solution` included, it may belong to several simulators that run at the same time. Change its parameters while none of
/// them runs. A substep calls `add` once or more (Runge-Kutta four times) and, with implicit Euler, `add_derivatives`: these two
/// decide what a force costs.
class Force {
 public:
  virtual ~Force() = default;

  /// For messages, such as "springs". Default: "added forces".
  [[nodiscard]] virtual std::string name() const;

  /// Prepares the force for evaluations at `time` [s]. Not thread-safe. Default: does nothing.
  virtual void prepare(double time);

  /// Sets new conditions. Default: does nothing.
  virtual void follow(const Conditions& conditions);

  /// The steps of explicit schemes are `dt` [s] long from now on. Default: does nothing.
  virtual void set_step(double dt);

  /// The particles to which the force is applied, now or later; none: any. Those of an added force stay awake. Simulator::add_force
  /// asks for them: call Simulator::wake() after they changed. Default: any.
  [[nodiscard]] virtual std::optional<std::vector<Index>> touched() const;

  /// Whether `add` adds the same force at all positions, velocities and times. Default: no.
  [[nodiscard]] virtual bool is_constant() const;

  /// Several calls of `add` at these positions [m], 3 x n, follow, each with other velocities: a force may keep what depends on the
  /// positions alone. Not thread-safe. Default: does nothing.
  virtual void hold(const Points& positions);

  /// Adds the forces [N] on all particles to `forces`, 3 x n. Thread-safe. Gives the same bits for any number of threads.
  virtual void add(const Kinematics& at, Points& forces) const = 0;

  /// Appends the off-diagonal pairs that `add_derivatives` writes to at any position. Default: none.
  virtual void couple(std::vector<ParticlePair>& pairs) const;

  /// Adds the symmetric, restoring part of the derivatives. Parts that would amplify a motion, such as the sideways buckling of a
  /// compressed spring, are left out (filtering, Baraff and Witkin 1998). Default: none.
  virtual void add_derivatives(const Kinematics& at, ForceDerivatives& derivatives) const;

  /// Appends elements that together bound the step: the sums of their matrices are at least the derivatives of the force by
  /// positions and by velocities, as quadratic forms, wherever the force acts as the step's bound assumes (see SpectralBounds).
  /// Default: none, for a force that bounds no step.
  virtual void append_elements(std::vector<LinearElement>& elements) const;

  /// Implicit schemes call it with the positions [m], 3 x n, that solve the linear system of the last `add_derivatives`: the force
  /// in the step was that at those derivatives plus the derivatives times the displacements since. Default: does nothing.
  virtual void note_solution(const Points& positions);

  /// Potential energy [J]. Default: 0, for a force without a potential.
  [[nodiscard]] virtual double energy(const Points& positions) const;

  /// Default: elastic.
  [[nodiscard]] virtual EnergyKind energy_kind() const;

  /// The energy [J] that the force may store before an explosion is suspected, such as that of springs at twice their length.
  /// Default: 0.
  [[nodiscard]] virtual double capacity() const;

  /// An upper bound of the acceleration [m/s^2] that the force gives to particles at rest, at any time. Default: 0, for a force
  /// that particles at rest do not feel, or that springs balance.
  [[nodiscard]] virtual double largest_acceleration() const;
};

using Forces = std::vector<std::unique_ptr<Force>>;

/// Whether the sum of all forces is the same at all positions, velocities and times.
[[nodiscard]] bool are_constant(const Forces& forces);

/// The sum of the potential energies of one kind [J].
[[nodiscard]] double energy_of(const Forces& forces, EnergyKind kind, const Points& positions);

/// The sum of the largest accelerations [m/s^2].
[[nodiscard]] double largest_acceleration(const Forces& forces);

/// Writes the sum of all forces [N], 3 x n, to `total`.
void sum_forces(const Forces& forces, const Kinematics& at, Points& total);

}  // namespace sprung
