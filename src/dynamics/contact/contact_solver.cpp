#include "dynamics/contact/contact_solver.h"

#include "base/parallel.h"
#include "base/sort_unique.h"
#include "dynamics/state/recorded_impulses.h"
#include "dynamics/state/simulation_state.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

namespace sprung {
namespace {

// Impulses of contacts that share particles or are stacked settle within a few passes; the next step finds the rest.
constexpr int kVelocityPasses = 8;

// Passes end when none changes a velocity by more than this fraction of the first pass's change.
constexpr double kVelocityTolerance = 1.0e-3;

// A touching contact is above its gap by at most this fraction of it: rounding of the projection.
constexpr double kTouch = 1.0e-9;

// `least` of contacts that are left to pins.
constexpr double kNothingToDo = -std::numeric_limits<double>::infinity();

// A contact is left to pins if they have more than this fraction of its weights, and if they violate the contact themselves or the
// other side is an element.
constexpr double kMostPinned = 0.9;

// A contact that begins inside its gap, as truncation or the stretch limit left it, leaves it with the acceleration that takes
// this time for the whole gap [s]. If it left in one short step, springs at their limit would be pulled along, no contact would
// slow them, and they would gain more energy the shorter the step.
constexpr double kRecovery = 0x1p-9;

// Contacts per parallel task.
constexpr Index kContactChunk = 256;

template <class Sets, class Visit>
void for_each_set(Sets& sets, const Visit& visit) {
  std::apply([&](auto&... set) { (visit(set), ...); }, sets);
}

/// Sets the contact's particles, weights and shares. Returns false if all weight is on pins, or nearly all between two elements.
template <std::size_t n>
bool set_particles(const Contact& contact, const Scalars& inverse_masses, ContactConstraint<n>& row) {
  double mobility = 0.0;
  double pinned = 0.0;
  double total = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    row.particles[k] = contact.particles[k];
    row.weights[k] = contact.weights[k];
    row.shares[k] = contact.weights[k] * inverse_masses[contact.particles[k]];
    mobility += contact.weights[k] * row.shares[k];
    total += std::abs(row.weights[k]);
    if (inverse_masses[row.particles[k]] == 0.0) pinned += std::abs(row.weights[k]);
  }
  if (mobility == 0.0 || (contact.obstacle == kNone && pinned > kMostPinned * total)) {
    row.shares.fill(0.0);
    return false;
  }
  for (double& share : row.shares) share /= mobility;
  return true;
}

/// By which the contact moved its sum [m].
template <std::size_t n>
Vector3 displacement_by(const ContactConstraint<n>& row, const ContactGoal& goal) {
  return goal.push * row.normal + goal.friction_change;
}

/// How an element before an obstacle turns about its pins.
struct Lever {
  double arm = std::numeric_limits<double>::infinity();  ///< lever arm of the contact's point [m]: a displacement of this length
                                                         ///< turns it by a radian
  double share = 1.0;                                    ///< displacement of the point relative to that of the free corners
};

template <std::size_t n>
Lever lever(const ContactConstraint<n>& row, const Points& positions) {
  Vector3 at_pins = Vector3::Zero();
  Vector3 at_others = Vector3::Zero();
  double pinned = 0.0;
  double others = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    const bool is_pinned = row.shares[k] == 0.0;
    (is_pinned ? at_pins : at_others) += row.weights[k] * positions.col(row.particles[k]);
    (is_pinned ? pinned : others) += row.weights[k];
  }
  if (pinned == 0.0) return {};
  return {others * (at_others / others - at_pins / pinned).norm(), others};
}

}  // namespace

ContactSolver::ContactSolver(const SpringNetwork& network, const ObstacleSet& obstacles)
    : network_(network),
      obstacles_(obstacles),
      materials_(network, obstacles.obstacles()),
      first_row_(static_cast<std::size_t>(network.particle_count()), kNone) {}

void ContactSolver::start(const ObstacleFrame& frame, const std::vector<Contact>& contacts, const StepMotion& motion) {
  obstacle_motions_.clear();
  for (Index k = 0; k < static_cast<Index>(obstacles_.obstacles().size()); ++k) {
    obstacle_motions_.push_back(frame.after(k) * frame.into_before(k));
  }
  for_each_set(sets_, [&](auto& set) { fill(set, 0, contacts, motion); });
}

void ContactSolver::renew(const FreshContacts& fresh, const StepMotion& motion) {
  for_each_set(sets_, [&](auto& set) {
    auto& former = std::get<std::remove_reference_t<decltype(set)>>(former_sets_);
    set.take_out(fresh.patches, former);
    const std::size_t kept = set.count();
    fill(set, kept, fresh.contacts, motion);
    set.warm_start(former, kept, first_row_);
  });
}

void ContactSolver::add(const std::vector<Contact>& contacts, const StepMotion& motion) {
  for_each_set(sets_, [&](auto& set) { fill(set, set.count(), contacts, motion); });
}

template <std::size_t n>
void ContactSolver::fill(ContactConstraintSet<n>& set, std::size_t first, const std::vector<Contact>& contacts,
                         const StepMotion& motion) {
  order_.clear();
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    if (static_cast<std::size_t>(contacts[c].count) == n) order_.push_back(static_cast<Index>(c));
  }
  set.resize(first + order_.size());
  parallel_chunks(static_cast<Index>(order_.size()), kContactChunk, [&](Index begin, Index end) {
    ContactMaterials::Last last;
    for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k) {
      const Contact& contact = contacts[static_cast<std::size_t>(order_[k])];
      fill_one(contact, materials_.of(contact, last), motion, set, first + k);
    }
  });
}

template <std::size_t n>
void ContactSolver::fill_one(const Contact& contact, const ContactMaterial& pair, const StepMotion& motion,
                             ContactConstraintSet<n>& set, std::size_t slot) {
  ContactConstraint<n>& row = set.row(slot);
  const bool moves = set_particles(contact, network_.inverse_masses, row);
  row.obstacle = contact.obstacle;
  row.patch = contact.patch;
  row.normal = contact.normal;
  row.static_friction = pair.static_friction;
  row.friction = pair.friction;
  row.restitution = pair.restitution;

  const double gap = std::max(std::min(pair.thickness, contact.most_gap), contact.clearance);
  set.gap(slot) = gap;
  ContactGoal& goal = set.goal(slot);
  goal = {.origin = moved_with_obstacle(contact, row.sum(motion.before)), .touch = kTouch * gap};
  const double recovery = std::min(1.0, (motion.dt / kRecovery) * (motion.dt / kRecovery));
  const double back = gap - contact.normal.dot(goal.origin - contact.point);
  if (contact.obstacle != kNone && row.static_friction > 0.0) {
    const Vector3 slip = row.sum_if(motion.slip_before.displacement, [&](Index i) {
      return motion.slip_before.obstacle[static_cast<std::size_t>(i)] == contact.obstacle;
    });
    goal.slip_before = across(row.normal, rotated_with_obstacle(contact.obstacle, slip));
  }
  goal.least = moves ? std::min(back, std::max(back - gap, 0.0) + recovery * gap) : kNothingToDo;
  if (!moves || contact.obstacle == kNone) return;
  const auto [arm, share] = lever(row, motion.before);
  const bool pins_block = arm <= gap && share < 1.0 - kMostPinned;
  const double advanced = contact.normal.dot(row.sum(motion.advanced) - goal.origin);
  goal.least = pins_block ? kNothingToDo : std::min(goal.least, advanced + arm);
}

// Exactly `from` for an obstacle at rest, and between elements.
Vector3 ContactSolver::moved_with_obstacle(const Contact& contact, const Vector3& from) const {
  if (contact.obstacle == kNone) return from;
  if (!obstacles_.obstacle(contact.obstacle).motion.moves()) return from + contact.drift;
  return obstacle_motions_[static_cast<std::size_t>(contact.obstacle)] * from + contact.drift;
}

Vector3 ContactSolver::rotated_with_obstacle(Index obstacle, const Vector3& direction) const {
  if (!obstacles_.obstacle(obstacle).motion.moves()) return direction;
  return obstacle_motions_[static_cast<std::size_t>(obstacle)].linear() * direction;
}

double ContactSolver::project(Points& positions) {
  double largest = 0.0;
  for_each_set(sets_, [&](auto& set) { largest = std::max(largest, set.project(positions)); });
  return largest;
}

void ContactSolver::settle_velocities(const StepMotion& motion, SimulationState& state, const Integrator& integrator) {
  for_each_set(sets_, [&](auto& set) { set.begin_settling(motion, state.x, state.v); });
  double first = 0.0;
  for (int pass = 0; pass < kVelocityPasses; ++pass) {
    double largest = 0.0;
    for_each_set(sets_, [&](auto& set) { largest = std::max(largest, set.settle(state.v)); });
    if (pass == 0) first = largest;
    if (largest <= kVelocityTolerance * first) break;
  }
  for_each_set(sets_, [&](auto& set) {
    set.for_touching([&](Index particle, const auto&) { integrator.velocity_changed(state, particle, motion.dt); });
  });
}

void ContactSolver::note_slip(const StepMotion& motion, SimulationState& state) const {
  std::vector<double> largest_bound(static_cast<std::size_t>(state.x.cols()), 0.0);
  state.contact.slip.displacement.setZero();
  std::ranges::fill(state.contact.slip.obstacle, kNone);
  for_each_set(sets_, [&](const auto& set) {
    set.for_pushed([&](Index particle, const auto& row, const ContactGoal& goal) {
      const auto i = static_cast<std::size_t>(particle);
      const double bound = row.friction * goal.push;
      if (row.obstacle == kNone || !(bound > largest_bound[i])) return;
      largest_bound[i] = bound;
      Vector3 stuck = motion.before.col(particle);
      if (motion.slip_before.obstacle[i] == row.obstacle) stuck -= motion.slip_before.displacement.col(particle);
      const Vector3 moved = goal.origin + rotated_with_obstacle(row.obstacle, stuck - row.sum(motion.before));
      const Vector3 slip = across(row.normal, state.x.col(particle) - moved);
      const double length = slip.norm();
      state.contact.slip.displacement.col(particle) = length > bound ? bound / length * slip : slip;
      state.contact.slip.obstacle[i] = row.obstacle;
    });
  });
}

void ContactSolver::constrain_pushed(const StepMotion& motion, ConstrainedDirections& constrained) const {
  for_each_set(sets_, [&](const auto& set) {
    set.for_pushing([&](const auto& row, const ContactGoal& goal) {
      if (row.obstacle == kNone) {
        constrained.add(element_contact(row, goal));
        return;
      }
      Support support{.normal = row.normal,
                      .displacement = goal.origin - kReturn * goal.slip_before - row.sum(motion.before),
                      .static_friction = row.static_friction,
                      .friction = row.friction};
      for (std::size_t k = 0; k < row.particles.size(); ++k) {
        if (row.shares[k] == 0.0) continue;
        support.weight = row.weights[k] * goal.push;
        constrained.add(row.particles[k], support);
      }
    });
  });
}

template <std::size_t n>
ElementContact ContactSolver::element_contact(const ContactConstraint<n>& row, const ContactGoal& goal) const {
  ElementContact contact{.count = n,
                         .push = displacement_by(row, goal),
                         .support = {.normal = row.normal, .static_friction = row.static_friction, .friction = row.friction}};
  std::copy(row.particles.begin(), row.particles.end(), contact.particles.begin());
  std::copy(row.weights.begin(), row.weights.end(), contact.weights.begin());
  double mobility = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    mobility += row.weights[k] * row.weights[k] * network_.inverse_masses[row.particles[k]];
  }
  contact.mass = 1.0 / mobility;
  return contact;
}

void ContactSolver::record(const StepMotion& motion, const ImpulseRecorder& recorder) const {
  const auto add = [&](Index particle, const Vector3& momentum) {
    if (network_.is_fixed(particle)) recorder.add_to_pinned(particle, momentum);
  };
  for_each_set(sets_, [&](const auto& set) {
    set.for_pushing([&](const auto& row, const ContactGoal& goal) { for_shares(row, displacement_by(row, goal), add); });
    set.for_settled([&](const auto& row, const Vector3& change) { for_shares(row, motion.dt * change, add); });
  });
}

void ContactSolver::add_pushes(const StepMotion& motion, Points& impulses) const {
  const auto add = [&](Index particle, const Vector3& momentum) { impulses.col(particle) += momentum / motion.dt; };
  for_each_set(sets_, [&](const auto& set) {
    set.for_pushing([&](const auto& row, const ContactGoal& goal) { for_shares(row, displacement_by(row, goal), add); });
  });
}

void ContactSolver::add_settled(Points& impulses) const {
  const auto add = [&](Index particle, const Vector3& impulse) { impulses.col(particle) += impulse; };
  for_each_set(sets_, [&](const auto& set) {
    set.for_settled([&](const auto& row, const Vector3& change) { for_shares(row, change, add); });
  });
}

template <std::size_t n, class Visit>
void ContactSolver::for_shares(const ContactConstraint<n>& row, const Vector3& moved, const Visit& visit) const {
  double mobility = 0.0;
  for (std::size_t k = 0; k < n; ++k) mobility += row.weights[k] * row.weights[k] * network_.inverse_masses[row.particles[k]];
  if (mobility == 0.0) return;
  for (std::size_t k = 0; k < n; ++k) visit(row.particles[k], Vector3(row.weights[k] / mobility * moved));
}

std::vector<Index> ContactSolver::pushed() const {
  std::vector<Index> pushed;
  for_each_set(sets_,
               [&](const auto& set) { set.for_pushed([&](Index particle, const auto&...) { pushed.push_back(particle); }); });
  sort_unique(pushed);
  return pushed;
}

std::vector<ContactNormal> ContactSolver::normals() const {
  std::vector<ContactNormal> normals;
  for_each_set(sets_, [&](const auto& set) {
    set.for_touching([&](Index particle, const auto& row) {
      const auto corner = std::ranges::find(row.particles, particle) - row.particles.begin();
      const bool is_of_first = row.weights[static_cast<std::size_t>(corner)] >= 0.0;  // which the contact's normal pushes
      normals.push_back({particle, is_of_first ? row.normal : Vector3(-row.normal)});
    });
  });
  return normals;
}

}  // namespace sprung
