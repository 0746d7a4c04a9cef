// Attachments: rods and springs that join particles of bodies to other bodies and to obstacles.
#pragma once

#include "base/types.h"

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace sprung {

/// Where the second ends of an attachment are. Each first end takes the nearest of these points when the attachment engages.
struct ParticleEnds {
  std::vector<Index> particles;  ///< of the network
};
struct SurfaceEnd {
  Index body = kNone;  ///< of whose faces, or segments
};
struct ObstacleEnd {
  Index obstacle = kNone;  ///< of the simulator, of whose surface; the point moves with it
};
using SecondEnds = std::variant<ParticleEnds, SurfaceEnd, ObstacleEnd>;

/// Joins each of `particles` to one point. It engages at `from`, at the positions of that time. A simulator rounds both times to
/// steps.
struct Attachment {
  std::string name{};              ///< for reports, such as `attachments[1]`
  std::vector<Index> particles{};  ///< the first ends
  SecondEnds second{};
  std::optional<double> stiffness{};                             ///< k_s [N/m], >= 0; none: a rod, which keeps its length
  double damping = 0.0;                                          ///< k_d of springs [N s/m], >= 0
  std::optional<double> rest_length{};                           ///< [m], >= 0; none: the distance at which it engages
  double break_force = std::numeric_limits<double>::infinity();  ///< beyond which a rod or spring breaks [N], > 0
  double from = 0.0;                                             ///< [s], >= 0
  double until = std::numeric_limits<double>::infinity();        ///< [s], > from

  [[nodiscard]] bool is_rigid() const { return !stiffness.has_value(); }
  /// Whether it has begun and not ended before `time` [s] (see due_before()).
  [[nodiscard]] bool holds_at(double time) const { return from < time && !(until < time); }
};

/// One rod or spring of an attachment that has engaged.
struct Link {
  std::size_t attachment = 0;                        ///< its number
  Index first = kNone;                               ///< particle
  std::array<Index, 3> second{kNone, kNone, kNone};  ///< particles; none on an obstacle
  Vector3 weights = Vector3::UnitX();                ///< of those, or of the corners of `triangle`; their sum is 1
  Index triangle = kNone;                            ///< of a deforming obstacle
  Vector3 anchor = Vector3::Zero();                  ///< on a rigid obstacle, in its frame [m]
  double distance = 0.0;                             ///< at which it engaged [m]
  double length = 0.0;                               ///< at rest [m]
  double time = 0.0;                                 ///< at which it engaged [s]
  std::optional<std::int64_t> broken{};              ///< number of the step after which it broke
  Vector3 impulse = Vector3::Zero();                 ///< of a rod on the first end in the last step [N s]
};

}  // namespace sprung
