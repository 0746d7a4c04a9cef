// Keeps the volume that closed bodies enclose.
#pragma once

#include "dynamics/constraints/constraint.h"
#include "network/model/spring_network.h"

#include <vector>

namespace sprung {

/// Keeps the volume within the surface of each body with a volume factor at that factor times its volume at rest (Mueller et al.
/// 2007, balloons), as of a bag full of water. Particles move along the gradients of the volume at the begin of the step, as in
/// SHAKE (Ryckaert et al. 1977): along those at its end, springs that the factor stretches would gain energy.
class EnclosedVolume final : public Constraint {
 public:
  /// Of all bodies with a factor (Body::volume_factor), which are at rest at the positions of the network. Keeps a reference to the
  /// network.
  explicit EnclosedVolume(const SpringNetwork& network);

  double project(const Points& before, Points& positions, const ImpulseRecorder& recorder) const override;

  /// A volume may differ by 0.1 % from what it is kept at.
  [[nodiscard]] double residual(const Points& positions) const override;

 private:
  struct Kept {
    std::size_t body;
    double volume;  ///< [m^3]
  };
  [[nodiscard]] static Points gradients_of(const Body& body, const Points& positions);
  [[nodiscard]] double change(const Kept& kept, const Points& positions) const;

  const SpringNetwork& network_;
  std::vector<Kept> kept_;
};

}  // namespace sprung
