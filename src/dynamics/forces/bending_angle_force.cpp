#include "dynamics/forces/bending_angle_force.h"

#include "base/parallel.h"
#include "dynamics/forces/angle_bend.h"
#include "dynamics/forces/force_derivatives.h"
#include "dynamics/forces/hinge_angle.h"
#include "dynamics/forces/material_dampers.h"
#include "dynamics/numerics/block_matrix.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

namespace sprung {
namespace {

constexpr Index kHingesAtOnce = 1024;

/// Forces on before and after; the force on the middle is minus their sum.
std::array<Vector3, 2> bend_forces(const AngleBends& bends, Index element, double stiffness, double damping, const Kinematics& at) {
  const Bend bend(bends, element, at.x);
  if (!(bend.sine > 0.0)) return {Vector3::Zero(), Vector3::Zero()};
  const auto [turn_before, turn_middle, turn_after] = turns(bend);
  const double angle = stiffness > 0.0 ? bend.angle() : 0.0;
  double moment = stiffness * angle;
  if (damping > 0.0) {
    const Vector3 v = at.v.col(bends.middle[element]);
    moment += damping * (turn_before.dot(at.v.col(bends.before[element]) - v) + turn_after.dot(at.v.col(bends.after[element]) - v));
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
template <std::size_t kCount>
void add_products(const std::array<Index, kCount>& particles, const std::array<Vector3, kCount>& g, double factor,
                  BlockMatrix& to) {
  if (factor == 0.0) return;
  for (std::size_t i = 0; i < kCount; ++i) {
    for (std::size_t j = 0; j <= i; ++j) to.add(particles[i], particles[j], -factor * g[i] * g[j].transpose());
  }
}

/// The length of a gradient at rest, whose entries are the weights, over its present one; at most 1.
double share_of(const std::array<Vector3, 4>& gradient, const std::array<double, 4>& weights) {
  double present = 0.0;
  double at_rest = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    present += gradient[i].squaredNorm();
    at_rest += weights[i] * weights[i];
  }
  return present > at_rest ? std::sqrt(at_rest / present) : 1.0;
}

}  // namespace

ElementConstants constants_of_bends(const SpringNetwork& network) {
  ElementConstants constants{network.angle_bends.stiffness, network.angle_bends.damping};
  const FaceBends& faces = network.face_bends;
  constants.stiffness.insert(constants.stiffness.end(), faces.stiffness.begin(), faces.stiffness.end());
  constants.damping.insert(constants.damping.end(), faces.damping.begin(), faces.damping.end());
  return constants;
}

BendingAngleForce::BendingAngleForce(const SpringNetwork& network) : BendingAngleForce(network, constants_of_bends(network)) {}

BendingAngleForce::BendingAngleForce(const SpringNetwork& network, ElementConstants constants)
    : network_(network),
      constants_(std::move(constants)),
      first_face_(static_cast<std::size_t>(network.angle_bends.count())),
      bend_blocks_(network.particle_count()),
      hinge_blocks_(network.particle_count()) {
  const AngleBends& bends = network_.angle_bends;
  for (Index element = 0; element < bends.count(); ++element) {
    if (acts(static_cast<std::size_t>(element))) bend_blocks_.add(network_, element, particles_of(bends, element));
  }
  assign_faces();
  for (Index hinge = 0; hinge < network_.hinges.count(); ++hinge) {
    if (faces_of_hinge_[hinge][0].face != kNone) hinge_blocks_.add(network_, hinge, network_.hinges.particles[hinge]);
  }
}

bool BendingAngleForce::acts(std::size_t element) const {
  return constants_.stiffness[element] > 0.0 || constants_.damping[element] > 0.0;
}

void BendingAngleForce::assign_faces() {
  faces_of_hinge_.resize(static_cast<std::size_t>(network_.hinges.count()));
  const FaceBends& faces = network_.face_bends;
  const auto any = [&](const std::vector<double>& constants) {
    const auto first = constants.begin() + static_cast<std::ptrdiff_t>(first_face_);
    return std::any_of(first, constants.end(), [](double constant) { return constant > 0.0; });
  };
  faces_resist_ = any(constants_.stiffness);
  faces_damp_ = any(constants_.damping);
  acting_faces_.assign(static_cast<std::size_t>(faces.count()), 0);
  for (Index face = 0; face < faces.count(); ++face) {
    const BendStencil stencil = stencil_of(faces, network_.hinges, face);
    if (std::ranges::all_of(stencil.particles, [&](Index i) { return network_.is_asleep(i); })) continue;
    if (!acts(first_face_ + static_cast<std::size_t>(face))) continue;
    acting_faces_[face] = 1;
    for (Index side = 0; side < 3; ++side) {
      const Index hinge = faces.hinges[face][static_cast<std::size_t>(side)];
      if (hinge == kNone) continue;
      std::array<FaceSide, 2>& of_hinge = faces_of_hinge_[hinge];
      of_hinge.at(of_hinge[0].face == kNone ? 0 : 1) = {face, side};
    }
  }
}

void BendingAngleForce::add(const Kinematics& at, Points& forces) const {
  add_bends(at, forces);
  if (network_.hinges.count() > 0) add_hinges(at, forces);
}

void BendingAngleForce::add_bends(const Kinematics& at, Points& forces) const {
  const AngleBends& bends = network_.angle_bends;
  bend_blocks_.for_each(forces, [&](Index element, const auto& add_to) {
    const auto [on_before, on_after] = bend_forces(bends, element, constants_.stiffness[element], constants_.damping[element], at);
    add_to(bends.before[element], on_before);
    add_to(bends.middle[element], -(on_before + on_after));
    add_to(bends.after[element], on_after);
  });
}

void BendingAngleForce::hold(const Points& positions) {
  held_.resize(static_cast<std::size_t>(network_.hinges.count()));
  measure_hinges(positions, held_.data());
}

void BendingAngleForce::measure_hinges(const Points& x, HingeShape* shapes) const {
  const Hinges& hinges = network_.hinges;
  parallel_chunks(hinges.count(), kHingesAtOnce, [&](Index begin, Index end) {
    for (Index hinge = begin; hinge < end; ++hinge) {
      if (faces_of_hinge_[hinge][0].face == kNone) continue;
      const HingeAngle angle(hinges, hinge, x);
      HingeShape& shape = shapes[hinge];
      shape = {.gradient = angle.gradient(), .deviation = faces_resist_ ? angle.deviation() : 0.0, .share = 1.0};
      if (faces_damp_) shape.share = share_of(shape.gradient, hinges.weights[hinge]);
    }
  });
}

void BendingAngleForce::add_hinges(const Kinematics& at, Points& forces) const {
  const Hinges& hinges = network_.hinges;
  const FaceBends& faces = network_.face_bends;
  std::unique_ptr<HingeShape[]> measured;  // NOLINT(*-c-arrays)
  const HingeShape* shapes = held_.data();
  if (held_.empty()) {
    measured = std::make_unique_for_overwrite<HingeShape[]>(static_cast<std::size_t>(hinges.count()));  // NOLINT(*-c-arrays)
    measure_hinges(at.x, measured.get());
    shapes = measured.get();
  }
  std::vector<double> rates_of_hinges(faces_damp_ ? static_cast<std::size_t>(hinges.count())
                                                  : 0);  // of deviations [1/s], times `share`
  parallel_chunks(static_cast<Index>(rates_of_hinges.size()), kHingesAtOnce, [&](Index begin, Index end) {
    for (Index hinge = begin; hinge < end; ++hinge) {
      if (faces_of_hinge_[hinge][0].face == kNone) continue;
      double rate = 0.0;
      for (std::size_t i = 0; i < 4; ++i) rate += shapes[hinge].gradient[i].dot(at.v.col(hinges.particles[hinge][i]));
      rates_of_hinges[hinge] = rate * shapes[hinge].share;
    }
  });
  // Of the sides of each face.
  std::vector<Vector3> moments(static_cast<std::size_t>(faces.count()), Vector3::Zero());
  parallel_chunks(faces.count(), kHingesAtOnce, [&](Index begin, Index end) {
    for (Index face = begin; face < end; ++face) {
      if (acting_faces_[face] == 0) continue;
      const std::size_t element = first_face_ + static_cast<std::size_t>(face);
      const Matrix3& curvature = faces.curvature[face];
      Vector3 deviations = Vector3::Zero();
      Vector3 rates = Vector3::Zero();
      Vector3 shares = Vector3::Zero();
      for (Index side = 0; side < 3; ++side) {
        const Index hinge = faces.hinges[face][static_cast<std::size_t>(side)];
        if (hinge == kNone) continue;
        deviations[side] = shapes[hinge].deviation;
        shares[side] = shapes[hinge].share;
        if (faces_damp_) rates[side] = rates_of_hinges[hinge];
      }
      Vector3& moment = moments[face];
      if (faces_resist_) moment = constants_.stiffness[element] * (curvature.transpose() * (curvature * deviations));
      if (!faces_damp_) continue;
      moment += constants_.damping[element] * shares.cwiseProduct(curvature.transpose() * (curvature * rates));
    }
  });
  hinge_blocks_.for_each(forces, [&](Index hinge, const auto& add_to) {
    double moment = 0.0;
    for (const auto& [face, side] : faces_of_hinge_[hinge]) {
      if (face != kNone) moment += moments[face][side];
    }
    const std::array<Vector3, 4>& gradient = shapes[hinge].gradient;
    for (std::size_t i = 0; i < 4; ++i) add_to(hinges.particles[hinge][i], -(moment * gradient[i]));
  });
}

void BendingAngleForce::couple(std::vector<ParticlePair>& pairs) const {
  for (Index element = 0; element < network_.angle_bends.count(); ++element) {
    const auto [before, middle, after] = particles_of(network_.angle_bends, element);
    for (const ParticlePair& pair : {ParticlePair{before, middle}, {middle, after}, {before, after}}) pairs.push_back(pair);
  }
  for (Index face = 0; face < network_.face_bends.count(); ++face) {
    const BendStencil stencil = stencil_of(network_.face_bends, network_.hinges, face);
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (stencil.particles[i] != stencil.particles[j]) pairs.push_back({stencil.particles[j], stencil.particles[i]});
      }
    }
  }
}

void BendingAngleForce::add_derivatives(const Kinematics& at, ForceDerivatives& derivatives) const {
  const AngleBends& bends = network_.angle_bends;
  for (Index element = 0; element < bends.count(); ++element) {
    const Bend bend(bends, element, at.x);
    const std::array<Index, 3> particles = particles_of(bends, element);
    const double stiffness = constants_.stiffness[element] * bend.fullness();
    const double damping = constants_.damping[element];
    if (!(stiffness > 0.0) && !(damping > 0.0)) continue;
    const double per_a = 1.0 / bend.a.norm();
    const double per_b = 1.0 / bend.b.norm();
    if (!std::isfinite(per_a) || !std::isfinite(per_b)) continue;
    const std::array<double, 3> across{per_a, -per_a - per_b, per_b};
    if (bend.sine > 0.0) {
      const Vector3 normal = bend.normal / bend.sine;
      const double half = 0.5 * bend.angle();
      add_products(particles, turns(bend), stiffness, derivatives.by_position);
      add_products(particles, across, (stiffness * half / std::tan(half)) * normal * normal.transpose(), derivatives.by_position);
      add_products(particles, turns(bend), damping * bend.fullness(), derivatives.by_velocity);
    } else if (bend.angle() == 0.0) {
      const Vector3 along = per_a * bend.a;
      add_products(particles, across, stiffness * (Matrix3::Identity() - along * along.transpose()), derivatives.by_position);
    }
  }
  for (Index face = 0; face < network_.face_bends.count(); ++face) add_face_derivatives(face, at.x, derivatives);
}

void BendingAngleForce::add_face_derivatives(Index face, const Points& x, ForceDerivatives& derivatives) const {
  const std::size_t element = first_face_ + static_cast<std::size_t>(face);
  if (!acts(element)) return;
  const FaceBends& faces = network_.face_bends;
  const BendStencil stencil = stencil_of(faces, network_.hinges, face);
  std::array<std::array<Vector3, 6>, 3> gradients;  // of the rows of F phi
  for (auto& row : gradients) row.fill(Vector3::Zero());
  for (std::size_t side = 0; side < 3; ++side) {
    const Index hinge = faces.hinges[face][side];
    if (hinge == kNone) continue;
    const std::array<Vector3, 4> gradient = HingeAngle(network_.hinges, hinge, x).gradient();
    for (std::size_t row = 0; row < 3; ++row) {
      const double factor = faces.curvature[face](static_cast<Index>(row), static_cast<Index>(side));
      for (std::size_t i = 0; i < 4; ++i) gradients[row][stencil.of_hinges[side][i]] += factor * gradient[i];
    }
  }
  for (const auto& row : gradients) {
    add_products(stencil.particles, row, constants_.stiffness[element], derivatives.by_position);
    add_products(stencil.particles, row, constants_.damping[element], derivatives.by_velocity);
  }
}

void BendingAngleForce::append_elements(std::vector<LinearElement>& elements) const {
  const AngleBends& bends = network_.angle_bends;
  std::vector<bool> of_material(constants_.stiffness.size(), false);
  for_material_bends(network_, [&](Index e) { of_material[e] = true; });
  for (Index e = 0; e < bends.count(); ++e) {
    const double before = 1.0 / bends.length_before[e];
    const double after = 1.0 / bends.length_after[e];
    const std::array<double, 3> weights{before, -(before + after), after};
    elements.push_back(LinearElement::of(particles_of(bends, e), weights, constants_.stiffness[e], constants_.damping[e]));
    elements.back().of_material = of_material[e];
  }
  for (Index face = 0; face < network_.face_bends.count(); ++face) {
    const std::size_t e = first_face_ + static_cast<std::size_t>(face);
    const BendStencil stencil = stencil_of(network_.face_bends, network_.hinges, face);
    for (const std::array<double, 6>& weights : weights_of(network_.face_bends, network_.hinges, face)) {
      elements.push_back(LinearElement::of(stencil.particles, weights, constants_.stiffness[e], constants_.damping[e]));
      elements.back().of_material = of_material[e];
    }
  }
}

double BendingAngleForce::capacity() const {
  constexpr double kHalfTurnSquared = std::numbers::pi * std::numbers::pi;
  double energy = 0.0;
  for (std::size_t e = 0; e < first_face_; ++e) energy += 0.5 * constants_.stiffness[e] * kHalfTurnSquared;
  for (Index face = 0; face < network_.face_bends.count(); ++face) {
    const double stiffness = constants_.stiffness[first_face_ + static_cast<std::size_t>(face)];
    // |F phi|^2 <= |F|^2 |phi|^2, and a triangle has three angles of at most pi.
    energy += 0.5 * stiffness * 3.0 * network_.face_bends.curvature[face].squaredNorm() * kHalfTurnSquared;
  }
  return energy;
}

double BendingAngleForce::energy(const Points& positions) const {
  const AngleBends& bends = network_.angle_bends;
  double energy = 0.0;
  for (Index element = 0; element < bends.count(); ++element) {
    energy += Bend(bends, element, positions).energy(constants_.stiffness[element]);
  }
  const FaceBends& faces = network_.face_bends;
  for (Index face = 0; face < faces.count(); ++face) {
    Vector3 deviations = Vector3::Zero();
    for (std::size_t side = 0; side < 3; ++side) {
      const Index hinge = faces.hinges[face][side];
      if (hinge != kNone) deviations[static_cast<Index>(side)] = HingeAngle(network_.hinges, hinge, positions).deviation();
    }
    const double stiffness = constants_.stiffness[first_face_ + static_cast<std::size_t>(face)];
    energy += 0.5 * stiffness * (faces.curvature[face] * deviations).squaredNorm();
  }
  return energy;
}

}  // namespace sprung
