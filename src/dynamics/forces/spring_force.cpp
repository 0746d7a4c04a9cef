#include "dynamics/forces/spring_force.h"

#include "base/parallel.h"
#include "dynamics/forces/force_derivatives.h"
#include "dynamics/forces/material_dampers.h"
#include "dynamics/forces/spring_plan.h"
#include "dynamics/numerics/block_matrix.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

namespace sprung {
namespace {

using Repeated = std::array<double, kSimdWidth>;

/// A constant of a run: the network's array, or one repeated value if all are the same. Reading that value from the array would
/// miss the cache in large solids.
SpringConstant constant_of(const std::vector<double>& values, Index spring, bool same, double value, Repeated& repeated) {
  if (!same) return {&values[spring], false};
  repeated.fill(value);
  return {repeated.data(), true};
}

/// The springs of a force, with its constants.
struct ForceSprings {
  const Springs& springs;
  const std::vector<double>& stiffness;
  const std::vector<double>& damping;
};

void add_run(const SpringPlan::Run& run, const ForceSprings& of, const Kinematics& at, Points& forces) {
  Repeated rest_length;
  Repeated stiffness;
  Repeated damping;
  add_run_forces(
      {.x_a = at.x.col(run.first).data(),
       .x_b = at.x.col(run.second).data(),
       .v_a = at.v.col(run.first).data(),
       .v_b = at.v.col(run.second).data(),
       .force_a = run.writes_first ? forces.col(run.first).data() : nullptr,
       .force_b = run.writes_second ? forces.col(run.second).data() : nullptr,
       .count = run.count},
      {.rest_length = constant_of(of.springs.rest_length, run.spring, run.same_rest_length, run.rest_length, rest_length),
       .stiffness = constant_of(of.stiffness, run.spring, run.same_stiffness, run.stiffness, stiffness),
       .damping = constant_of(of.damping, run.spring, run.same_damping, run.damping, damping),
       .tension_only = run.tension_only});
}

/// Springs gathered one by one. The forces of padding entries are not used.
struct GatheredBatch {
  using Vectors = Eigen::Matrix<double, 3, kSpringBatch>;
  Vectors difference = Vectors::Zero();
  Vectors velocity = Vectors::Zero();
  std::array<double, kSpringBatch> rest_length{};
  std::array<double, kSpringBatch> stiffness{};
  std::array<double, kSpringBatch> damping{};

  void gather(std::span<const SpringPlan::Single> singles, const ForceSprings& of, const Kinematics& at) {
    for (Index i = 0; i < static_cast<Index>(singles.size()); ++i) {
      const SpringPlan::Single& single = singles[i];
      difference.col(i) = at.x.col(single.first) - at.x.col(single.second);
      velocity.col(i) = at.v.col(single.first) - at.v.col(single.second);
      rest_length[i] = of.springs.rest_length[single.spring];
      stiffness[i] = of.stiffness[single.spring];
      damping[i] = of.damping[single.spring];
    }
  }

  void scatter(std::span<const SpringPlan::Single> singles, Points& forces) const {
    for (Index i = 0; i < static_cast<Index>(singles.size()); ++i) {
      if (singles[i].writes_first) forces.col(singles[i].first) += difference.col(i);
      if (singles[i].writes_second) forces.col(singles[i].second) -= difference.col(i);
    }
  }
};

void add_singles(const std::vector<SpringPlan::Single>& all, bool tension_only, const ForceSprings& of, const Kinematics& at,
                 Points& forces) {
  GatheredBatch batch;
  for (std::size_t begin = 0; begin < all.size(); begin += kSpringBatch) {
    const std::size_t count = std::min<std::size_t>(kSpringBatch, all.size() - begin);
    const std::span<const SpringPlan::Single> singles(&all[begin], count);
    batch.gather(singles, of, at);
    const auto lanes = static_cast<Index>((count + kSimdWidth - 1) / kSimdWidth * kSimdWidth);
    differences_to_forces(batch.difference.data(), batch.velocity.data(), lanes,
                          {.rest_length = {batch.rest_length.data(), false},
                           .stiffness = {batch.stiffness.data(), false},
                           .damping = {batch.damping.data(), false},
                           .tension_only = tension_only});
    batch.scatter(singles, forces);
  }
}

/// A spring's sideways stiffness relative to its stiffness. A spring of zero length has no direction: if its rest length is zero
/// it restores equally in all directions, otherwise not at all.
double transverse_ratio(double length, double rest_length) {
  if (length == 0.0) return rest_length == 0.0 ? 1.0 : 0.0;
  return std::max(0.0, 1.0 - rest_length / length);
}

}  // namespace

SpringForce::SpringForce(const SpringNetwork& network)
    : network_(network),
      stiffness_(network.springs.stiffness),
      damping_(network.springs.damping),
      plan_(std::make_unique<SpringPlan>(network, stiffness_, damping_)) {}
SpringForce::SpringForce(const SpringNetwork& network, ElementConstants constants)
    : network_(network),
      own_(std::make_unique<ElementConstants>(std::move(constants))),
      stiffness_(own_->stiffness),
      damping_(own_->damping),
      plan_(std::make_unique<SpringPlan>(network, stiffness_, damping_)) {}
SpringForce::~SpringForce() = default;

// There are no springs with stiffness or damping.
bool SpringForce::is_constant() const { return plan_->blocks.empty(); }

void SpringForce::add(const Kinematics& at, Points& forces) const {
  const ForceSprings springs{network_.springs, stiffness_, damping_};
  parallel_chunks(static_cast<Index>(plan_->blocks.size()), 1, [&](Index begin, Index end) {
    for (Index b = begin; b < end; ++b) {
      for (const SpringPlan::Run& run : plan_->blocks[b].runs) add_run(run, springs, at, forces);
      add_singles(plan_->blocks[b].singles, false, springs, at, forces);
      add_singles(plan_->blocks[b].tension_only_singles, true, springs, at, forces);
    }
  });
}

void SpringForce::couple(std::vector<ParticlePair>& pairs) const {
  const Springs& springs = network_.springs;
  for (std::size_t s = 0; s < springs.first.size(); ++s) pairs.push_back({springs.first[s], springs.second[s]});
}

void SpringForce::add_derivatives(const Kinematics& at, ForceDerivatives& derivatives) const {
  const Springs& springs = network_.springs;
  for (std::size_t s = 0; s < springs.first.size(); ++s) {
    const Index a = springs.first[s];
    const Index b = springs.second[s];
    const Vector3 difference = at.x.col(a) - at.x.col(b);
    const double length = difference.norm();
    if (springs.law(static_cast<Index>(s)).tension_only && !(length > springs.rest_length[s])) continue;
    const Vector3 e = length > 0.0 ? Vector3(difference / length) : Vector3(Vector3::Zero());
    const Matrix3 along = e * e.transpose();
    const Matrix3 across = transverse_ratio(length, springs.rest_length[s]) * (Matrix3::Identity() - along);
    derivatives.by_position.add_difference(a, b, -stiffness_[s] * (along + across));
    if (damping_[s] > 0.0) derivatives.by_velocity.add_difference(a, b, -damping_[s] * along);
  }
}

void SpringForce::append_elements(std::vector<LinearElement>& elements) const {
  const Springs& springs = network_.springs;
  const std::size_t begin = elements.size();
  for (Index s = 0; s < springs.count(); ++s) {
    elements.push_back(LinearElement::pair(springs.first[s], springs.second[s], stiffness_[s], damping_[s]));
  }
  for_material_springs(network_, [&](Index s) { elements[begin + static_cast<std::size_t>(s)].of_material = true; });
}

double SpringForce::capacity() const {
  const Springs& springs = network_.springs;
  double energy = 0.0;
  for (Index s = 0; s < springs.count(); ++s) {
    energy += 0.5 * stiffness_[s] * springs.rest_length[s] * springs.rest_length[s];
  }
  return energy;
}

double SpringForce::energy(const Points& positions) const {
  const Springs& springs = network_.springs;
  double energy = 0.0;
  for (Index s = 0; s < springs.count(); ++s) {
    const double stretch = (positions.col(springs.first[s]) - positions.col(springs.second[s])).norm() - springs.rest_length[s];
    if (stretch <= 0.0 && springs.law(s).tension_only) continue;
    energy += 0.5 * stiffness_[s] * stretch * stretch;
  }
  return energy;
}

}  // namespace sprung
