// A smooth random velocity of the air.
#pragma once

#include "base/types.h"

#include <array>
#include <cstdint>

namespace sprung {

/// Gusts that are added to the mean wind.
struct Gusts {
  double speed = 0.0;      ///< root mean square of the velocity over space and time [m/s], >= 0
  double length = 1.0;     ///< correlation length [m], > 0: the integral of the longitudinal correlation
  std::uint64_t seed = 0;  ///< equal seeds give equal gusts
};

/// An incompressible random flow as a sum of N plane waves (Kraichnan 1970),
///     g(x, t) = speed sqrt(2 / N) sum of a_n cos(k_n . x + w_n t + p_n),
/// with unit vectors a_n across the wave vectors k_n, so that the divergence is zero. The lengths of k_n are quantiles of the
/// energy spectrum k^4 exp(-k^2 length^2 / pi): the longitudinal correlation over a distance r, averaged over seeds, is exp(-pi r^2
/// / (4 length^2)). The directions of k_n spread evenly over the sphere; two waves share a direction, with a_n at right angles. The
/// frequencies w_n are uniform in [-k_n speed, k_n speed], as if the gusts carried each other along, so that they change within
/// about length / speed [s]. Cosines are approximated within 1e-7.
class GustField {
 public:
  static constexpr int kWaves = 24;

  explicit GustField(const Gusts& gusts);

  /// Adds the velocities [m/s] at `positions` [m] minus `shift` [m] and at `time` [s] to `velocities`; both are 3 x n. Each
  /// velocity depends on its own position alone, bit for bit.
  void add_velocities(const Eigen::Ref<const Points>& positions, const Vector3& shift, double time,
                      Eigen::Ref<Points> velocities) const;

  /// The largest speed that the waves can add up to [m/s]: speed sqrt(2 N).
  [[nodiscard]] double max_speed() const { return max_speed_; }

  struct Wave {
    Vector3 wave_vector;  ///< k / (2 pi) [1/m]
    Vector3 amplitude;    ///< [m/s]
    double frequency;     ///< w / (2 pi) [1/s]
    double phase;         ///< p / (2 pi), at time 0
  };

 private:
  std::array<Wave, kWaves> waves_;
  double max_speed_;
};

}  // namespace sprung
