#include "dynamics/contact_projection.h"

#include "dynamics/contact_pair.h"

#include <algorithm>
#include <cmath>

namespace sprung {
namespace {

// Contacts are looked for this part of the thickness beyond the gap: the passes of a step move resting particles less.
constexpr double kMargin = 0.5;

// A particle touches when it is this close to its gap: what rounding leaves of a projection onto it.
constexpr double kTouch = 1.0 + 1.0e-9;

double largest_thickness(const std::vector<Obstacle>& obstacles) {
  double largest = 0.0;
  for (const Obstacle& obstacle : obstacles) largest = std::max(largest, obstacle.material.thickness);
  return largest;
}

// What friction takes from a motion along the surface, for a `push` along the normal: displacements or velocities alike.
Vector3 slip_taken(const ContactMaterial& pair, const Vector3& slip, double push) {
  const double length = slip.norm();
  if (push <= 0.0 || length <= pair.static_friction * push) return push <= 0.0 ? Vector3::Zero() : slip;
  return std::min(pair.friction * push / length, 1.0) * slip;
}

// An approach slower than this many times what the forces add in one step is rest, not an impact.
constexpr double kRestSteps = 2.0;

}  // namespace

ContactProjection::ContactProjection(const SpringNetwork& network, const Environment& environment)
    : network_(network),
      environment_(environment),
      thickness_(particle_thickness(network)),
      margin_(kMargin * (thickness_.maxCoeff() + largest_thickness(environment.obstacles()))),
      pinned_(static_cast<std::size_t>(network.particle_count())) {
  for (Index i = 0; i < network.particle_count(); ++i) pinned_[static_cast<std::size_t>(i)] = network.is_pinned(i) ? 1 : 0;
}

void ContactProjection::find(const Points& before, const Points& v_before, const SimulationState& advanced, double dt) {
  dt_ = dt;
  active_.clear();
  for (const Contact& contact : environment_.contacts({before, advanced.x, thickness_, margin_})) {
    const Index i = contact.particles[0];
    if (pinned_[static_cast<std::size_t>(i)] != 0) continue;
    const Obstacle& obstacle = environment_.obstacles()[static_cast<std::size_t>(contact.obstacle)];
    Active active{.contact = contact, .pair = combine(network_.body_of(i).material, obstacle.material)};
    active.gap = std::max(active.pair.thickness, contact.clearance);
    const RigidTransform& end = environment_.pose_after(contact.obstacle);
    active.carried = obstacle.motion.moves() ? Vector3(end * (environment_.pose_before(contact.obstacle).inverse() * before.col(i)))
                                             : Vector3(before.col(i));
    active.surface_velocity = (active.carried - before.col(i)) / dt;
    active.approach = contact.normal.dot(active.surface_velocity - v_before.col(i));
    active.leaving = contact.normal.dot(advanced.v.col(i) - active.surface_velocity);
    active_.push_back(active);
  }
}

// The push is a Lagrange multiplier in the sense of sequential impulses: what another constraint makes needless is taken back, but
// never more than was given.
double ContactProjection::project(Points& positions) {
  double largest = 0.0;
  for (Active& active : active_) {
    const Contact& contact = active.contact;
    auto position = positions.col(contact.particles[0]);
    const double depth = active.gap - contact.normal.dot(position - contact.point);
    const double change = std::max(depth, -active.push);
    position += change * contact.normal;
    active.push += change;
    largest = std::max(largest, std::abs(change) / active.gap);
    if (active.push > 0.0) rub(active, position);
  }
  return largest;
}

void ContactProjection::rub(Active& active, Eigen::Ref<Vector3> position) const {
  const Vector3& normal = active.contact.normal;
  const Vector3 moved = position - active.carried;
  const Vector3 along = moved - normal.dot(moved) * normal;
  const double length = along.norm();
  if (length == 0.0) return;
  const double hold = active.pair.static_friction * active.push - active.held;
  const double slow = active.pair.friction * active.push - active.held;
  const double taken = length <= hold ? length : std::clamp(slow, 0.0, length);
  if (taken == 0.0) return;
  position -= (taken / length) * along;
  active.held += taken;
}

void ContactProjection::truncate(const Points& before, Points& positions) {
  squeezed_ = 0;
  truncated_ = static_cast<Index>(environment_.truncate(before, positions, pinned_, squeezed_).size());
}

void ContactProjection::settle_velocities(SimulationState& state, const Integrator& integrator) const {
  for (const Active& active : active_) {
    const Contact& contact = active.contact;
    const double distance = contact.normal.dot(state.x.col(contact.particles[0]) - contact.point);
    if (active.push == 0.0 && distance > kTouch * active.gap) continue;
    auto velocity = state.v.col(contact.particles[0]);
    const Vector3 relative = velocity - active.surface_velocity;
    const double speed = contact.normal.dot(relative);
    const double change = settled_speed(active, speed) - speed;
    if (change == 0.0) continue;
    velocity += change * contact.normal - slip_taken(active.pair, relative - speed * contact.normal, change);
    integrator.velocity_changed(state, contact.particles[0], dt_);
  }
}

double ContactProjection::settled_speed(const Active& active, double speed) const {
  const double made_by_forces = std::abs(active.leaving + active.approach);
  const bool impact = active.approach > kRestSteps * made_by_forces;
  const double bounce = impact ? active.pair.restitution * active.approach : 0.0;
  return std::clamp(speed, bounce, std::max(bounce, active.leaving));
}

Index ContactProjection::contact_count() const {
  Index count = 0;
  Index last = kNone;  // contacts are sorted by particle
  for (const Active& active : active_) {
    if (active.push == 0.0 || active.contact.particles[0] == last) continue;
    last = active.contact.particles[0];
    ++count;
  }
  return count;
}

}  // namespace sprung
