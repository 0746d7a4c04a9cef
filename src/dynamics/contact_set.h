// Contacts of n particles each, in flat arrays: the passes of a step over positions, then over velocities. Internal to dynamics/.
#pragma once

#include "dynamics/contact_bounce.h"
#include "dynamics/contact_row.h"
#include "dynamics/step_motion.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <vector>

namespace sprung {

template <std::size_t n>
class ContactSet {
 public:
  /// Begins a step with so many contacts, each of which `row`, `goal` and `gap` [m] > 0 are then to be set.
  void resize(std::size_t count) {
    rows_.resize(count);
    goals_.resize(count);
    gaps_.resize(count);
  }
  [[nodiscard]] ContactRow<n>& row(std::size_t contact) { return rows_[contact]; }
  [[nodiscard]] ContactGoal& goal(std::size_t contact) { return goals_[contact]; }
  [[nodiscard]] double& gap(std::size_t contact) { return gaps_[contact]; }

  /// Takes over what contacts of the same particles with the same obstacle have pushed and held in `former`.
  void count_on(const ContactSet& former) {
    const std::vector<std::size_t> order = by_what_meets();
    auto c = order.begin();
    for (const std::size_t f : former.by_what_meets()) {
      while (c != order.end() && what_meets(rows_[*c]) < what_meets(former.rows_[f])) ++c;
      if (c == order.end()) return;
      if (what_meets(former.rows_[f]) < what_meets(rows_[*c])) continue;
      goals_[*c].push = former.goals_[f].push;
      goals_[*c].held = former.goals_[f].held;
      ++c;
    }
  }

  /// Answers on positions. Returns the largest change of a push, as a part of the gap.
  double project(Points& positions) {
    double largest = 0.0;
    for (std::size_t c = 0; c < rows_.size(); ++c) {
      const double change = answer(rows_[c], goals_[c], positions);
      if (change != 0.0) largest = std::max(largest, std::abs(change) / gaps_[c]);
    }
    return largest;
  }

  /// Finds what touches, and takes from its velocities what a push out of the gap has made too fast.
  void begin_settling(const StepMotion& motion, const Points& positions, Points& velocities) {
    touching_.clear();
    velocity_goals_.clear();
    for (std::size_t c = 0; c < rows_.size(); ++c) {
      if (!goals_[c].touches) continue;
      const ContactRow<n>& row = rows_[c];
      const Vector3 carrier = (goals_[c].origin - row.sum(motion.before)) / motion.dt;
      const double speed = row.normal.dot(row.sum(velocities) - carrier);
      const double pushed = row.normal.dot(row.sum(positions) - row.sum(motion.advanced)) / motion.dt;
      const SpeedRange range = settled_speeds(row, goals_[c], motion, carrier, speed - pushed);
      if (speed > range.most) row.change_sum((range.most - speed) * row.normal, velocities);
      touching_.push_back(c);
      velocity_goals_.push_back({.origin = carrier, .least = range.least});
    }
  }

  /// Answers on velocities. Returns the largest change of one [m/s].
  double settle(Points& velocities) {
    double largest = 0.0;
    for (std::size_t t = 0; t < touching_.size(); ++t) {
      largest = std::max(largest, std::abs(answer(rows_[touching_[t]], velocity_goals_[t], velocities)));
    }
    return largest;
  }

  /// Calls `visit(particle)` for each particle that what touches can move, several times for one that several do.
  template <class Visit>
  void for_touching(const Visit& visit) const {
    for (const std::size_t c : touching_) for_moved(rows_[c], visit);
  }

  /// The same for contacts that have pushed.
  template <class Visit>
  void for_pushed(const Visit& visit) const {
    for (std::size_t c = 0; c < rows_.size(); ++c) {
      if (goals_[c].push > 0.0) for_moved(rows_[c], visit);
    }
  }

 private:
  /// `v_after` is what the forces alone would have made of the speed along the normal.
  static SpeedRange settled_speeds(const ContactRow<n>& row, const ContactGoal& goal, const StepMotion& motion,
                                   const Vector3& carrier, double v_after) {
    if (row.restitution == 0.0) return {.least = 0.0, .most = std::max(0.0, v_after)};
    return sprung::settled_speeds({.height = -goal.least,
                                   .moved = row.normal.dot(row.sum(motion.advanced) - goal.origin),
                                   .v_before = row.normal.dot(row.sum(motion.v_before) - carrier),
                                   .v_after = v_after,
                                   .dt = motion.dt},
                                  row.restitution);
  }

  static auto what_meets(const ContactRow<n>& row) { return std::tie(row.obstacle, row.particles); }

  [[nodiscard]] std::vector<std::size_t> by_what_meets() const {
    std::vector<std::size_t> order(rows_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return what_meets(rows_[a]) < what_meets(rows_[b]); });
    return order;
  }

  template <class Visit>
  static void for_moved(const ContactRow<n>& row, const Visit& visit) {
    for (std::size_t k = 0; k < n; ++k) {
      if (row.shares[k] != 0.0) visit(row.particles[k]);
    }
  }

  std::vector<ContactRow<n>> rows_;
  std::vector<ContactGoal> goals_;  ///< of positions
  std::vector<double> gaps_;
  std::vector<std::size_t> touching_;
  std::vector<ContactGoal> velocity_goals_;  ///< of those that touch
};

}  // namespace sprung
