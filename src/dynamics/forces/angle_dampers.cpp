#include "dynamics/forces/angle_dampers.h"

#include "base/parallel.h"
#include "dynamics/forces/angle_bend.h"

#include <algorithm>
#include <utility>

namespace sprung {
namespace {

constexpr Index kDampersAtOnce = 1024;

double shortness(const Vector3& bond, double rest_length) {
  return std::min(1.0, bond.squaredNorm() / (rest_length * rest_length));
}

}  // namespace

AngleDampers::AngleDampers(const SpringNetwork& network, std::vector<double> damping)
    : network_(network), damping_(std::move(damping)), blocks_(network.particle_count()), held_(damping_.size()) {
  for (Index element = 0; element < network_.angle_bends.count(); ++element) {
    if (damping_[element] > 0.0) blocks_.add(network_, element, particles_of(network_.angle_bends, element));
  }
}

void AngleDampers::hold(const Points& positions) {
  const AngleBends& bends = network_.angle_bends;
  parallel_chunks(bends.count(), kDampersAtOnce, [&](Index begin, Index end) {
    for (Index element = begin; element < end; ++element) {
      HeldDamper& held = held_[element];
      held = {Vector3::Zero(), Vector3::Zero(), 0.0, 0.0};
      const Bend bend(bends, element, positions);
      if (!(damping_[element] > 0.0) || !(bend.sine > 0.0)) continue;
      const auto [before, middle, after] = turns(bend);
      const double share = shortness(bend.a, bends.length_before[element]) * shortness(bend.b, bends.length_after[element]);
      held = {before, after, share * damping_[element], bend.fullness()};
    }
  });
}

void AngleDampers::add(const Kinematics& at, Points& forces) const {
  const AngleBends& bends = network_.angle_bends;
  blocks_.for_each(forces, [&](Index element, const auto& add_to) {
    const HeldDamper& held = held_[element];
    const Vector3 v = at.v.col(bends.middle[element]);
    const double rate =
        held.turn_before.dot(at.v.col(bends.before[element]) - v) + held.turn_after.dot(at.v.col(bends.after[element]) - v);
    const double moment = held.damping * rate * held.fullness;
    const Vector3 on_before = -moment * held.turn_before;
    const Vector3 on_after = -moment * held.turn_after;
    add_to(bends.before[element], on_before);
    add_to(bends.middle[element], -(on_before + on_after));
    add_to(bends.after[element], on_after);
  });
}

}  // namespace sprung
