// Contacts of n particles each, in flat arrays, with their passes over positions and velocities. Internal to dynamics/.
#pragma once

#include "dynamics/contact/contact_constraint.h"
#include "dynamics/contact/restitution.h"
#include "dynamics/integrators/step_motion.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace sprung {

template <std::size_t n>
class ContactConstraintSet {
 public:
  /// Resizes the set to `count` contacts and keeps the first ones. The caller sets `row`, `goal` and `gap` [m] > 0 of new ones.
  void resize(std::size_t count) {
    rows_.resize(count);
    goals_.resize(count);
    gaps_.resize(count);
  }
  [[nodiscard]] std::size_t count() const { return rows_.size(); }
  [[nodiscard]] ContactConstraint<n>& row(std::size_t contact) { return rows_[contact]; }
  [[nodiscard]] ContactGoal& goal(std::size_t contact) { return goals_[contact]; }
  [[nodiscard]] double& gap(std::size_t contact) { return gaps_[contact]; }

  /// Moves the contacts of these patches, ascending, to `former`, in their order.
  void take_out(const std::vector<Index>& patches, ContactConstraintSet& former) {
    former.resize(0);
    std::size_t kept = 0;
    for (std::size_t c = 0; c < rows_.size(); ++c) {
      if (std::binary_search(patches.begin(), patches.end(), rows_[c].patch)) {
        former.append(rows_[c], goals_[c], gaps_[c]);
      } else {
        if (kept < c) put(rows_[c], goals_[c], gaps_[c], kept);
        ++kept;
      }
    }
    resize(kept);
  }

  /// Contacts from `begin` on take over the accumulated push and friction of contacts in `former` with the same particles and
  /// obstacle, in their order. `first_row` holds kNone for each particle, before and after the call.
  void warm_start(const ContactConstraintSet& former, std::size_t begin, std::vector<Index>& first_row) {
    std::vector<Index> next_row(former.rows_.size());
    for (std::size_t f = former.rows_.size(); f-- > 0;) {
      next_row[f] = std::exchange(first_of(former.rows_[f], first_row), static_cast<Index>(f));
    }
    for (std::size_t c = begin; c < rows_.size(); ++c) {
      Index* link = &first_of(rows_[c], first_row);
      while (*link != kNone && !is_same_contact(former.rows_[static_cast<std::size_t>(*link)], rows_[c])) {
        link = &next_row[static_cast<std::size_t>(*link)];
      }
      if (*link == kNone) continue;
      const auto f = static_cast<std::size_t>(*link);
      goals_[c].push = former.goals_[f].push;
      const Vector3& friction = former.goals_[f].friction_change;
      goals_[c].friction_change = across(rows_[c].normal, friction);  // the normal may differ
      *link = next_row[f];
    }
    for (const ContactConstraint<n>& row : former.rows_) first_of(row, first_row) = kNone;
  }

  /// Projects positions. Returns the largest change of a push relative to the gap.
  double project(Points& positions) {
    double largest = 0.0;
    for (std::size_t c = 0; c < rows_.size(); ++c) {
      const double change = project_constraint(rows_[c], goals_[c], positions);
      if (change != 0.0) largest = std::max(largest, std::abs(change) / gaps_[c]);
    }
    return largest;
  }

  /// Finds the touching contacts, and removes from their velocities the excess that a push out of the gap produced.
  void begin_settling(const StepMotion& motion, const Points& positions, Points& velocities) {
    touching_.clear();
    velocity_goals_.clear();
    taken_.clear();
    for (std::size_t c = 0; c < rows_.size(); ++c) {
      if (!goals_[c].touches) continue;
      const ContactConstraint<n>& row = rows_[c];
      const Vector3 surface_velocity = (goals_[c].origin - row.sum(motion.before)) / motion.dt;
      const double speed = row.normal.dot(row.sum(velocities) - surface_velocity);
      const double pushed = row.normal.dot(row.sum(positions) - row.sum(motion.advanced)) / motion.dt;
      const SpeedRange range = settled_speeds(row, goals_[c], motion, surface_velocity, speed - pushed);
      // At most its own push: other contacts remove theirs.
      const double taken = std::min(speed - range.most, goals_[c].push / motion.dt);
      taken_.emplace_back(Vector3::Zero());
      if (taken > 0.0) {
        taken_.back() = -taken * row.normal + friction_lost(row, goals_[c], taken, motion.dt);
        row.change_sum(taken_.back(), velocities);
      }
      touching_.push_back(c);
      velocity_goals_.push_back({.origin = surface_velocity, .least = range.least});
    }
  }

  /// Projects velocities. Returns the largest change of a velocity [m/s].
  double settle(Points& velocities) {
    double largest = 0.0;
    for (std::size_t t = 0; t < touching_.size(); ++t) {
      largest = std::max(largest, std::abs(project_constraint(rows_[touching_[t]], velocity_goals_[t], velocities)));
    }
    return largest;
  }

  /// Calls `visit(particle, row)` for each particle that a touching contact can move, once per contact.
  template <class Visit>
  void for_touching(const Visit& visit) const {
    for (const std::size_t c : touching_) for_moved(rows_[c], [&](Index particle) { visit(particle, rows_[c]); });
  }

  /// Calls `visit(row, goal)` for each contact that pushed.
  template <class Visit>
  void for_pushing(const Visit& visit) const {
    for (std::size_t c = 0; c < rows_.size(); ++c) {
      if (goals_[c].push > 0.0) visit(rows_[c], goals_[c]);
    }
  }

  /// Calls `visit(row, change)` for each touching contact, with the total change of its sum's velocity by settling [m/s].
  template <class Visit>
  void for_settled(const Visit& visit) const {
    for (std::size_t t = 0; t < touching_.size(); ++t) {
      const ContactConstraint<n>& row = rows_[touching_[t]];
      const ContactGoal& goal = velocity_goals_[t];
      visit(row, Vector3(taken_[t] + goal.push * row.normal + goal.friction_change));
    }
  }

  /// Calls `visit(particle, row, goal)` for each particle that a contact that pushed can move, once per contact.
  template <class Visit>
  void for_pushed(const Visit& visit) const {
    for_pushing([&](const ContactConstraint<n>& row, const ContactGoal& goal) {
      for_moved(row, [&](Index particle) { visit(particle, row, goal); });
    });
  }

 private:
  /// The friction that velocities lose with a removed push, because no load caused it. Positions keep it: at most friction times
  /// the displacement out of the gap.
  static Vector3 friction_lost(const ContactConstraint<n>& row, ContactGoal goal, double taken, double dt) {
    goal.push = std::max(0.0, goal.push - taken * dt);
    return (friction_of(row, goal, goal.friction_change) - goal.friction_change) / dt;
  }

  /// `v_after` is the speed along the normal that forces alone would give.
  static SpeedRange settled_speeds(const ContactConstraint<n>& row, const ContactGoal& goal, const StepMotion& motion,
                                   const Vector3& surface_velocity, double v_after) {
    if (row.restitution == 0.0) return {.least = 0.0, .most = std::max(0.0, v_after)};
    return sprung::settled_speeds({.height = -goal.least,
                                   .moved = row.normal.dot(row.sum(motion.advanced) - goal.origin),
                                   .v_before = row.normal.dot(row.sum(motion.v_before) - surface_velocity),
                                   .v_after = v_after,
                                   .dt = motion.dt},
                                  row.restitution);
  }

  void append(const ContactConstraint<n>& row, const ContactGoal& goal, double gap) {
    resize(count() + 1);
    put(row, goal, gap, count() - 1);
  }
  void put(const ContactConstraint<n>& row, const ContactGoal& goal, double gap, std::size_t c) {
    rows_[c] = row;
    goals_[c] = goal;
    gaps_[c] = gap;
  }

  static Index& first_of(const ContactConstraint<n>& row, std::vector<Index>& first_row) {
    return first_row[static_cast<std::size_t>(row.particles[0])];
  }

  static bool is_same_contact(const ContactConstraint<n>& a, const ContactConstraint<n>& b) {
    return a.particles == b.particles && a.obstacle == b.obstacle;
  }

  template <class Visit>
  static void for_moved(const ContactConstraint<n>& row, const Visit& visit) {
    for (std::size_t k = 0; k < n; ++k) {
      if (row.shares[k] != 0.0) visit(row.particles[k]);
    }
  }

  std::vector<ContactConstraint<n>> rows_;
  std::vector<ContactGoal> goals_;  ///< of positions
  std::vector<double> gaps_;
  std::vector<std::size_t> touching_;
  std::vector<ContactGoal> velocity_goals_;  ///< of touching contacts
  std::vector<Vector3> taken_;               ///< change of their sums' velocities in begin_settling() [m/s]
};

}  // namespace sprung
