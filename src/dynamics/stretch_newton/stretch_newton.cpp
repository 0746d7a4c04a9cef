#include "dynamics/stretch_newton/stretch_newton.h"

#include "base/parallel.h"
#include "dynamics/stretch_newton/component_impulses.h"
#include "dynamics/stretch_newton/two_level_newton.h"

#include <algorithm>
#include <utility>

namespace sprung {
namespace {

enum class Taken : std::uint8_t { from_start, when_handed_over, never };

// Solids are left to passes, as their factors fill: a hanging solid of 8 particles a side took 50 times as long as with passes, of
// 16 a side 450 times. Particles added one by one have unknown structure. Bodies that may not shrink, and bodies whose springs
// need small steps anyway, keep passes: at such steps solves took 30 to 200 times as long.
Taken taken_by_itself(const StretchComponent& component, const Body& body, const StretchLimitSettings& settings,
                      const LimitUse& use) {
  if (component.is_tree) return Taken::from_start;
  const bool fills = body.dimension != 1 && body.dimension != 2;
  if (fills || settings.max_compression < 1.0) return Taken::never;
  const bool begins_with_passes = use.may_collide || (use.takes_small_steps && component.is_elastic);
  return begins_with_passes ? Taken::when_handed_over : Taken::from_start;
}

}  // namespace

StretchNewton::StretchNewton(const SpringNetwork& network, const StretchLimitSettings& settings, const LimitUse& use)
    : network_(network), settings_(settings) {
  const bool chooses = settings.solver == StretchLimitSettings::Solver::automatic;
  std::size_t number = 0;
  for (StretchComponent& component : stretch_components(network, settings.kinds)) {
    const std::size_t of_component = number++;
    const Body& body = network.body_of(component.points.front());
    const Taken taken = chooses ? taken_by_itself(component, body, settings, use) : Taken::from_start;
    if (taken != Taken::from_start) {
      left_.insert(left_.end(), component.points.begin(), component.points.begin() + component.free_count);
    }
    if (taken == Taken::never) continue;
    components_.push_back({.solver = make_component_solver(network, std::move(component), settings, use),
                           .body = static_cast<std::size_t>(&body - network.bodies.data()),
                           .from_start = taken == Taken::from_start,
                           .number = of_component});
  }
  std::ranges::sort(left_);
}
StretchNewton::~StretchNewton() = default;

std::optional<int> StretchNewton::solve(const Points& before, Points& positions, double fall,
                                        const std::vector<StretchHandover>& handovers, const ImpulseRecorder& recorder) {
  const Points target = recorder.on() ? positions : Points();
  std::vector<std::optional<int>> iterations(components_.size());
  parallel_chunks(static_cast<Index>(components_.size()), 1, [&](Index begin, Index end) {
    for (auto p = static_cast<std::size_t>(begin); p < static_cast<std::size_t>(end); ++p) {
      const SolvedComponent& component = components_[p];
      if (component.is_solved(handovers)) iterations[p] = component.solver->solve(before, positions, fall);
    }
  });
  if (recorder.on()) record(target, positions, handovers, recorder);
  return iterations.empty() ? std::nullopt : *std::ranges::max_element(iterations);
}

// Components may share pins, so one records after the other.
void StretchNewton::record(const Points& target, const Points& positions, const std::vector<StretchHandover>& handovers,
                           const ImpulseRecorder& recorder) {
  if (impulses_.empty()) {
    std::vector<StretchComponent> all = stretch_components(network_, settings_.kinds);
    for (const SolvedComponent& component : components_) {
      impulses_.push_back(std::make_unique<ComponentImpulses>(std::move(all[component.number]), settings_));
    }
  }
  for (std::size_t p = 0; p < components_.size(); ++p) {
    if (components_[p].is_solved(handovers)) impulses_[p]->record(target, positions, recorder);
  }
}

double StretchNewton::turn() const {
  double largest = 0.0;
  for (const SolvedComponent& component : components_) largest = std::max(largest, component.solver->turn());
  return largest;
}

bool StretchNewton::solves(const Body& body) const {
  const auto first = std::ranges::lower_bound(left_, body.first_particle);
  return first == left_.end() || *first >= body.first_particle + body.particle_count;
}

bool StretchNewton::solves_any_of(std::size_t body) const {
  return std::ranges::any_of(components_,
                             [&](const SolvedComponent& component) { return component.body == body && component.from_start; });
}

bool StretchNewton::may_take_over(std::size_t body) const {
  return std::ranges::any_of(components_,
                             [&](const SolvedComponent& component) { return component.body == body && !component.from_start; });
}

bool StretchNewton::may_take_over_any() const { return !std::ranges::all_of(components_, &SolvedComponent::from_start); }

}  // namespace sprung
