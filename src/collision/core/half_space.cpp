#include "collision/core/half_space.h"

#include <algorithm>
#include <cmath>

namespace sprung {

namespace {

constexpr int kRounds = 8;

// Rounding error of a transform into an obstacle's frame and back, as a fraction of the largest coordinate. It is far below the
// distance at which safe regions count as touching (2^-42).
constexpr double kRounding = 0x1p-48;

double rounding(const HalfSpace& half_space, double largest) { return kRounding * std::max(std::abs(half_space.offset), largest); }

/// The fraction of the path from `safe` to `target` that is inside all half-spaces.
double free_fraction(std::span<const HalfSpace> half_spaces, const Vector3& safe, const Vector3& target) {
  double fraction = 1.0;
  for (const HalfSpace& half_space : half_spaces) {
    const double ahead = half_space.normal.dot(target) - half_space.offset;
    if (ahead >= 0.0) continue;
    const double behind = std::max(0.0, half_space.normal.dot(safe) - half_space.offset);
    fraction = std::min(fraction, behind / (behind - ahead));
  }
  return fraction;
}

struct Projected {
  Vector3 point;
  bool converged = false;
};

Projected project(std::span<const HalfSpace> half_spaces, const Vector3& target) {
  Projected result{target};
  for (int round = 0; round < kRounds; ++round) {
    result.converged = true;
    for (const HalfSpace& half_space : half_spaces) {
      const double missing = half_space.offset - half_space.normal.dot(result.point);
      if (missing <= rounding(half_space, result.point.cwiseAbs().maxCoeff())) continue;
      result.point += missing * half_space.normal;
      result.converged = false;
    }
    if (result.converged) break;
  }
  return result;
}

}  // namespace

bool is_feasible(std::span<const HalfSpace> half_spaces, const Vector3& p) {
  const double largest = p.cwiseAbs().maxCoeff();
  return std::all_of(half_spaces.begin(), half_spaces.end(), [&](const HalfSpace& half_space) {
    return half_space.normal.dot(p) >= half_space.offset - rounding(half_space, largest);
  });
}

std::optional<Vector3> feasible_point(std::span<const HalfSpace> half_spaces, const Vector3& target,
                                      std::span<const Vector3> safe) {
  const auto [projected, converged] = project(half_spaces, target);
  const auto from = std::find_if(safe.begin(), safe.end(), [&](const Vector3& p) { return is_feasible(half_spaces, p); });
  if (from == safe.end()) return converged ? std::optional(projected) : std::nullopt;
  const bool nearer = (projected - target).squaredNorm() < (*from - target).squaredNorm();
  if (converged && nearer) return projected;
  const Vector3 towards = nearer ? projected : target;
  return *from + free_fraction(half_spaces, *from, towards) * (towards - *from);
}

}  // namespace sprung
