#include "simulation/sleep/rest_detector.h"

#include "dynamics/tethers/limited_springs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <utility>

namespace sprung {
namespace {

// [s]
constexpr double kWindow = 0.25;

// Times are rounded: without a tolerance, some windows would be a step longer than others, and a steady motion would seem to
// change.
constexpr double kRounding = 1.0e-9;  // [s]

// Frames of 1/32 s on average, near the usual frame rate of 30 1/s.
constexpr int kFrames = 8;

// The largest invisible displacement [m]: a tenth of a pixel where 1000 pixels show a metre.
constexpr double kInvisible = 1.0e-4;

// The displacement of a single particle may be larger than the root mean square by this factor. A fold or a corner may then move by
// 0.3 mm in a frame, and by 1 mm if the body as a whole is at rest: limp cloths have a few particles that hardly ever stop.
constexpr double kOfOne = 3.0;
constexpr double kOfOneInBody = 10.0;  // if the body as a whole is at rest

// The bounds become smaller in bodies with springs below this length [m], which are shown larger.
constexpr double kLongSpring = 0.01;

// The largest displacement in a window of a particle that is not restless [m], and as a fraction of the shortest spring.
constexpr double kMost = 2.5e-3;
constexpr double kOfSpring = 0.1;

// The largest change of the springs' force on a sleeping group that does not wake it, as a fraction of its weight.
constexpr double kOfWeight = 0.1;

// A slide whose predicted length is below this counts as stopped [m].
constexpr double kSlide = 1.0e-3;

// A swing that keeps more than this fraction of its amplitude in a window is steady: it needs more than 8 s to halve it.
constexpr double kSteady = 0.98;

// A group whose velocity changes steadily by more than this is not at rest [m/s^2]. Smaller changes are invisible for a second.
constexpr double kAcceleration = 1.0e-4;

// Two changes of velocity that differ by less than this fraction are steady.
constexpr double kSteadyChange = 0.1;

// Speed of a creep that takes an hour for an invisible displacement [m/s].
constexpr double kCreep = 3.0e-8;

// The squared sine of the angle between the displacements of two windows, as vectors of all particles, below which they count as
// parallel. An angle of 1e-3 is far above roundings: the smallest displacement that counts, 7.5 nm, has one of 3e-8 at 1 m.
constexpr double kParallel = 1.0e-6;

/// When a frame of a window ends [s]. Two frames are long and short, in the golden ratio: no vibration has a period that divides
/// both, so that its displacements are seen in one of them.
double end_of_frame(int frame) {
  constexpr double kPair = 2.0 * kWindow / kFrames;
  return kPair * (frame / 2 + (frame % 2 == 0 ? 1.0 / std::numbers::phi : 1.0));  // NOLINT(bugprone-integer-division)
}

/// The displacements of particles in a frame.
struct Displacements {
  double sum = 0.0;      ///< of squares [m^2]
  double largest = 0.0;  ///< square [m^2]
  std::size_t count = 0;

  void add(double squared) {
    sum += squared;
    largest = std::max(largest, squared);
    ++count;
  }
  /// The root mean square, or the largest displacement divided by `of_one` if that is more [m].
  [[nodiscard]] double visible(double of_one) const {
    return count == 0 ? 0.0 : std::max(std::sqrt(sum / static_cast<double>(count)), std::sqrt(largest) / of_one);
  }
};

/// Sums of products of displacements, over particles [m^2]. 0 is the window that ends, 1 and 2 are those before it.
struct Products {
  double of_00 = 0.0;
  double of_11 = 0.0;
  double of_22 = 0.0;
  double of_01 = 0.0;
  double of_02 = 0.0;
  double of_12 = 0.0;
};

Products products_of(const std::vector<Index>& particles, const SimulationState& state) {
  const std::array<Points, 3>& begins = state.rest.x_at_begins;
  Products products;
  for (const Index i : particles) {
    const Vector3 now = state.x.col(i) - begins[0].col(i);
    const Vector3 last = begins[0].col(i) - begins[1].col(i);
    const Vector3 second_last = begins[1].col(i) - begins[2].col(i);
    products.of_00 += now.squaredNorm();
    products.of_11 += last.squaredNorm();
    products.of_22 += second_last.squaredNorm();
    products.of_01 += now.dot(last);
    products.of_02 += now.dot(second_last);
    products.of_12 += last.dot(second_last);
  }
  return products;
}

/// Whether the velocity of the particles changes steadily, as in a uniform acceleration, by more than kAcceleration. A motion is
/// slow where such a change reverses it. Compares the change in the last two windows with that in the two before: parts of the
/// earlier change that have died away are orthogonal to the later one.
bool accelerates(const Products& d, double count) {
  const double change = d.of_00 - 2.0 * d.of_01 + d.of_11;            // squared
  const double with_earlier = d.of_01 - d.of_02 - d.of_11 + d.of_12;  // product of both changes
  const double least = kAcceleration * kWindow * kWindow;
  return change > least * least * count && std::abs(with_earlier - change) < kSteadyChange * change;
}

}  // namespace

double RestDetector::Watched::scale() const { return std::min(1.0, shortest / kLongSpring); }

RestDetector::RestDetector(const SpringNetwork& network, const SleepGroups& groups, const StretchLimit* limit,
                           const Vector3& gravity)
    : gravity_(gravity), masses_(groups.groups.size(), 0.0) {
  for (Index i = 0; i < network.particle_count(); ++i) masses_[groups.group_of[i]] += network.masses[i];
  watch(network, groups);
  find_pulling(network, groups.group_of);
  if (limit != nullptr) find_limited(network, limit->settings());
}

void RestDetector::watch(const SpringNetwork& network, const SleepGroups& groups) {
  for (std::size_t b = 0; b < network.bodies.size(); ++b) {
    const Body& body = network.bodies[b];
    double shortest = std::numeric_limits<double>::infinity();
    for (Index s = body.first_spring; s < body.first_spring + body.spring_count; ++s) {
      const double length = network.springs.rest_length[s];
      if (length > 0.0) shortest = std::min(shortest, length);
    }
    bodies_.push_back({.body = b, .free = {}, .shortest = shortest});
  }
  for (const SleepGroup& group : groups.groups) {
    Watched& body = bodies_[group.body];
    Watched& watched = groups_.emplace_back(Watched{.body = group.body, .free = {}, .shortest = body.shortest});
    std::ranges::copy_if(group.particles, std::back_inserter(watched.free), [&](Index i) { return !network.is_fixed(i); });
    body.free.insert(body.free.end(), watched.free.begin(), watched.free.end());
  }
}

void RestDetector::find_pulling(const SpringNetwork& network, const std::vector<Index>& group_of) {
  const Springs& springs = network.springs;
  for (Index s = 0; s < springs.count(); ++s) {
    Index awake = springs.first[s];
    Index asleep = springs.second[s];
    if (network.is_asleep(awake)) std::swap(awake, asleep);
    if (network.is_asleep(awake) || !network.is_asleep(asleep) || springs.stiffness[s] == 0.0) continue;
    pulling_.push_back({.awake = awake,
                        .asleep = asleep,
                        .awake_group = group_of[awake],
                        .asleep_group = group_of[asleep],
                        .stiffness = springs.stiffness[s]});
  }
}

void RestDetector::find_limited(const SpringNetwork& network, const StretchLimitSettings& settings) {
  const double longest = 1.0 + settings.max_stretch + wanted_excess(settings);  // relative to the rest length
  for (const Index s : limited_springs(network, settings.kinds)) {
    const Index first = network.springs.first[s];
    const auto body = static_cast<std::size_t>(&network.body_of(first) - network.bodies.data());
    limited_.push_back(
        {.ends = {first, network.springs.second[s]}, .body = body, .longest = longest * network.springs.rest_length[s]});
  }
}

std::vector<char> RestDetector::restless(const SimulationState& state) const {
  std::vector<char> restless(groups_.size(), 0);
  if (!state.rest.window_begin) return restless;
  std::vector<char> misses_limit(bodies_.size(), 0);
  for (const Limited& spring : limited_) {
    const double squared = (state.x.col(spring.ends[0]) - state.x.col(spring.ends[1])).squaredNorm();
    if (squared > spring.longest * spring.longest) misses_limit[spring.body] = 1;
  }
  for (std::size_t p = 0; p < groups_.size(); ++p) {
    restless[p] = misses_limit[groups_[p].body] != 0 || has_moved(groups_[p], state) ? 1 : 0;
  }
  const std::vector<Vector3> pulls = changes_of_pull(state);
  for (const Pulling& spring : pulling_) {
    if (pulls[spring.asleep_group].norm() > kOfWeight * gravity_.norm() * masses_[spring.asleep_group])
      restless[spring.awake_group] = 1;
  }
  return restless;
}

/// The change of the springs' force on each group that sleeps, since it fell asleep [N].
std::vector<Vector3> RestDetector::changes_of_pull(const SimulationState& state) const {
  std::vector<Vector3> changes(groups_.size(), Vector3::Zero());
  for (const Pulling& spring : pulling_) {
    const Vector3 now = state.x.col(spring.awake) - state.x.col(spring.asleep);
    const Vector3 then = state.rest.x_beside_sleep.col(spring.awake) - state.x.col(spring.asleep);
    if (now.norm() == 0.0) continue;
    changes[spring.asleep_group] += spring.stiffness * (now.norm() - then.norm()) * now.normalized();
  }
  return changes;
}

bool RestDetector::window_ends(double time, const SimulationState& state) {
  return !state.rest.window_begin || time - *state.rest.window_begin >= kWindow - kRounding;
}

void RestDetector::observe(double time, SimulationState& state) const {
  RestMemory& rest = state.rest;
  if (!rest.window_begin || time - *rest.window_begin < end_of_frame(rest.frames) - kRounding) return;
  std::vector<Displacements> of_bodies(bodies_.size());
  const auto note = [](const Displacements& found, double of_one, MotionHistory& history) {
    history.in_frame = std::max(history.in_frame, found.visible(of_one));
  };
  for (std::size_t p = 0; p < groups_.size(); ++p) {
    Displacements& of_body = of_bodies[groups_[p].body];
    Displacements of_group;
    for (const Index i : groups_[p].free) {
      const double squared = (state.x.col(i) - rest.x_at_frame.col(i)).squaredNorm();
      of_group.add(squared);
      of_body.add(squared);
    }
    note(of_group, kOfOne, rest.histories[p]);
  }
  for (std::size_t b = 0; b < bodies_.size(); ++b) note(of_bodies[b], kOfOneInBody, rest.histories[groups_.size() + b]);
  ++rest.frames;
  rest.x_at_frame = state.x;
}

void RestDetector::end_window(double time, const std::vector<char>& restless, const std::vector<char>& beside,
                              SimulationState& state) const {
  RestMemory& rest = state.rest;
  if (!rest.window_begin) {
    rest.histories.assign(groups_.size() + bodies_.size(), {});
    rest.x_at_begins.fill(state.x);
    rest.x_beside_sleep = state.x;
  } else {
    judge_all(restless, state);
    rest.x_at_begins[2].swap(rest.x_at_begins[1]);
    rest.x_at_begins[1].swap(rest.x_at_begins[0]);
    rest.x_at_begins[0] = state.x;
  }
  rest.window_begin = time;
  rest.frames = 0;
  rest.x_at_frame = state.x;
  for (std::size_t p = 0; p < groups_.size(); ++p) {
    if (beside[p] != 0) continue;
    for (const Index i : groups_[p].free) rest.x_beside_sleep.col(i) = state.x.col(i);
  }
}

void RestDetector::forget(SimulationState& state) {
  state.rest.window_begin.reset();
  state.rest.frames = 0;
  state.rest.x_at_frame.resize(3, 0);
  state.rest.x_at_begins.fill(Points(3, 0));
  state.rest.x_beside_sleep.resize(3, 0);
  state.rest.histories.clear();
}

bool RestDetector::has_moved(const Watched& group, const SimulationState& state) const {
  const double most = std::min(kMost, kOfSpring * group.shortest);
  return std::ranges::any_of(
      group.free, [&](Index i) { return (state.x.col(i) - state.rest.x_beside_sleep.col(i)).squaredNorm() > most * most; });
}

/// Whether the motion goes on: see end_window(). Smaller displacements in a window than `swing` [m] do not count as a swing.
bool RestDetector::goes_on(const Watched& group, const SimulationState& state, double swing) {
  const Products d = products_of(group.free, state);
  const auto count = static_cast<double>(group.free.size());
  const double displacement = std::sqrt(d.of_00 / count);
  if (displacement <= kCreep * kWindow) return false;
  if (d.of_11 == 0.0 || d.of_22 == 0.0) return true;  // it begins to move, or has no such window yet
  if (accelerates(d, count)) return true;
  const bool swings_far = std::max({d.of_00, d.of_11, d.of_22}) > swing * swing * count;
  // Least squares: now = a last + b second_last. If last and second_last are parallel, only one of a and b can be found, and a
  // swing cannot be told from a slide that stops.
  const double determinant = d.of_11 * d.of_22 - d.of_12 * d.of_12;
  const bool are_parallel = determinant <= kParallel * d.of_11 * d.of_22;
  if (are_parallel && swings_far) return true;
  const double a = are_parallel ? d.of_01 / d.of_11 : (d.of_01 * d.of_22 - d.of_02 * d.of_12) / determinant;
  const double b = are_parallel ? 0.0 : (d.of_02 * d.of_11 - d.of_01 * d.of_12) / determinant;
  // A mode multiplies its displacement by a root of z^2 = a z + b in each window: a slide by a positive one, a swing by a negative
  // one or by a complex pair with the absolute value sqrt(-b).
  const double discriminant = 0.25 * a * a + b;
  if (discriminant < 0.0) return std::sqrt(-b) > kSteady && swings_far;
  const double kept = 0.5 * a + std::sqrt(discriminant);
  const double reversed = 0.5 * a - std::sqrt(discriminant);
  // The slide is a geometric series: from the begin of this window on, it is displacement / (1 - kept) long.
  return kept >= 1.0 || displacement > kSlide * (1.0 - kept) || (reversed < -kSteady && swings_far);
}

void RestDetector::judge_all(const std::vector<char>& restless, SimulationState& state) const {
  std::vector<char> of_bodies(bodies_.size(), 0);
  const auto of_body = [&](std::size_t body) -> MotionHistory& { return state.rest.histories[groups_.size() + body]; };
  for (std::size_t p = 0; p < groups_.size(); ++p) {
    const std::size_t body = groups_[p].body;
    of_bodies[body] = of_bodies[body] != 0 || restless[p] != 0 ? 1 : 0;
    judge(groups_[p], restless[p] != 0, state, state.rest.histories[p]);
  }
  for (std::size_t b = 0; b < bodies_.size(); ++b) judge(bodies_[b], of_bodies[b] != 0, state, of_body(b));
  for (std::size_t p = 0; p < groups_.size(); ++p) {
    state.rest.histories[p].is_at_rest = state.rest.histories[p].is_at_rest || of_body(groups_[p].body).is_at_rest;
  }
}

void RestDetector::judge(const Watched& group, bool is_restless, const SimulationState& state, MotionHistory& history) {
  const double bound = kInvisible * group.scale();
  const bool invisible = !is_restless && history.in_frame <= bound;
  history = {.was_invisible = invisible,
             .is_at_rest = invisible && history.was_invisible && (group.free.empty() || !goes_on(group, state, bound))};
}

}  // namespace sprung
