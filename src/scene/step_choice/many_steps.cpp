#include "scene/step_choice/many_steps.h"

#include "base/format.h"
#include "base/problem_list.h"
#include "dynamics/forces/material_dampers.h"
#include "network/step_adjustment.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace sprung {
namespace {

constexpr int kManySteps = 1000;

// If a spring or bend bounds the step, its response rate times the step is about 1. Below this value, something else bounds
// the step.
constexpr double kLeastResponse = 0.05;

// An edge this much shorter than the mean of its body is an accident of the mesh.
constexpr double kShort = 0.1;

constexpr int kDigits = 3;
constexpr int kPositionDigits = 5;

/// A cause of small steps. The response rate of particles is [1/s]: the square root of stiffness over mass, or damping over mass.
struct Demand {
  double rate = 0.0;
  Index particle = 0;           ///< the lightest of the particles
  std::array<Index, 2> edge{};  ///< a spring's ends, or those of the shortest edge of a bend
  double length = 0.0;          ///< of that edge at rest [m]
  double constant = 0.0;
  std::string source{};
  const char* unit = "";
  const char* remedy = "";
};

/// The lightest particle that is not pinned.
Index lightest(const SpringNetwork& network, std::span<const Index> particles) {
  return std::ranges::max(particles, {}, [&](Index i) { return network.inverse_masses[i]; });
}

Demand demand_of_springs(const SpringNetwork& network, const std::vector<double>& constants, bool damp) {
  const Springs& springs = network.springs;
  Demand found{.unit = damp ? " N s/m damping" : " N/m", .remedy = damp ? "damping" : "stiffness"};
  for (Index s = 0; s < springs.count(); ++s) {
    const double per_mass = constants[s] * (network.inverse_masses[springs.first[s]] + network.inverse_masses[springs.second[s]]);
    const double rate = damp ? per_mass : std::sqrt(per_mass);
    if (!(rate > found.rate)) continue;
    found.rate = rate;
    found.particle = lightest(network, std::array{springs.first[s], springs.second[s]});
    found.constant = constants[s];
    found.edge = {springs.first[s], springs.second[s]};
    found.length = springs.rest_length[s];
    found.source = std::string(kSpringKindNames[static_cast<std::size_t>(springs.kind[s])]) + " springs";
  }
  return found;
}

/// Of all bends, with the constants of `constants_of_bends`. For bends in line, the angle changes by 1 / length times the
/// displacement of an end, and by the sum of both times that of the middle.
Demand demand_of_bends(const SpringNetwork& network, const std::vector<double>& constants, bool damp) {
  Demand found{.source = "angle bends", .unit = damp ? " N m s damping" : " N m", .remedy = damp ? "damping" : "stiffness"};
  using Edge = std::pair<double, std::array<Index, 2>>;  // length, ends
  const auto note = [&](std::span<const Index> particles, std::span<const double> weights, double constant, const Edge& shortest) {
    double per_mass = 0.0;
    for (std::size_t k = 0; k < particles.size(); ++k) {
      per_mass += constant * weights[k] * weights[k] * network.inverse_masses[particles[k]];
    }
    const double rate = damp ? per_mass : std::sqrt(per_mass);
    if (!(rate > found.rate)) return;
    found.rate = rate;
    found.particle = lightest(network, particles);
    found.constant = constant;
    found.length = shortest.first;
    found.edge = shortest.second;
  };
  const AngleBends& bends = network.angle_bends;
  for (Index e = 0; e < bends.count(); ++e) {
    const double before = 1.0 / bends.length_before[e];
    const double after = 1.0 / bends.length_after[e];
    const Edge shortest = std::min(Edge{bends.length_before[e], {bends.before[e], bends.middle[e]}},
                                   Edge{bends.length_after[e], {bends.middle[e], bends.after[e]}});
    note(std::array{bends.before[e], bends.middle[e], bends.after[e]}, std::array{before, -before - after, after}, constants[e],
         shortest);
  }
  const FaceBends& faces = network.face_bends;
  for (Index f = 0; f < faces.count(); ++f) {
    const double constant = constants[static_cast<std::size_t>(bends.count() + f)];
    const BendStencil stencil = stencil_of(faces, network.hinges, f);
    Edge shortest{std::numeric_limits<double>::infinity(), {}};
    for (const Index hinge : faces.hinges[f]) {
      if (hinge == kNone) continue;
      const auto [a, b, c, d] = network.hinges.particles[hinge];
      shortest = std::min(shortest, Edge{(network.positions.col(a) - network.positions.col(b)).norm(), {a, b}});
    }
    for (const std::array<double, 6>& weights : weights_of(faces, network.hinges, f)) {
      note(stencil.particles, weights, constant, shortest);
    }
  }
  return found;
}

/// Of the body's springs; NaN without any.
double mean_length(const SpringNetwork& network, const Body& body) {
  const auto first = network.springs.rest_length.begin() + body.first_spring;
  return std::accumulate(first, first + body.spring_count, 0.0) / body.spring_count;
}

/// Implicit Euler solves a system a step, and many where surfaces touch. Measured, that is slower than thousands of small steps in
/// contact, and in any solid.
bool is_implicit_faster(const Scene& scene, const SpringNetwork& network) {
  const auto has_cells = [](const Body& body) { return !body.cells.empty(); };
  return scene.obstacles.empty() && !bodies_may_collide(network) && std::ranges::none_of(network.bodies, has_cells);
}

/// What the user can change: the mesh of a material, and the numbers that they gave themselves.
std::string remedy_for(const Demand& demand, const Scene& scene, const SpringNetwork& network, const Body& body) {
  const auto found = std::ranges::find(scene.bodies, body.name, &BodyScene::name);
  const bool has_material = found != scene.bodies.end() && !found->preset.empty();
  if (demand.length < kShort * mean_length(network, body)) {
    std::string remedy = "This edge is far shorter than the others of the body: merge the two vertices";
    if (!has_material || body.particle_count < kLeastAdjusted) return remedy;
    if (!found->preset_mass) return remedy + ", or leave the mass to the material, which permits \"mass_scaling\"";
    return scene.mass_scaling < kMassScaling ? remedy + ", or leave out \"mass_scaling\"" : remedy;
  }
  std::string remedy = has_material ? "Use a coarser mesh or resolution" : std::string("Use less ") + demand.remedy + ", more mass";
  const bool implicit = is_implicit_faster(scene, network);
  if (implicit) remedy += remedy.ends_with("mass") ? " or \"implicit_euler\"" : ", or \"implicit_euler\"";
  return remedy;
}

std::string reason(const Scene& scene, const SpringNetwork& network, double step) {
  // The dampers of materials do not bound the step.
  const ElementConstants springs = springs_without_material_dampers(network);
  const ElementConstants bends = bends_without_material_dampers(network);
  const Demand largest =
      std::max({demand_of_springs(network, springs.stiffness, false), demand_of_springs(network, springs.damping, true),
                demand_of_bends(network, bends.stiffness, false), demand_of_bends(network, bends.damping, true)},
               [](const Demand& a, const Demand& b) { return a.rate < b.rate; });
  if (largest.rate * step < kLeastResponse) return "penalty contact or air drag requires that. Use less of it";
  const Body& body = network.body_of(largest.particle);
  return "body \"" + body.name + "\" has " + largest.source + " of " + format_number(largest.constant, kDigits) + largest.unit +
         " at particles of " + format_number(network.masses[largest.particle], kDigits) +
         " kg, the one that needs the smallest step from " + vector_text(network.positions.col(largest.edge[0]), kPositionDigits) +
         " to " + vector_text(network.positions.col(largest.edge[1]), kPositionDigits) + ", " +
         format_number(largest.length, kDigits) + " m long. " + remedy_for(largest, scene, network, body);
}

}  // namespace

std::optional<std::string> many_steps_warning(const Scene& scene, const SpringNetwork& network, const StepChoice& choice,
                                              bool by_passes) {
  const int count = choice.steps_per_frame * choice.inner_substeps;
  const double step = choice.step / choice.inner_substeps;
  if (count <= kManySteps) return std::nullopt;
  const std::string steps = "\"step\": \"auto\" takes " + std::to_string(count) +
                            (choice.inner_substeps > 1 ? " substeps of " : " steps of ") + format_number(step, kDigits) +
                            " s a frame: ";
  if (by_passes) {
    return steps + "passes of the stretch limit require that. Use more \"iterations\" or \"solver\": \"newton\".";
  }
  if (std::holds_alternative<ExplicitEulerSettings>(scene.settings.integrator)) {
    return steps + "explicit Euler gains energy in larger steps. Use \"symplectic_euler\".";
  }
  return steps + reason(scene, network, step) + ".";
}

}  // namespace sprung
