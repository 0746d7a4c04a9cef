// Functions shared by the tests of networks.
#pragma once

#include "base/error.h"
#include "network/bodies/body_shape.h"
#include "network/model/spring_network.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace sprung::testing {

/// Keys of the problems that `make` throws; empty if it throws none.
template <class Make>
std::vector<std::string> problem_keys(const Make& make) {
  std::vector<std::string> keys;
  try {
    static_cast<void>(make());
  } catch (const InputError& error) {
    for (const Problem& problem : error.problems()) {
      keys.push_back(problem.rule.empty() || problem.remedy.empty() ? "no rule or remedy" : problem.key);
    }
  }
  return keys;
}

inline SpringMaterial stiff(double stiffness) { return {stiffness, SpringMaterial::Measure::stiffness, 0.0}; }
inline SpringMaterial modular(double modulus) { return {modulus, SpringMaterial::Measure::modulus, 0.0}; }
inline SpringMaterials every_kind(const SpringMaterial& material) { return {material, material, material}; }

inline std::int64_t count(const BodyShape& shape, SpringKind kind) {
  return std::count(shape.springs.kind.begin(), shape.springs.kind.end(), kind);
}

using Pair = std::pair<Index, Index>;

/// Ends of the springs of a kind, sorted.
inline std::vector<Pair> pairs(const BodyShape& shape, SpringKind kind) {
  std::vector<Pair> result;
  for (Index s = 0; s < shape.springs.count(); ++s) {
    if (shape.springs.kind[s] == kind) result.emplace_back(shape.springs.first[s], shape.springs.second[s]);
  }
  std::sort(result.begin(), result.end());
  return result;
}

/// Adds a pin that holds its particles.
inline void hold(SpringNetwork& network, const Pin& pin) {
  Activity activity = network.activity;
  for (const Index i : pin.particles) activity.pin_of[i] = static_cast<Index>(network.pins.size());
  activity.phases.push_back(PinPhase::holding);
  network.pins.push_back(pin);
  set_activity(activity, network);
}

/// Force [N] of the springs across the plane at `position` [m] on the axis if the body is stretched by `strain` along the axis: the
/// sum of k_s (l - d) times the direction cosine over the springs that cross the plane.
inline double stretching_force(const BodyShape& shape, int axis, double position, double strain) {
  const auto stretched = [&](Index i) {
    Vector3 x = shape.positions[i];
    x[axis] *= 1.0 + strain;
    return x;
  };
  double force = 0.0;
  for (Index s = 0; s < shape.springs.count(); ++s) {
    const Index a = shape.springs.first[s];
    const Index b = shape.springs.second[s];
    if ((shape.positions[a][axis] < position) == (shape.positions[b][axis] < position)) continue;
    const Vector3 span = stretched(b) - stretched(a);
    const double length = span.norm();
    force += shape.springs.stiffness[s] * (length - shape.springs.rest_length[s]) * std::abs(span[axis]) / length;
  }
  return force;
}

}  // namespace sprung::testing
