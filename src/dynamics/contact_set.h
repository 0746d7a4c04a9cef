// Contacts of n particles each, in flat arrays: the passes of a step over positions, then over velocities. Internal to dynamics/.
#pragma once

#include "dynamics/contact_bounce.h"
#include "dynamics/contact_row.h"

#include <cmath>
#include <vector>

namespace sprung {

template <std::size_t n>
class ContactSet {
 public:
  /// What a contact's velocities are to become.
  struct Settling {
    Vector3 carrier = Vector3::Zero();  ///< velocity of what is met [m/s]
    SpeedRange speeds{};                ///< along the normal, relative to it
  };

  void clear() {
    rows_.clear();
    gaps_.clear();
    settling_.clear();
  }

  /// `gap` [m] > 0 is kept.
  void add(const ContactRow<n>& row, double gap, const Settling& settling) {
    rows_.push_back(row);
    gaps_.push_back(gap);
    settling_.push_back(settling);
  }

  /// Returns the largest change of a push, as a part of the gap.
  double project(Points& positions) {
    double largest = 0.0;
    for (std::size_t c = 0; c < rows_.size(); ++c) {
      const double change = answer(rows_[c], positions);
      largest = std::max(largest, std::abs(change) / gaps_[c]);
    }
    return largest;
  }

  /// Finds what touches at these positions and takes from its velocities what a push out of the gap has made too fast.
  void begin_settling(const Points& positions, Points& velocities) {
    velocity_rows_.clear();
    for (std::size_t c = 0; c < rows_.size(); ++c) {
      const ContactRow<n>& row = rows_[c];
      const double height = row.normal.dot(row.sum(positions) - row.origin) - row.least;
      if (row.push == 0.0 && height > kTouch * gaps_[c]) continue;
      ContactRow<n>& added = velocity_rows_.emplace_back(row);
      added.origin = settling_[c].carrier;
      added.least = settling_[c].speeds.least;
      added.push = 0.0;
      added.held = 0.0;
      const double speed = added.normal.dot(added.sum(velocities) - added.origin);
      const double excess = speed - settling_[c].speeds.most;
      if (excess > 0.0) added.change_sum(-excess * added.normal, velocities);
    }
  }

  /// Returns the largest change of a velocity [m/s].
  double settle(Points& velocities) {
    double largest = 0.0;
    for (ContactRow<n>& row : velocity_rows_) largest = std::max(largest, std::abs(answer(row, velocities)));
    return largest;
  }

  /// Calls `visit(particle)` for each particle that what touches can move, several times for one that several do.
  template <class Visit>
  void for_touching(const Visit& visit) const {
    for (const ContactRow<n>& row : velocity_rows_) for_moved(row, visit);
  }

  /// The same for contacts that have pushed.
  template <class Visit>
  void for_pushed(const Visit& visit) const {
    for (const ContactRow<n>& row : rows_) {
      if (row.push > 0.0) for_moved(row, visit);
    }
  }

 private:
  template <class Visit>
  static void for_moved(const ContactRow<n>& row, const Visit& visit) {
    for (std::size_t k = 0; k < n; ++k) {
      if (row.shares[k] != 0.0) visit(row.particles[k]);
    }
  }

  // What rounding leaves of a projection onto the gap, as a part of it.
  static constexpr double kTouch = 1.0e-9;

  std::vector<ContactRow<n>> rows_;
  std::vector<double> gaps_;
  std::vector<Settling> settling_;
  std::vector<ContactRow<n>> velocity_rows_;  ///< of those that touch
};

}  // namespace sprung
