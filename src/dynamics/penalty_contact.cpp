#include "dynamics/penalty_contact.h"

#include "dynamics/contact_pair.h"

#include <algorithm>

namespace sprung {

PenaltyContact::PenaltyContact(const SpringNetwork& network, Environment& environment, double stiffness, double damping, double dt)
    : network_(network),
      environment_(environment),
      stiffness_(stiffness),
      damping_(damping),
      dt_(dt),
      thickness_(particle_thickness(network)) {}

void PenaltyContact::prepare(double time) {
  const Environment::Interval interval = environment_.interval();
  if (interval.begin != time || interval.end != time) environment_.set_interval(time, time);
}

void PenaltyContact::add(const Kinematics& at, Points& forces) const {
  for (const Contact& contact : environment_.contacts({at.x, at.x, thickness_})) {
    const Index i = contact.particles[0];
    const Obstacle& obstacle = environment_.obstacles()[static_cast<std::size_t>(contact.obstacle)];
    const ContactMaterial pair = combine(network_.body_of(i).material, obstacle.material);
    const Vector3 relative = at.v.col(i) - environment_.surface_velocity(contact.obstacle, at.x.col(i), at.time, dt_);
    const double speed = contact.normal.dot(relative);
    const double push = std::max(0.0, stiffness_ * (pair.thickness - contact.distance) - damping_ * speed);
    forces.col(i) += push * contact.normal;

    const Vector3 along = relative - speed * contact.normal;
    const double slip = along.norm();
    if (slip == 0.0) continue;
    const double stopping = network_.masses[i] * slip / dt_;
    forces.col(i) -= std::min(pair.friction * push, stopping) / slip * along;
  }
}

Index PenaltyContact::contact_count(const Points& positions) const {
  Index count = 0;
  Index last = kNone;  // contacts are sorted by particle
  for (const Contact& contact : environment_.contacts({positions, positions, thickness_})) {
    if (contact.particles[0] != last) ++count;
    last = contact.particles[0];
  }
  return count;
}

}  // namespace sprung
