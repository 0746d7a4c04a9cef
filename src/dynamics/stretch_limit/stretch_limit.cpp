#include "dynamics/stretch_limit/stretch_limit.h"

#include "base/parallel.h"
#include "dynamics/stretch_limit/batch_recorder.h"
#include "dynamics/stretch_limit/step_estimate.h"
#include "dynamics/stretch_limit/stretch_kernel.h"
#include "dynamics/stretch_newton/stretch_newton.h"
#include "dynamics/tethers/limited_springs.h"
#include "dynamics/tethers/long_range_attachments.h"
#include "dynamics/tethers/lra_paths.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sprung {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Without any tolerance a limit is never reached exactly: steps are chosen for this excess then.
constexpr double kLeastExcess = 1.0e-3;

// A hanging body bounces at first, to 1.5 times the wanted excess. A smaller step would remove the excess faster and increase the
// bounce, so only a larger excess, which needs motion, asks for smaller steps.
constexpr double kInnerMargin = 3.0;

// Springs that may shrink by no more than this fraction of the excess hardly let a surface neck.
constexpr double kLeastPlay = 0.1;

/// Extremes of the lengths that `lengths_of` measures in tasks [begin, end).
template <class LengthsOf>
SquaredLengths extremes(const SpringBatches& batches, Index begin, Index end, const LengthsOf& lengths_of) {
  std::vector<SquaredLengths> of_tasks(end - begin);
  parallel_chunks(end - begin, 1, [&](Index first, Index last) {
    for (Index task = first; task < last; ++task) {
      of_tasks[task] = lengths_of(BatchRange{batches.task_begin[begin + task], batches.task_begin[begin + task + 1]});
    }
  });
  SquaredLengths all;
  for (const SquaredLengths& of_task : of_tasks) all.include(of_task);
  return all;
}

LengthRange length_range(const StretchLimitSettings& settings) {
  return {.least = 1.0 - settings.max_compression, .most = 1.0 + settings.max_stretch};
}

// Layers of a cloth that meet within a step are stopped by truncation, which knows no springs: those between stopped and moving
// particles stretch. Layers of a body that falls by its own extent L reach a speed of about sqrt(a L), so they need a step in which
// they move by at most half the thickness. Measured on a cloth of 64 x 64 that drapes over a bunny: 36 % of stretch with a third of
// these steps, 3 % with these. Springs with stiffness pull such particles back by themselves.
double step_for_layers(const SpringNetwork& network, const Body& body, double acceleration) {
  const double thickness = body.material.thickness;
  if (!body.contact.self || thickness == 0.0 || acceleration == 0.0) return kInfinity;
  const auto springs_end = network.springs.stiffness.begin() + body.first_spring + body.spring_count;
  if (std::any_of(springs_end - body.spring_count, springs_end, [](double stiffness) { return stiffness > 0.0; })) return kInfinity;
  const auto positions = network.positions.middleCols(body.first_particle, body.particle_count);
  const double extent = (positions.rowwise().maxCoeff() - positions.rowwise().minCoeff()).maxCoeff();
  return 0.5 * thickness / std::sqrt(acceleration * extent);
}

/// Whether springs may shrink by no more than a fraction of the wanted excess.
bool prevents_shrinking(const StretchLimitSettings& settings) {
  return settings.max_compression <= kLeastPlay * wanted_excess(settings);
}

}  // namespace

double wanted_excess(const StretchLimitSettings& settings) {
  return std::max(0.5 * settings.max_stretch + settings.tolerance, kLeastExcess);
}

double tolerated_excess(const StretchLimitSettings& settings, bool has_inner_substeps) {
  return (has_inner_substeps ? kInnerMargin : 1.0) * wanted_excess(settings);
}

int passes_of(const StretchLimitSettings& settings, bool has_inner_substeps) {
  return has_inner_substeps ? std::max(1, settings.iterations / 2) : settings.iterations;
}

StretchLimit::StretchLimit(const SpringNetwork& network, const StretchLimitSettings& settings, const LimitUse& use)
    : network_(network), settings_(settings), batches_(std::make_unique<SpringBatches>(network, settings.kinds)) {
  if (settings.tethers) tethers_ = std::make_unique<LongRangeAttachments>(network, settings.kinds, settings.max_stretch);
  if (settings.solver == StretchLimitSettings::Solver::gauss_seidel) return;
  newton_ = std::make_unique<StretchNewton>(network, settings, use);
}
StretchLimit::~StretchLimit() = default;

double StretchLimit::project(const Points& before, Points& positions, double relaxation, const ImpulseRecorder& recorder) const {
  if (tethers_ && recorder.on()) tethers_->project(positions, network_.masses, recorder);
  if (tethers_ && !recorder.on()) tethers_->project(positions);
  const LengthRange range = length_range(settings_);
  const auto project_range = [&](const BatchRange& batch_range) {
    return project_springs(*batches_, batch_range, range, relaxation, before.data(), positions.data());
  };
  std::optional<BatchRecorder> recorded;
  if (recorder.on()) recorded.emplace(network_, *batches_);
  SquaredLengths measured;
  for (std::size_t stage = 0; stage + 1 < batches_->stage_begin.size(); ++stage) {
    measured.include(
        extremes(*batches_, batches_->stage_begin[stage], batches_->stage_begin[stage + 1], [&](const BatchRange& batch_range) {
          return recorded ? recorded->project(batch_range, positions, project_range) : project_range(batch_range);
        }));
  }
  if (recorded) recorded->write_to(recorder, positions);
  return measured.excess(range);
}

std::optional<int> StretchLimit::solve(const Points& before, Points& positions, double steady_displacement,
                                       const std::vector<StretchHandover>& handovers, const ImpulseRecorder& recorder) const {
  return newton_ ? newton_->solve(before, positions, steady_displacement, handovers, recorder) : std::nullopt;
}

std::optional<int> StretchLimit::solve(const Points& before, Points& positions, double steady_displacement,
                                       const std::vector<StretchHandover>& handovers, std::span<const RodRow> rods,
                                       std::vector<Vector3>& pushes, const ImpulseRecorder& recorder) const {
  return newton_ ? newton_->solve(before, positions, steady_displacement, handovers, rods, pushes, recorder) : std::nullopt;
}

double StretchLimit::excess(const Points& positions) const {
  const auto lengths_of = [&](const BatchRange& batch_range) { return measure_springs(*batches_, batch_range, positions.data()); };
  return extremes(*batches_, 0, batches_->stage_begin.back(), lengths_of).excess(length_range(settings_));
}

double StretchLimit::excess(const Points& positions, const Body& body) const {
  const Springs& springs = network_.springs;
  SquaredLengths measured;
  for (Index s = body.first_spring; s < body.first_spring + body.spring_count; ++s) {
    if (!is_limited(network_, settings_.kinds, s)) continue;
    const double squared = (positions.col(springs.second[s]) - positions.col(springs.first[s])).squaredNorm();
    const double relative = squared / (springs.rest_length[s] * springs.rest_length[s]);
    measured.include({.longest = relative, .shortest = relative});
  }
  return measured.excess(length_range(settings_));
}

const StretchLimitSettings& StretchLimit::settings() const { return settings_; }

std::string StretchLimit::chosen_solver() const {
  std::string solved;
  for (std::size_t b = 0; newton_ && b < network_.bodies.size(); ++b) {
    if (!newton_->solves_any_of(b)) continue;
    const Body& body = network_.bodies[b];
    solved +=
        std::string(solved.empty() ? "" : ", ") + (newton_->solves(body) ? "\"" : "chains and trees of \"") + body.name + "\"";
  }
  if (newton_ && newton_->solves_any() && newton_->solves_all()) return "newton";
  const std::string passes = solved.empty() ? "gauss_seidel" : "newton for " + solved + ", gauss_seidel for the rest";
  const bool may_change = newton_ && newton_->may_take_over_any();
  return passes + (may_change ? ", then newton for what keeps missing the limit" : "");
}

bool StretchLimit::may_be_handed_over(std::size_t body) const { return newton_ && newton_->may_take_over(body); }

// At rest each step adds g dt^2 to each particle, and each pass passes on a fraction of it. Measured on hanging cloths: after
// tethers 4 passes were worth 2.6 and 32 worth 10; where springs may not shrink, 2, 4, 8 and 32 over-relaxed passes were worth 2,
// 10, 29 and 280. A body that sags between its pins gains nothing from tethers.
double StretchLimit::suggested_step(double acceleration) const {
  const SpringGraph graph(network_, limited_springs(network_, settings_.kinds));
  const std::vector<Tether> tethers = settings_.tethers ? find_tethers(network_, settings_.kinds) : std::vector<Tether>{};
  const double excess = wanted_excess(settings_);
  const double passes = settings_.iterations;
  const auto gained_by = [&](const Body& body) {
    const bool shared = prevents_shrinking(settings_) && is_rigid(body, graph);
    const double alone = largest_load(network_, body, graph, {.tethers = false, .shared = shared}) / passes;
    if (!are_pins_taut(network_, body, tethers, settings_.max_stretch)) return alone;
    const double worth = shared ? 1.0 + std::pow(passes - 1.0, 1.5) : std::cbrt(passes * passes);
    return std::min(alone, largest_load(network_, body, graph, {.tethers = true, .shared = shared}) / worth);
  };
  double smallest = kInfinity;
  for (const Body& body : network_.bodies) {
    if (newton_ && newton_->solves(body) && settings_.max_compression == 1.0) continue;
    const double gained = acceleration * gained_by(body);
    if (gained > 0.0) smallest = std::min(smallest, std::sqrt(excess / gained));
  }
  return smallest;
}

double StretchLimit::step_for_layers(double acceleration) const {
  double smallest = kInfinity;
  for (const Body& body : network_.bodies) {
    if (newton_ && newton_->solves(body) && settings_.max_compression == 1.0) continue;
    smallest = std::min(smallest, sprung::step_for_layers(network_, body, acceleration));
  }
  return smallest;
}

bool StretchLimit::uses_newton() const {
  for (std::size_t b = 0; newton_ && b < network_.bodies.size(); ++b) {
    if (newton_->solves_any_of(b)) return true;
  }
  return false;
}

bool StretchLimit::follows_deformation(const std::vector<StretchHandover>& handovers) const {
  if (!newton_ || settings_.max_compression < 1.0) return false;
  for (std::size_t b = 0; b < network_.bodies.size(); ++b) {
    const bool handed_over = !handovers.empty() && handovers[b].solved_since && newton_->may_take_over(b);
    if (!handed_over && !newton_->solves(network_.bodies[b])) return false;
  }
  return newton_->solves_any();
}

bool StretchLimit::may_follow_deformation() const {
  return !follows_deformation() && follows_deformation(std::vector<StretchHandover>(network_.bodies.size(), {.solved_since = 0}));
}

void StretchLimit::save_solves(ByteWriter& to) const {
  if (newton_) newton_->save(to);
}

void StretchLimit::load_solves(BinaryReader& from) const {
  if (newton_) newton_->load(from);
}

void StretchLimit::forget_solves() const {
  if (newton_) newton_->forget();
}

double StretchLimit::deformation() const { return newton_ ? newton_->deformation() : 0.0; }

// Measured on a cloth of 32 particles a side that swings from its corners: without refinement it kept the energy of a run with a
// tenth of the step within 10 %, and so with steps halved up to three times. With structural springs alone refinement doubled its
// energy; without tethers it added 15 % for a while.
bool StretchLimit::bears_smaller_steps() const {
  if (!tethers_ || !prevents_shrinking(settings_)) return false;
  const SpringGraph graph(network_, limited_springs(network_, settings_.kinds));
  return std::ranges::all_of(network_.bodies, [&](const Body& body) { return is_rigid(body, graph); });
}

}  // namespace sprung
