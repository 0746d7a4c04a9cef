// A textbook network of objects and pointers, as in the manual and the OpenGL page. SpringForce and StretchLimit are compared with
// it.
#pragma once

#include "network/model/spring_network.h"

#include <algorithm>
#include <memory>
#include <vector>

namespace sprung::textbook {

class Mass {
 public:
  double mass = 0.0;
  bool pinned = false;
  Vector3 position;
  Vector3 velocity;
  Vector3 force = Vector3::Zero();
};

class Spring {
 public:
  Spring(Mass* a, Mass* b, double stiffness, double rest_length, double damping)
      : a_(a), b_(b), stiffness_(stiffness), rest_length_(rest_length), damping_(damping) {}

  void solve() {
    const Vector3 s = a_->position - b_->position;
    const double length = s.norm();
    if (length == 0.0) return;
    const Vector3 e = s / length;
    const double elastic = -stiffness_ * (length - rest_length_);
    const double damped = -damping_ * e.dot(a_->velocity - b_->velocity);
    const Vector3 force = (elastic + damped) * e;
    a_->force += force;
    b_->force -= force;
  }

  void project(double max_stretch, double max_compression) {
    const Vector3 s = a_->position - b_->position;
    const double length = s.norm();
    const double allowed = std::clamp(length, rest_length_ * (1.0 - max_compression), rest_length_ * (1.0 + max_stretch));
    const double inverse_a = a_->pinned ? 0.0 : 1.0 / a_->mass;
    const double inverse_b = b_->pinned ? 0.0 : 1.0 / b_->mass;
    if (length == allowed || inverse_a + inverse_b == 0.0) return;
    const Vector3 correction = (length - allowed) / (length * (inverse_a + inverse_b)) * s;
    a_->position -= inverse_a * correction;
    b_->position += inverse_b * correction;
  }

 private:
  Mass* a_;
  Mass* b_;
  double stiffness_;
  double rest_length_;
  double damping_;
};

/// The masses and springs of a network, in the order in which the loops over a cloth create them: by their first particle.
class Network {
 public:
  explicit Network(const SpringNetwork& network) {
    for (Index i = 0; i < network.particle_count(); ++i) {
      masses.push_back(std::make_unique<Mass>());
      masses.back()->mass = network.masses[i];
      masses.back()->pinned = network.is_fixed(i);
      masses.back()->position = network.positions.col(i);
      masses.back()->velocity = network.velocities.col(i);
    }
    const Springs& from = network.springs;
    std::vector<Index> order(from.first.size());
    for (Index s = 0; s < from.count(); ++s) order[s] = s;
    std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return from.first[a] < from.first[b]; });
    for (const Index s : order) {
      Mass* a = masses[from.first[s]].get();
      Mass* b = masses[from.second[s]].get();
      springs.push_back(std::make_unique<Spring>(a, b, from.stiffness[s], from.rest_length[s], from.damping[s]));
      if (from.kind[s] == SpringKind::structural) structural.push_back(springs.back().get());
    }
  }

  void add_spring_forces() {
    for (const auto& mass : masses) mass->force.setZero();
    for (const auto& spring : springs) spring->solve();
  }

  void project(double max_stretch, double max_compression) {
    for (Spring* spring : structural) spring->project(max_stretch, max_compression);
  }

  std::vector<std::unique_ptr<Mass>> masses;
  std::vector<std::unique_ptr<Spring>> springs;
  std::vector<Spring*> structural;
};

}  // namespace sprung::textbook
