#include "simulation/start/moved_check.h"

#include "base/format.h"
#include "base/problem_list.h"
#include "dynamics/contact/collision_surface_builder.h"
#include "simulation/start/start_check.h"

#include <algorithm>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace sprung {
namespace {

using Pair = std::pair<Index, Index>;

Pair pair_of(const Intersections::Inside& inside) { return {inside.particle, inside.obstacle}; }
Pair pair_of(const Intersections::Crossing& crossing) { return {crossing.element, crossing.obstacle}; }
Pair pair_of(const CrossingElements& crossing) { return {crossing.first, crossing.second}; }

template <class Entry>
void remove_known(const std::vector<Entry>& known, std::vector<Entry>& found) {
  std::vector<Pair> pairs;
  for (const Entry& entry : known) pairs.push_back(pair_of(entry));
  std::ranges::sort(pairs);
  std::erase_if(found, [&](const Entry& entry) { return std::ranges::binary_search(pairs, pair_of(entry)); });
}

CollisionSurface surface_awake(const SpringNetwork& network) {
  CollisionSurface surface = contact_surface(network);
  for (Index i = 0; i < network.particle_count(); ++i) {
    if (network.is_asleep(i) && !network.is_pinned(i)) surface.motions[static_cast<std::size_t>(i)] = ParticleMotion::free;
  }
  return surface;
}

/// What a body would meet: an obstacle, or another body.
struct Meeting {
  Index body = kNone;
  Index other = kNone;
  bool is_obstacle = true;

  [[nodiscard]] auto operator<=>(const Meeting&) const = default;
};

/// How many particles and elements of a body meet something, and the first of them.
struct Met {
  std::size_t passing = 0;
  std::size_t inside = 0;
  std::size_t across = 0;
  Index particle = kNone;
};

std::string value_of(const Met& met) {
  std::string text;
  const auto append = [&](std::size_t count, const std::string& what, const std::string& how) {
    if (count > 0) text += (text.empty() ? "" : ", ") + counted(count, what) + " " + how;
  };
  append(met.passing, "particle", "through it");
  append(met.inside, "particle", "inside");
  append(met.across, "element", "across");
  return text;
}

class MovedRules {
 public:
  MovedRules(const SpringNetwork& network, const ObstacleFrame& obstacles)
      : network_(network), obstacles_(obstacles), surface_(surface_awake(network)) {}

  void find_paths(const Points& before, const Points& after) {
    for (const Contact& contact : obstacles_.contacts({.before = before, .after = after, .thickness = surface_.thickness})) {
      const Index i = contact.particles[0];
      const bool passes = contact.distance < 0.0 && before.col(i) != after.col(i) && !is_fixed(surface_.motions, i);
      if (passes) count(&Met::passing, {.body = body_of(i), .other = contact.obstacle}, i);
    }
  }

  void find_intersections(const Points& before, const Points& after, bool of_bodies) {
    StartIntersections found = find_start_intersections(obstacles_, surface_, after);
    if (!of_bodies) found.with_each_other.clear();
    if (found.empty()) return;
    const StartIntersections known = find_start_intersections(obstacles_, surface_, before);
    remove_known(known.with_obstacles.inside, found.with_obstacles.inside);
    remove_known(known.with_obstacles.crossings, found.with_obstacles.crossings);
    remove_known(known.with_each_other, found.with_each_other);
    for (const auto& inside : found.with_obstacles.inside) {
      count(&Met::inside, {.body = body_of(inside.particle), .other = inside.obstacle}, inside.particle);
    }
    for (const auto& crossing : found.with_obstacles.crossings) {
      const Element& element = element_of(crossing.element);
      count(&Met::across, {.body = element.body, .other = crossing.obstacle}, element.particles[0]);
    }
    for (const auto& crossing : found.with_each_other) {
      const Element& element = element_of(crossing.first);
      const Index other = element_of(crossing.second).body;
      count(&Met::across, {.body = element.body, .other = other, .is_obstacle = false}, element.particles[0]);
    }
  }

  void throw_if_any(const Points& after) const {
    ProblemList problems;
    for (const auto& [meeting, met] : met_) {
      const Body& body = network_.bodies[static_cast<std::size_t>(meeting.body)];
      const std::string other = meeting.is_obstacle ? "obstacle \"" + obstacles_.obstacle(meeting.other).name + "\""
                                : meeting.other == meeting.body
                                    ? "itself"
                                    : "body \"" + network_.bodies[static_cast<std::size_t>(meeting.other)].name + "\"";
      problems.add("bodies." + body.name + ".particles", value_of(met),
                   "may neither pass through " + other + " nor intersect it: particle " +
                       std::to_string(met.particle - body.first_particle) + " at " + vector_text(after.col(met.particle), 4),
                   "write positions that are free and can be reached on a straight path");
    }
    problems.throw_if_any();
  }

 private:
  void count(std::size_t Met::*number, const Meeting& meeting, Index particle) {
    Met& met = met_[meeting];
    ++(met.*number);
    if (met.particle == kNone) met.particle = particle;
  }
  [[nodiscard]] Index body_of(Index particle) const {
    return static_cast<Index>(&network_.body_of(particle) - network_.bodies.data());
  }
  [[nodiscard]] const Element& element_of(Index number) const { return surface_.elements[static_cast<std::size_t>(number)]; }

  const SpringNetwork& network_;
  const ObstacleFrame& obstacles_;
  CollisionSurface surface_;
  std::map<Meeting, Met> met_;
};

}  // namespace

void check_moved(const SpringNetwork& network, const ObstacleFrame& obstacles, const ContactSettings& contact, const Points& before,
                 const Points& after) {
  const bool is_penalty = contact.response == ContactSettings::Response::penalty;
  MovedRules rules(network, obstacles);
  if (!is_penalty) rules.find_paths(before, after);
  rules.find_intersections(before, after, !is_penalty);
  rules.throw_if_any(after);
}

}  // namespace sprung
