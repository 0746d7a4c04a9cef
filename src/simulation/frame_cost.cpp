#include "simulation/frame_cost.h"
#include "dynamics/stretch_limit/stretch_limit.h"

#include "base/error.h"
#include "dynamics/stretch_limit/stretch_limit.h"
#include "network/model/spring_network.h"

#include <algorithm>
#include <chrono>
#include <numbers>
#include <vector>

namespace sprung {
namespace {

// Times [s] of one thread, from the frames with the most contact of the scenes in the table of frame times in
// tests/benchmark/README.md. A longer step needs more passes and meets more elements.
constexpr double kObstacleContact = 1.0e-6;  // per vertex and substep
constexpr double kBodyContact = 2.2e-6;      // per vertex and substep
constexpr double kNeighbour = 0.15e-6;       // per vertex within the thickness of another one, and substep
constexpr double kPass = 3e-9;               // per limited spring and pass of the stretch limit
constexpr double kLongStep = 2e-3;           // a step of this length [s] doubles the first two

// The fill-in of a network's factor decides how long a solve takes, so that solves are multiples of the measured time. Contact
// makes implicit Euler solve again, with a matrix that it factors anew. Newton's method solves more often the faster a body moves.
constexpr double kImplicitContact = 20.0;
constexpr double kNewtonMotion = 3.0;

// The share of a step's time in contact that does not become shorter with more threads.
constexpr double kSerialShare = 0.5;

struct Measured {
  std::vector<double> times;  ///< of steps [s]
  int substeps = 0;           ///< of the complete steps
  int complete = 0;           ///< number of steps
  std::optional<std::string> failure{};
};

Measured measure_steps(Simulator& simulator, const Clock& now) {
  Measured measured;
  const double begin = now();
  double step_begin = begin;
  const auto is_over = [&] { return now() - begin > kLongestMeasurement; };
  // Implicit steps have one substep, which nothing ends.
  const auto would_end_too_late = [&] {
    return !measured.times.empty() && step_begin - begin + 2.0 * measured.times.back() > kLongestMeasurement;
  };
  simulator.stop_when(is_over);
  try {
    while (measured.complete < kMostMeasuredSteps && !would_end_too_late() && !is_over()) {
      step_begin = now();
      measured.substeps += simulator.step().substeps;
      measured.times.push_back(now() - step_begin);
      ++measured.complete;
    }
  } catch (const StoppedError&) {
    measured.times.push_back(now() - step_begin);
  } catch (const StepError& error) {
    measured.failure = error.what();
  }
  simulator.stop_when({});
  return measured;
}

/// The lower one of two; 0 if there are none.
double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// Number of the vertices of a surface that have an element.
double vertex_count(const Surface& surface) {
  std::vector<char> used;
  const auto note = [&used](Index vertex) {
    if (static_cast<std::size_t>(vertex) >= used.size()) used.resize(static_cast<std::size_t>(vertex) + 1, 0);
    used[static_cast<std::size_t>(vertex)] = 1;
  };
  std::ranges::for_each(surface.triangles.reshaped(), note);
  std::ranges::for_each(surface.segments.reshaped(), note);
  return static_cast<double>(std::ranges::count(used, 1));
}

/// Number of vertices within the thickness of a vertex in a flat sheet or straight rope of the body's mean edge.
double neighbour_count(const SpringNetwork& network, const Body& body, double vertices) {
  const Springs& springs = network.springs;
  double length = 0.0;
  double count = 0.0;
  for (Index s = body.first_spring; s < body.first_spring + body.spring_count; ++s) {
    if (springs.kind[s] != SpringKind::structural) continue;
    length += springs.rest_length[s];
    count += 1.0;
  }
  if (length == 0.0) return 0.0;
  const double edges = body.material.thickness / (length / count);
  const double within = body.surface.triangles.cols() > 0 ? std::numbers::pi * edges * edges : 2.0 * edges;
  return std::min(within, vertices);
}

/// Time [s] that contact of all vertices adds to a substep of `dt` [s], with one thread.
double contact_time(const Simulator& simulator, double dt) {
  const SpringNetwork& network = simulator.network();
  const bool obstacles = !simulator.obstacles().empty();
  const bool several = std::ranges::count_if(network.bodies, [](const Body& body) { return body.contact.others; }) > 1;
  const double long_step = 1.0 + dt / kLongStep;
  double time = 0.0;
  for (const Body& body : network.bodies) {
    const double vertices = vertex_count(body.surface);
    if (obstacles) time += kObstacleContact * long_step * vertices;
    if (body.contact.self || (several && body.contact.others)) {
      time += (kBodyContact * long_step + kNeighbour * neighbour_count(network, body, vertices)) * vertices;
    }
  }
  return time;
}

/// Time [s] of all passes of the stretch limit in a substep, with one thread.
double pass_time(const Simulator& simulator) {
  const auto& limit = simulator.settings().stretch_limit;
  if (!limit) return 0.0;
  const SpringNetwork& network = simulator.network();
  double springs = 0.0;
  for (const Body& body : network.bodies) {
    if (!body.stretch_limited) continue;
    for (Index s = body.first_spring; s < body.first_spring + body.spring_count; ++s) {
      springs += std::ranges::count(limit->kinds, network.springs.kind[s]) > 0 ? 1.0 : 0.0;
    }
  }
  return kPass * passes_of(*limit, simulator.settings().inner_substeps > 1) * springs;
}

}  // namespace

double steady_time() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

FrameCost measure_frame_cost(Simulator& simulator, int steps_per_frame, int threads, const Clock& now) {
  const double step = simulator.settings().step;
  const bool implicit = std::holds_alternative<ImplicitEulerSettings>(simulator.settings().integrator);
  const bool newton = simulator.stretch_solver().starts_with("newton");
  const double passes = newton ? 0.0 : pass_time(simulator);
  const bool touches = contact_time(simulator, step) > 0.0;
  const Measured measured = measure_steps(simulator, now);
  // A step in which all particles sleep has no substep.
  const double substeps = std::max(1.0, static_cast<double>(measured.substeps) / std::max(1, measured.complete));
  const double solves = (touches && implicit ? kImplicitContact : 1.0) * (newton ? kNewtonMotion : 1.0);
  const double contact_steps = std::max(1.0, substeps / simulator.settings().inner_substeps);
  const double added = contact_steps * contact_time(simulator, step / contact_steps) + substeps * passes;
  const double free = median(measured.times);
  const double full = solves * free + added * (kSerialShare + (1.0 - kSerialShare) / threads);
  return {.steps = measured.complete,
          .free = steps_per_frame * free,
          .full = steps_per_frame * full,
          .can_touch = touches,
          .failure = measured.failure};
}

}  // namespace sprung
