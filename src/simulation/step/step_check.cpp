#include "simulation/step/step_check.h"

#include "base/format.h"
#include "dynamics/attachments/attachment_springs.h"
#include "network/model/activity.h"
#include "simulation/model/force_factory.h"
#include "simulation/step/frame_steps.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

namespace sprung {
namespace {

// A bounce is half a period of the penalty spring. In three steps or more its energy error is below a tenth. In one or two steps
// the depth differs between entry and exit, and energy rises: a cloth of 0.9 J reached 12 J after two bounces, damped or not.
double step_for_penalty(const IntegratorSettings& settings, const SpectralBounds& bounds) {
  if (bounds.penalty == 0.0 || std::holds_alternative<ImplicitEulerSettings>(settings)) {
    return std::numeric_limits<double>::infinity();
  }
  return 1.0 / std::sqrt(bounds.penalty);
}

bool grows_transversally(const IntegratorSettings& integrator, const SpectralBounds& bounds) {
  return std::holds_alternative<ExplicitEulerSettings>(integrator) && bounds.elastic > 0.0 && bounds.least_drag == 0.0;
}

/// Whether fast modes, or motions across taut springs, grow with every step.
bool gains_energy(const IntegratorSettings& integrator, const SpectralBounds& bounds, double step) {
  return std::isfinite(growth_time(integrator, bounds, step)) || grows_transversally(integrator, bounds);
}

/// What to use instead of the step.
struct StepAdvice {
  std::string text;              ///< completes "use"
  std::optional<double> step{};  ///< [s]
};

StepAdvice advise_at_most(const SimulatorSettings& settings, double largest) {
  const auto step = step_to_type(settings.frame_rate, largest);
  if (!step) return {"less stiffness, more mass, or a higher frame_rate"};
  return {"a step of at most " + format_number(*step) + " s", step};
}

// A smaller step of a scheme that gains energy still gains it.
StepAdvice advise_step(const SimulatorSettings& settings, const SpectralBounds& bounds) {
  const double largest = advised_step(settings.integrator, bounds);
  if (!gains_energy(settings.integrator, bounds, std::min(settings.longest_substep(), largest))) {
    StepAdvice advice = advise_at_most(settings, largest);
    if (advice.step) advice.text += ", or \"auto\"";
    return advice;
  }
  const double largest_symplectic = advised_step(SymplecticEulerSettings{}, bounds);
  if (settings.longest_substep() <= largest_symplectic) return {"\"symplectic_euler\""};
  StepAdvice advice = advise_at_most(settings, largest_symplectic);
  return {"\"symplectic_euler\" with " + advice.text + (advice.step ? " or \"auto\"" : "")};
}

std::atomic<std::int64_t> counted_bounds = 0;

constexpr double kStableFraction = 0.9;

double advised_for(const IntegratorSettings& settings, const SpectralBounds& bounds) {
  return std::min({kStableFraction * largest_stable_step(settings, bounds), resonant_step(settings, bounds),
                   step_for_penalty(settings, bounds)});
}

/// Without the dampers of materials.
double advised_for_springs(const IntegratorSettings& settings, SpectralBounds bounds) {
  bounds.undamped = bounds.elastic;
  return advised_for(settings, bounds);
}

/// The elements of all forces, and the force that alone would permit the smallest step.
class StepElements {
 public:
  StepElements(const SpringNetwork& network, const IntegratorSettings& integrator) : network_(network), integrator_(integrator) {}

  void add(const std::string& name, const std::vector<LinearElement>& elements) {
    const double step = largest_stable_step(integrator_, quick_bounds(elements, network_.inverse_masses));
    if (step < smallest_step_) {
      smallest_step_ = step;
      strictest_ = name;
    }
    elements_.insert(elements_.end(), elements.begin(), elements.end());
  }

  void add(const Force& force) {
    std::vector<LinearElement> elements;
    force.append_elements(elements);
    add(force.name(), elements);
  }

  [[nodiscard]] SpectralBounds bounds() const {
    SpectralBounds bounds = spectral_bounds(elements_, network_.inverse_masses);
    bounds.strictest = strictest_;
    return bounds;
  }

 private:
  const SpringNetwork& network_;
  const IntegratorSettings& integrator_;
  std::vector<LinearElement> elements_;
  double smallest_step_ = std::numeric_limits<double>::infinity();
  std::string strictest_;
};

SpectralBounds bounds_of(const SpringNetwork& network, const SimulatorSettings& settings, bool has_obstacles,
                         const std::vector<std::shared_ptr<Force>>& external) {
  StepElements elements(network, settings.integrator);
  for (const auto& force : network_forces(network, settings)) elements.add(*force);
  if (const auto air = surface_air(network, settings)) elements.add(*air);
  const bool penalty = has_obstacles && settings.contact.response == ContactSettings::Response::penalty;
  if (penalty) elements.add("penalty contact", penalty_elements(network, settings));
  const std::vector<Obstacle> none;  // which bound no step
  if (!network.attachments.empty()) elements.add(AttachmentSprings(network, none, settings.step, false));
  for (const auto& force : external) elements.add(*force);
  SpectralBounds bounds = elements.bounds();
  if (penalty) bounds.penalty = settings.contact.stiffness * network.inverse_masses.maxCoeff();
  return bounds;
}

}  // namespace

std::int64_t bounds_count() { return counted_bounds; }

SpectralBounds simulation_bounds(const SpringNetwork& network, const SimulatorSettings& settings, bool has_obstacles,
                                 const std::vector<std::shared_ptr<Force>>& external) {
  ++counted_bounds;
  const bool change = !std::ranges::all_of(network.pins, &Pin::holds_always);
  return bounds_of(change ? freest(network) : network, settings, has_obstacles, external);
}

LimitUse limit_use(const SpringNetwork& network, const SimulatorSettings& settings, bool has_obstacles) {
  return {.may_collide = has_obstacles || bodies_may_collide(network),
          .takes_small_steps = !std::holds_alternative<ImplicitEulerSettings>(settings.integrator)};
}

double advised_step(const IntegratorSettings& settings, const SpectralBounds& bounds) {
  if (bounds.material_damping == 0.0 || !may_split_dampers(settings)) return advised_for(settings, bounds);
  const double together = advised_for(settings, with_all_dampers(bounds));
  return together >= advised_for_springs(settings, bounds) ? together : advised_for(settings, bounds);
}

bool splits_dampers(const SimulatorSettings& settings, const SpectralBounds& bounds) {
  return bounds.material_damping > 0.0 && may_split_dampers(settings.integrator) &&
         settings.longest_substep() > kStableFraction * largest_stable_step(settings.integrator, with_all_dampers(bounds));
}

bool is_unstable(double step, double largest_stable) {
  constexpr double kRounding = 1.0 + 1.0e-9;  // the bound has a larger margin
  return step > kRounding * largest_stable;
}

Problem unstable_step(const SimulatorSettings& settings, const SpectralBounds& bounds) {
  return {.key = "step",
          .value = format_number(settings.longest_substep()),
          .rule = "is beyond the largest stable step, " + format_upper_bound(largest_stable_step(settings.integrator, bounds)) +
                  " s, bounded by " + bounds.strictest,
          .remedy = "use " + advise_step(settings, bounds).text +
                    "; \"stability\": \"warn\" (StabilityCheck::warn) runs it nevertheless"};
}

std::vector<std::string> check_step(const SimulatorSettings& settings, const SpectralBounds& bounds) {
  const double step = settings.longest_substep();
  if (!(step > 0.0) || !std::isfinite(step)) {
    throw InputError({.key = "step", .value = format_number(step), .rule = "must be a positive number of seconds"});
  }
  const std::string remedy = " Use " + advise_step(settings, bounds).text + ".";
  if (is_unstable(step, largest_stable_step(settings.integrator, bounds))) {
    const Problem problem = unstable_step(settings, bounds);
    if (settings.stability == StabilityCheck::refuse) throw InputError(problem);
    return {"step = " + problem.value + " " + problem.rule + ": the simulation is likely to diverge." + remedy};
  }
  const double growth = growth_time(settings.integrator, bounds, step);
  if (std::isfinite(growth)) {
    return {"explicit Euler gains energy at any step: the fastest mode of the springs grows by a factor of e every " +
            format_number(growth, 2) + " s." + remedy};
  }
  if (!grows_transversally(settings.integrator, bounds)) return {};
  return {
      "explicit Euler gains energy at any step: dampers compensate it along the springs, but not perpendicular to taut springs." +
      remedy};
}

void set_divergence_remedy(const SimulatorSettings& settings, const SpectralBounds& bounds, StepFailure& failure) {
  const bool gains = gains_energy(settings.integrator, bounds, settings.longest_substep());
  const bool too_large = settings.longest_substep() > advised_step(settings.integrator, bounds);
  if (!gains && !too_large && !failure.remedy.empty()) return;
  const StepAdvice advice =
      gains || too_large ? advise_step(settings, bounds) : advise_at_most(settings, 0.5 * settings.longest_substep());
  failure.smaller_step = advice.step;
  failure.remedy = (gains ? "explicit Euler gains energy at any step; use " : "use ") + advice.text;
  if (!gains && !too_large) failure.remedy += ", less stiffness, or slower motion";
}

}  // namespace sprung
