#include "dynamics/contact_response.h"

#include <algorithm>

namespace sprung {
namespace {

// Impulses of contacts that share particles, or stand on each other, settle within a few passes; what is left the next step finds.
constexpr int kVelocityPasses = 8;

// Passes end when none changes a velocity by more than this part of what the first one did.
constexpr double kVelocityTolerance = 1.0e-3;

template <class Sets, class Visit>
void for_each_set(Sets& sets, const Visit& visit) {
  std::apply([&](auto&... set) { (visit(set), ...); }, sets);
}

/// The contact's particles, weights and shares; none when all of them are pinned.
template <std::size_t n>
bool set_particles(const Contact& contact, const Scalars& inverse_masses, ContactRow<n>& row) {
  double mobility = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    row.particles[k] = contact.particles[k];
    row.weights[k] = contact.weights[k];
    row.shares[k] = contact.weights[k] * inverse_masses[contact.particles[k]];
    mobility += contact.weights[k] * row.shares[k];
  }
  if (mobility == 0.0) return false;
  for (double& share : row.shares) share /= mobility;
  return true;
}

}  // namespace

ContactResponse::ContactResponse(const SpringNetwork& network, const Environment& environment)
    : network_(network), environment_(environment), materials_(network, environment.obstacles()) {}

void ContactResponse::start(const std::vector<Contact>& contacts, const StepMotion& motion) {
  dt_ = motion.dt;
  carry_.clear();
  for (std::size_t k = 0; k < environment_.obstacles().size(); ++k) {
    const auto obstacle = static_cast<Index>(k);
    carry_.push_back(environment_.pose_after(obstacle) * environment_.pose_before(obstacle).inverse());
  }
  for_each_set(sets_, [](auto& set) { set.clear(); });
  for (const Contact& contact : contacts) {
    switch (contact.count) {
      case 1:
        add<1>(contact, motion);
        break;
      case 2:
        add<2>(contact, motion);
        break;
      case 3:
        add<3>(contact, motion);
        break;
      default:
        add<4>(contact, motion);
    }
  }
}

template <std::size_t n>
void ContactResponse::add(const Contact& contact, const StepMotion& motion) {
  ContactRow<n> row;
  if (!set_particles(contact, network_.inverse_masses, row)) return;
  const ContactMaterial& pair = materials_.of(contact);
  const double gap = std::max(pair.thickness, contact.clearance);
  const Vector3 from = row.sum(motion.before);
  row.normal = contact.normal;
  row.origin = carried(contact, from);
  row.least = gap - contact.normal.dot(row.origin - contact.point);
  row.static_friction = pair.static_friction;
  row.friction = pair.friction;

  const Vector3 carrier = (row.origin - from) / motion.dt;
  const FreeFlight flight{.height = -row.least,
                          .moved = row.normal.dot(row.sum(motion.advanced.x) - row.origin),
                          .v_before = row.normal.dot(row.sum(motion.v_before) - carrier),
                          .v_after = row.normal.dot(row.sum(motion.advanced.v) - carrier),
                          .dt = motion.dt};
  std::get<ContactSet<n>>(sets_).add(row, gap, {carrier, settled_speeds(flight, pair.restitution)});
}

// An obstacle that rests, and what another element is relative to, carries a position to the last bit where it was.
Vector3 ContactResponse::carried(const Contact& contact, const Vector3& from) const {
  if (contact.obstacle == kNone) return from;
  const auto k = static_cast<std::size_t>(contact.obstacle);
  if (!environment_.obstacles()[k].motion.moves()) return from + contact.drift;
  return carry_[k] * from + contact.drift;
}

double ContactResponse::project(Points& positions) {
  double largest = 0.0;
  for_each_set(sets_, [&](auto& set) { largest = std::max(largest, set.project(positions)); });
  return largest;
}

void ContactResponse::settle_velocities(SimulationState& state, const Integrator& integrator) {
  for_each_set(sets_, [&](auto& set) { set.begin_settling(state.x, state.v); });
  double first = 0.0;
  for (int pass = 0; pass < kVelocityPasses; ++pass) {
    double largest = 0.0;
    for_each_set(sets_, [&](auto& set) { largest = std::max(largest, set.settle(state.v)); });
    if (pass == 0) first = largest;
    if (largest <= kVelocityTolerance * first) break;
  }
  for_each_set(sets_,
               [&](auto& set) { set.for_touching([&](Index particle) { integrator.velocity_changed(state, particle, dt_); }); });
}

Index ContactResponse::pushed_count() const {
  std::vector<Index> pushed;
  for_each_set(sets_, [&](const auto& set) { set.for_pushed([&](Index particle) { pushed.push_back(particle); }); });
  std::sort(pushed.begin(), pushed.end());
  return static_cast<Index>(std::unique(pushed.begin(), pushed.end()) - pushed.begin());
}

}  // namespace sprung
