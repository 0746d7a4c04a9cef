#include "dynamics/forces/bending_angle_force.h"

#include "base/parallel.h"
#include "dynamics/forces/material_dampers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace sprung {
namespace {

// One thread computes all elements that touch a block of particles. Elements across two blocks are computed twice.
constexpr Index kParticleBlock = 2048;

/// f(bond) and its derivative: the gradient of f is `slope` times the bond.
struct Fullness {
  double value = 1.0;
  double slope = 0.0;  ///< [1/m^2]
};

Fullness fullness_of(const Vector3& bond, double rest_length) {
  const double square = rest_length * rest_length;
  const double most = 4.0 * bond.squaredNorm();
  return most < square ? Fullness{most / square, 8.0 / square} : Fullness{};
}

struct Bend {
  Bend(const AngleBends& bends, Index element, const Points& x)
      : a(x.col(bends.middle[element]) - x.col(bends.before[element])),
        b(x.col(bends.after[element]) - x.col(bends.middle[element])),
        normal(a.cross(b)),
        sine(normal.norm()),
        full_a(fullness_of(a, bends.length_before[element])),
        full_b(fullness_of(b, bends.length_after[element])) {}

  [[nodiscard]] double angle() const { return std::atan2(sine, a.dot(b)); }
  [[nodiscard]] double fullness() const { return full_a.value * full_b.value; }
  [[nodiscard]] double energy(double stiffness) const { return 0.5 * stiffness * angle() * angle() * fullness(); }

  Vector3 a;
  Vector3 b;
  Vector3 normal;
  double sine;  ///< |a| |b| sin(angle)
  Fullness full_a;
  Fullness full_b;
};

/// The gradient of the angle at before, middle and after [1/m]. Requires a non-zero sine.
std::array<Vector3, 3> turns(const Bend& bend) {
  const Vector3 before = (1.0 / (bend.sine * bend.a.squaredNorm())) * bend.normal.cross(bend.a);
  const Vector3 after = (1.0 / (bend.sine * bend.b.squaredNorm())) * bend.normal.cross(bend.b);
  return {before, -(before + after), after};
}

std::array<Index, 3> particles_of(const AngleBends& bends, Index element) {
  return {bends.before[element], bends.middle[element], bends.after[element]};
}

struct BendConstants {
  double stiffness;
  double damping;
  bool bounds_damping;
};

// The gradient of the angle grows with 1 / length.
double shortness(const Vector3& bond, double rest_length) {
  return std::min(1.0, bond.squaredNorm() / (rest_length * rest_length));
}

/// Forces on before and after; the force on the middle is minus their sum.
std::array<Vector3, 2> bend_forces(const AngleBends& bends, Index element, const BendConstants& constants, const Kinematics& at) {
  const auto [stiffness, damping, bounds_damping] = constants;
  const Bend bend(bends, element, at.x);
  if (!(bend.sine > 0.0)) return {Vector3::Zero(), Vector3::Zero()};
  const auto [turn_before, turn_middle, turn_after] = turns(bend);
  const double angle = stiffness > 0.0 ? bend.angle() : 0.0;
  double moment = stiffness * angle;
  if (damping > 0.0) {
    const Vector3 v = at.v.col(bends.middle[element]);
    const double share =
        bounds_damping ? shortness(bend.a, bends.length_before[element]) * shortness(bend.b, bends.length_after[element]) : 1.0;
    moment += share * damping *
              (turn_before.dot(at.v.col(bends.before[element]) - v) + turn_after.dot(at.v.col(bends.after[element]) - v));
  }
  moment *= bend.fullness();
  const double half = 0.5 * stiffness * angle * angle;
  return {half * bend.full_b.value * bend.full_a.slope * bend.a - moment * turn_before,
          -half * bend.full_a.value * bend.full_b.slope * bend.b - moment * turn_after};
}

/// Adds -u_i u_j direction for all pairs of the element's particles.
void add_products(const std::array<Index, 3>& particles, const std::array<double, 3>& u, const Matrix3& direction,
                  BlockMatrix& to) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j <= i; ++j) to.add(particles[i], particles[j], -(u[i] * u[j]) * direction);
  }
}

/// Adds -factor g_i g_j^T for all pairs of the element's particles.
void add_products(const std::array<Index, 3>& particles, const std::array<Vector3, 3>& g, double factor, BlockMatrix& to) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j <= i; ++j) to.add(particles[i], particles[j], -factor * g[i] * g[j].transpose());
  }
}

}  // namespace

BendingAngleForce::BendingAngleForce(const SpringNetwork& network)
    : network_(network), stiffness_(network.angle_bends.stiffness), damping_(network.angle_bends.damping) {
  assign_blocks();
}

BendingAngleForce::BendingAngleForce(const SpringNetwork& network, ElementConstants constants)
    : network_(network),
      own_(std::make_unique<ElementConstants>(std::move(constants))),
      stiffness_(own_->stiffness),
      damping_(own_->damping) {
  assign_blocks();
}

void BendingAngleForce::assign_blocks() {
  blocks_.resize(network_.particle_count() / kParticleBlock + 1);
  const AngleBends& bends = network_.angle_bends;
  for (Index element = 0; element < bends.count(); ++element) {
    const std::array<Index, 3> particles = particles_of(bends, element);
    if (std::ranges::all_of(particles, [&](Index i) { return network_.is_asleep(i); })) continue;
    if (own_ != nullptr && stiffness_[element] == 0.0 && damping_[element] == 0.0) continue;
    for (const Index particle : particles) {
      std::vector<Index>& block = blocks_[particle / kParticleBlock];
      if (block.empty() || block.back() != element) block.push_back(element);
    }
  }
}

void BendingAngleForce::add(const Kinematics& at, Points& forces) const {
  const AngleBends& bends = network_.angle_bends;
  const bool bounds_damping = own_ != nullptr && own_->bounds_damping;
  parallel_chunks(static_cast<Index>(blocks_.size()), 1, [&](Index begin, Index end) {
    for (Index block = begin; block < end; ++block) {
      const auto add_to = [&](Index particle, const Vector3& force) {
        if (particle / kParticleBlock == block) forces.col(particle) += force;
      };
      for (const Index element : blocks_[block]) {
        const auto [on_before, on_after] =
            bend_forces(bends, element, {stiffness_[element], damping_[element], bounds_damping}, at);
        add_to(bends.before[element], on_before);
        add_to(bends.middle[element], -(on_before + on_after));
        add_to(bends.after[element], on_after);
      }
    }
  });
}

void BendingAngleForce::couple(std::vector<ParticlePair>& pairs) const {
  for (Index element = 0; element < network_.angle_bends.count(); ++element) {
    const auto [before, middle, after] = particles_of(network_.angle_bends, element);
    for (const ParticlePair& pair : {ParticlePair{before, middle}, {middle, after}, {before, after}}) pairs.push_back(pair);
  }
}

void BendingAngleForce::add_derivatives(const Kinematics& at, ForceDerivatives& derivatives) const {
  const AngleBends& bends = network_.angle_bends;
  for (Index element = 0; element < bends.count(); ++element) {
    const Bend bend(bends, element, at.x);
    const std::array<Index, 3> particles = particles_of(bends, element);
    const double stiffness = stiffness_[element] * bend.fullness();
    if (!(stiffness > 0.0) && !(damping_[element] > 0.0)) continue;
    const double per_a = 1.0 / bend.a.norm();
    const double per_b = 1.0 / bend.b.norm();
    if (!std::isfinite(per_a) || !std::isfinite(per_b)) continue;
    const std::array<double, 3> across{per_a, -per_a - per_b, per_b};
    if (bend.sine > 0.0) {
      const Vector3 normal = bend.normal / bend.sine;
      const double half = 0.5 * bend.angle();
      add_products(particles, turns(bend), stiffness, derivatives.by_position);
      add_products(particles, across, (stiffness * half / std::tan(half)) * normal * normal.transpose(), derivatives.by_position);
      add_products(particles, turns(bend), damping_[element] * bend.fullness(), derivatives.by_velocity);
    } else if (bend.angle() == 0.0) {
      const Vector3 along = per_a * bend.a;
      add_products(particles, across, stiffness * (Matrix3::Identity() - along * along.transpose()), derivatives.by_position);
    }
  }
}

void BendingAngleForce::append_elements(std::vector<LinearElement>& elements) const {
  const AngleBends& bends = network_.angle_bends;
  const std::size_t begin = elements.size();
  for (Index e = 0; e < bends.count(); ++e) {
    const double before = 1.0 / bends.length_before[e];
    const double after = 1.0 / bends.length_after[e];
    elements.push_back({particles_of(bends, e), {before, -(before + after), after}, stiffness_[e], damping_[e]});
  }
  for_material_bends(network_, [&](Index e) { elements[begin + static_cast<std::size_t>(e)].of_material = true; });
}

double BendingAngleForce::capacity() const {
  double energy = 0.0;
  for (const double k : stiffness_) energy += 0.5 * k * std::numbers::pi * std::numbers::pi;
  return energy;
}

double BendingAngleForce::energy(const Points& positions) const {
  const AngleBends& bends = network_.angle_bends;
  double energy = 0.0;
  for (Index element = 0; element < bends.count(); ++element) energy += Bend(bends, element, positions).energy(stiffness_[element]);
  return energy;
}

}  // namespace sprung
