// Brings a body from a place where it is free to where it is wanted, as far as obstacles and other bodies let it.
#pragma once

#include "dynamics/contact/contact_projection.h"

namespace sprung {

class WayBack {
 public:
  /// Only this body moves. Keeps a reference to the environment.
  WayBack(const SpringNetwork& network, Environment& environment, Index body);

  /// From `free`, where the body intersects nothing, towards `wanted`, in strides of an element's size; where it ends
  /// [m]. Particles that meet anything slide along it towards where they are wanted, while the others arrive.
  [[nodiscard]] Points walk(const Points& free, const Points& wanted);

 private:
  /// Under contact from `x` to where it advanced. Returns the farthest that any particle got [m].
  double stride(Points& x, const Points& advanced);

  SpringNetwork network_;  ///< without friction, and with all other bodies pinned
  double length_ = 0.0;    ///< of a stride [m]; 0 for particles on their own
  ContactProjection contacts_;
};

}  // namespace sprung
