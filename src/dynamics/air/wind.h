// The velocity of the air.
#pragma once

#include "base/types.h"
#include "dynamics/air/gust_field.h"

#include <optional>
#include <vector>

namespace sprung {

struct WindKeyframe {
  double time = 0.0;                   ///< [s]
  Vector3 velocity = Vector3::Zero();  ///< [m/s]
};

/// A mean wind, uniform in space, and gusts. The mean wind is linear between keyframes and constant before the first one and after
/// the last one. The gusts move with it (frozen turbulence: Taylor 1938): at time t they are those of a point that lies back by the
/// path of the mean wind since time 0. Default: calm air.
class Wind {
 public:
  Wind() = default;

  /// A constant wind [m/s].
  template <class Derived>
  Wind(const Eigen::MatrixBase<Derived>& velocity) : keyframes_{{0.0, velocity}} {}  // NOLINT(google-explicit-constructor)

  /// Requires finite velocities, times that increase strictly, and gusts in the bounds of Gusts.
  explicit Wind(std::vector<WindKeyframe> keyframes, const std::optional<Gusts>& gusts = std::nullopt);

  [[nodiscard]] const std::vector<WindKeyframe>& keyframes() const { return keyframes_; }
  [[nodiscard]] const std::optional<Gusts>& gusts() const { return gusts_; }

  /// Whether the velocity is zero everywhere and at all times.
  [[nodiscard]] bool is_calm() const;

  /// The mean wind [m/s] at `time` [s].
  [[nodiscard]] Vector3 mean(double time) const;

  /// The velocity of the air [m/s] at a position [m] and a time [s].
  [[nodiscard]] Vector3 velocity(const Vector3& position, double time) const;

  /// These velocities at many positions, both 3 x n.
  [[nodiscard]] Points velocities(const Points& positions, double time) const;

  /// The time from which on the wind stays the same [s]; infinity with gusts.
  [[nodiscard]] double end() const;

  /// An upper bound of the speed [m/s].
  [[nodiscard]] double max_speed() const;

  /// The speed [m/s] that the air reaches now and then: that of the strongest mean wind, plus twice the speed of the gusts, which
  /// they exceed in 1 % of space and time.
  [[nodiscard]] double usual_speed() const;

 private:
  [[nodiscard]] double strongest_mean() const;
  [[nodiscard]] Vector3 mean_path(double time) const;

  std::vector<WindKeyframe> keyframes_;
  std::optional<Gusts> gusts_;
  std::optional<GustField> field_;  ///< of gusts with a speed
};

}  // namespace sprung
