#include "dynamics/stretch_newton/stretch_newton.h"

#include "base/parallel.h"
#include "dynamics/stretch_newton/component_impulses.h"
#include "dynamics/stretch_newton/component_newton.h"
#include "dynamics/stretch_newton/two_level_newton.h"
#include "dynamics/tethers/limited_springs.h"

#include <algorithm>
#include <utility>

namespace sprung {
namespace {

enum class Taken : std::uint8_t { from_start, when_handed_over, never };

// Solids are left to passes, as their factors fill: a hanging solid of 8 particles a side took 50 times as long as with passes, of
// 16 a side 450 times. Particles added one by one have unknown structure. Bodies that may not shrink, and bodies whose springs
// need small steps anyway, keep passes: at such steps solves took 30 to 200 times as long.
bool fills(const Body& body) { return body.dimension != 1 && body.dimension != 2; }

Taken taken_by_itself(const StretchComponent& component, const Body& body, const StretchLimitSettings& settings,
                      const LimitUse& use) {
  if (component.is_tree || !component.rods.empty()) return Taken::from_start;
  if (fills(body) || settings.max_compression < 1.0) return Taken::never;
  const bool begins_with_passes = use.may_collide || (use.takes_small_steps && component.is_elastic);
  return begins_with_passes ? Taken::when_handed_over : Taken::from_start;
}

}  // namespace

StretchNewton::StretchNewton(const SpringNetwork& network, const StretchLimitSettings& settings, const LimitUse& use)
    : network_(network), settings_(settings), use_(use) {
  make_components({});
  std::ranges::sort(left_);
}
StretchNewton::~StretchNewton() = default;

/// With rods, springs of bodies that are left to passes are not part of a component.
void StretchNewton::make_components(std::span<const RodRow> rods) {
  const bool chooses = settings_.solver == StretchLimitSettings::Solver::automatic;
  std::size_t number = 0;
  for (StretchComponent& component : all_components(rods)) {
    const std::size_t of_component = number++;
    const Body& body = network_.body_of(component.points[component.links.front().first]);
    const Taken taken = chooses ? taken_by_itself(component, body, settings_, use_) : Taken::from_start;
    if (taken != Taken::from_start && rods.empty()) {
      left_.insert(left_.end(), component.points.begin(), component.points.begin() + component.free_count);
    }
    if (taken == Taken::never) continue;
    std::unique_ptr<ComponentSolver> solver;
    ComponentNewton* with_rods = nullptr;
    if (component.rods.empty()) {
      solver = make_component_solver(network_, std::move(component), settings_, use_);
    } else {
      auto newton = std::make_unique<ComponentNewton>(std::move(component), settings_);
      with_rods = newton.get();
      solver = std::move(newton);
    }
    components_.push_back({.solver = std::move(solver),
                           .with_rods = with_rods,
                           .body = static_cast<std::size_t>(&body - network_.bodies.data()),
                           .from_start = taken == Taken::from_start,
                           .number = of_component});
  }
}

std::vector<StretchComponent> StretchNewton::all_components(std::span<const RodRow> rods) const {
  std::vector<Index> springs = limited_springs(network_, settings_.kinds);
  const bool leaves_solids = !rods.empty() && settings_.solver == StretchLimitSettings::Solver::automatic;
  if (leaves_solids) std::erase_if(springs, [&](Index s) { return fills(network_.body_of(network_.springs.first[s])); });
  return stretch_components(network_, springs, rods);
}

/// Makes the components anew if other rods join them than before.
void StretchNewton::join(std::span<const RodRow> rods) {
  const auto alike = [](const RodRow& a, const RodRow& b) {
    return a.count == b.count && a.particles == b.particles && a.weights == b.weights;
  };
  if (std::ranges::equal(rods, joined_, alike)) return;
  joined_.assign(rods.begin(), rods.end());
  components_.clear();
  impulses_.clear();
  make_components(rods);
}

std::optional<int> StretchNewton::solve(const Points& before, Points& positions, double steady_displacement,
                                        const std::vector<StretchHandover>& handovers, std::span<const RodRow> rods,
                                        std::vector<Vector3>& pushes, const ImpulseRecorder& recorder) {
  join(settings_.max_compression < 1.0 ? std::span<const RodRow>() : rods);
  for (const SolvedComponent& component : components_) {
    if (component.with_rods != nullptr) component.with_rods->set_rods(rods);
  }
  const auto solves = solve(before, positions, steady_displacement, handovers, recorder);
  for (const SolvedComponent& component : components_) {
    if (component.with_rods != nullptr) component.with_rods->record(recorder, pushes);
  }
  return solves;
}

std::optional<int> StretchNewton::solve(const Points& before, Points& positions, double steady_displacement,
                                        const std::vector<StretchHandover>& handovers, const ImpulseRecorder& recorder) {
  const Points target = recorder.on() ? positions : Points();
  std::vector<std::optional<int>> iterations(components_.size());
  parallel_chunks(static_cast<Index>(components_.size()), 1, [&](Index begin, Index end) {
    for (auto p = static_cast<std::size_t>(begin); p < static_cast<std::size_t>(end); ++p) {
      const SolvedComponent& component = components_[p];
      if (component.is_solved(handovers)) iterations[p] = component.solver->solve(before, positions, steady_displacement);
    }
  });
  if (recorder.on()) record(target, positions, handovers, recorder);
  return iterations.empty() ? std::nullopt : *std::ranges::max_element(iterations);
}

// Components may share pins, so one records after the other.
void StretchNewton::record(const Points& target, const Points& positions, const std::vector<StretchHandover>& handovers,
                           const ImpulseRecorder& recorder) {
  if (impulses_.empty()) {
    std::vector<StretchComponent> all = all_components(joined_);
    for (const SolvedComponent& component : components_) {
      impulses_.push_back(std::make_unique<ComponentImpulses>(std::move(all[component.number]), settings_));
    }
  }
  for (std::size_t p = 0; p < components_.size(); ++p) {
    if (components_[p].is_solved(handovers) && components_[p].with_rods == nullptr)
      impulses_[p]->record(target, positions, recorder);
  }
}

void StretchNewton::forget() {
  for (const SolvedComponent& component : components_) component.solver->forget();
}

void StretchNewton::save(ByteWriter& to) const {
  to.write(joined_);
  for (const SolvedComponent& component : components_) component.solver->save(to);
}

void StretchNewton::load(BinaryReader& from) {
  std::vector<RodRow> rods;
  from.read(rods);
  join(rods);
  for (const SolvedComponent& component : components_) component.solver->load(from);
}

double StretchNewton::deformation() const {
  double largest = 0.0;
  for (const SolvedComponent& component : components_) largest = std::max(largest, component.solver->deformation());
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
