// The directions in which contact constrains particles.
#pragma once

#include "base/types.h"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace sprung {

/// An obstacle or an element that pushes.
struct Support {
  Vector3 normal = Vector3::Zero();
  Vector3 displacement = Vector3::Zero();  ///< in the step, of the point to which static friction ties the particle [m]
  double static_friction = 0.0;
  double friction = 0.0;
  double weight = 1.0;  ///< of this support in the mean of merged supports
};

/// Two elements of the network that push each other. Their distance is a weighted sum of particles, as in Contact.
struct ElementContact {
  static constexpr std::size_t kMostParticles = 4;

  std::array<Index, kMostParticles> particles{};  ///< the first `count` are used, all different
  std::array<double, kMostParticles> weights{};
  std::size_t count = 0;
  double mass = 0.0;               ///< of the sum: its velocity changes by an impulse divided by this mass [kg]
  Vector3 push = Vector3::Zero();  ///< displacement of the sum by contact and friction [m]
  Support support{};

  /// The weighted sum of the particles' columns of q.
  [[nodiscard]] Vector3 sum(const Points& q) const {
    Vector3 result = Vector3::Zero();
    for (std::size_t k = 0; k < count; ++k) result += weights[k] * q.col(particles[k]);
    return result;
  }
};

class ConstrainedDirections {
 public:
  /// Removes all constraints, for this number of particles.
  void clear(Index particles) {
    constraints_.assign(static_cast<std::size_t>(particles), {});
    element_contacts_.clear();
    support_count_ = 0;
  }

  /// The number of different supports of all particles, and of contacts between elements.
  [[nodiscard]] std::size_t contact_count() const { return support_count_ + element_contacts_.size(); }

  /// Constrains a particle along `direction`, of any length. A direction within 30 degrees of those already constrained is
  /// ignored: several contacts with a round surface would otherwise fix the particle. Returns whether it was not.
  bool add(Index particle, const Vector3& direction) {
    constexpr double kAnother = 0.5;  // sine of 30 degrees
    Matrix3& constrained = constraints_[static_cast<std::size_t>(particle)].projection;
    const Vector3 another = direction - constrained * direction;
    if (!(another.norm() > kAnother * direction.norm())) return false;
    constrained += another.normalized() * another.normalized().transpose();
    return true;
  }

  /// Constrains a particle along the support's normal. Supports within 30 degrees of each other count as one: the corners of two
  /// segments on a round surface would otherwise lean on one of them alone. Add all supports before other directions.
  void add(Index particle, const Support& support) {
    Constraint& constraint = constraints_[static_cast<std::size_t>(particle)];
    if (constraint.count < constraint.supports.size() && add(particle, support.normal)) {
      constraint.supports[constraint.count++] = support;
      ++support_count_;
      return;
    }
    constexpr double kSame = 0.866;  // cosine of 30 degrees
    for (std::size_t k = 0; k < constraint.count; ++k) {
      Support& former = constraint.supports[k];
      if (former.normal.dot(support.normal) > kSame) return merge(support, former, particle);
    }
  }

  /// Constrains the distance of two elements.
  void add(const ElementContact& contact) { element_contacts_.push_back(contact); }

  /// The projection onto the constrained directions of a particle.
  [[nodiscard]] const Matrix3& projection(Index particle) const {
    return constraints_[static_cast<std::size_t>(particle)].projection;
  }

  /// The obstacles that push a particle: at most three, whose normals differ by more than 30 degrees.
  [[nodiscard]] std::span<const Support> supports(Index particle) const {
    const Constraint& constraint = constraints_[static_cast<std::size_t>(particle)];
    return {constraint.supports.data(), constraint.count};
  }

  [[nodiscard]] const std::vector<ElementContact>& element_contacts() const { return element_contacts_; }

 private:
  struct Constraint {
    Matrix3 projection = Matrix3::Zero();
    std::array<Support, 3> supports{};
    std::size_t count = 0;
  };

  void merge(const Support& other, Support& support, Index particle) {
    const double share = other.weight / (support.weight + other.weight);
    support.normal = (support.normal + share * (other.normal - support.normal)).normalized();
    support.displacement += share * (other.displacement - support.displacement);
    support.static_friction += share * (other.static_friction - support.static_friction);
    support.friction += share * (other.friction - support.friction);
    support.weight += other.weight;
    Constraint& constraint = constraints_[static_cast<std::size_t>(particle)];
    constraint.projection.setZero();
    for (std::size_t k = 0; k < constraint.count; ++k) add(particle, constraint.supports[k].normal);
  }

  std::vector<Constraint> constraints_;
  std::vector<ElementContact> element_contacts_;
  std::size_t support_count_ = 0;
};

}  // namespace sprung
