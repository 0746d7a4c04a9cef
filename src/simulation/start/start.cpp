#include "base/format.h"
#include "base/grouped_warnings.h"
#include "dynamics/contact/collision_surface_builder.h"
#include "simulation/start/push_out.h"
#include "simulation/start/start_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace sprung {

namespace {

StartIntersections find_all(const ObstacleFrame& obstacles, const CollisionSurface& surface, const ContactSettings& contact,
                            const Points& positions) {
  StartIntersections found = find_start_intersections(obstacles, surface, positions);
  // Penalty contact does not act between bodies.
  if (contact.response == ContactSettings::Response::penalty) found.with_each_other.clear();
  return found;
}

std::vector<std::string> describe_moved(const SpringNetwork& network, const Points& from, const Points& to) {
  std::vector<std::string> names;
  std::size_t count = 0;
  double farthest = 0.0;
  for (const Body& body : network.bodies) {
    const std::size_t before = count;
    for (Index i = body.first_particle; i < body.first_particle + body.particle_count; ++i) {
      if (from.col(i) == to.col(i)) continue;
      ++count;
      farthest = std::max(farthest, (to.col(i) - from.col(i)).norm());
    }
    if (count > before) names.push_back(body.name);
  }
  if (names.empty()) return {};
  return {names_text("body", "bodies", names) + ": intersected an obstacle or a body at the start and moved out: " +
          counted(count, "particle") + (count == 1 ? " by " : " by up to ") + format_number(farthest, 3) + " m"};
}

/// The obstacles that a body intersects, or "another body" if there is none.
std::string intersected_by(Index body, const StartIntersections& found, const CollisionSurface& surface,
                           const SpringNetwork& network, const ObstacleFrame& obstacles) {
  std::set<Index> intersected;
  for (const auto& crossing : found.with_obstacles.crossings) {
    if (surface.elements[static_cast<std::size_t>(crossing.element)].body == body) intersected.insert(crossing.obstacle);
  }
  for (const auto& inside : found.with_obstacles.inside) {
    if (&network.body_of(inside.particle) == &network.bodies[static_cast<std::size_t>(body)]) intersected.insert(inside.obstacle);
  }
  std::vector<std::string> names;
  for (const Index k : intersected) names.push_back(obstacles.obstacle(k).name);
  return names.empty() ? "another body" : names_text("obstacle", "obstacles", names);
}

/// The lengths of a body's edges after push_out, as multiples of those before.
struct LengthRatios {
  double largest = 1.0;
  double smallest = 1.0;
};

LengthRatios length_ratios(const SpringNetwork& network, const Body& body, const Points& from, const Points& to) {
  const Springs& springs = network.springs;
  LengthRatios ratios;
  for (Index s = body.first_spring; s < body.first_spring + body.spring_count; ++s) {
    if (springs.kind[s] != SpringKind::structural) continue;
    const double before = (from.col(springs.first[s]) - from.col(springs.second[s])).norm();
    if (before == 0.0) continue;
    const double ratio = (to.col(springs.first[s]) - to.col(springs.second[s])).norm() / before;
    ratios = {std::max(ratios.largest, ratio), std::min(ratios.smallest, ratio)};
  }
  return ratios;
}

/// Whether push_out would be a remedy: bodies are no deeper in obstacles than their elements are large, and it deforms them little.
/// A body that push_out wraps round an obstacle or flattens may have inverted cells, cross itself or miss its stretch limit.
bool push_out_helps(const SpringNetwork& network, const ObstacleFrame& obstacles, const CollisionSurface& surface,
                    const ContactSettings& contact, const Points& positions, const StartIntersections& wanted) {
  constexpr double kLittle = 0.25;
  constexpr Index kMostParticles = 10'000;  // above this, push_out takes seconds where bodies intersect
  if (!wanted.with_each_other.empty() && network.particle_count() > kMostParticles) return false;
  const auto is_deep = [&](const auto& inside) {
    const auto body = static_cast<std::size_t>(&network.body_of(inside.particle) - network.bodies.data());
    return surface.element_size[body] > 0.0 && inside.depth > surface.element_size[body];
  };
  if (std::ranges::any_of(wanted.with_obstacles.inside, is_deep)) return false;
  const bool apart = contact.response == ContactSettings::Response::projection;
  const Points moved = push_out(network, obstacles, surface, positions, apart);
  if (!find_all(obstacles, surface, contact, moved).empty()) return false;
  return std::ranges::all_of(network.bodies, [&](const Body& body) {
    const LengthRatios ratios = length_ratios(network, body, positions, moved);
    return ratios.largest <= 1.0 + kLittle && ratios.smallest >= 1.0 - kLittle;
  });
}

/// Bodies that push_out stretched so much that their springs will throw them off: those that an obstacle pierces, for example.
std::vector<std::string> describe_lengthened(const SpringNetwork& network, const ObstacleFrame& obstacles,
                                             const CollisionSurface& surface, const StartIntersections& found, const Points& from,
                                             const Points& to) {
  constexpr double kMuch = 0.5;
  std::vector<std::string> lines;
  for (Index number = 0; number < static_cast<Index>(network.bodies.size()); ++number) {
    const Body& body = network.bodies[static_cast<std::size_t>(number)];
    const double most = length_ratios(network, body, from, to).largest - 1.0;
    if (most <= kMuch) continue;
    lines.push_back("body \"" + body.name + "\": \"push_out\" moved it off " +
                    intersected_by(number, found, surface, network, obstacles) + " and made an edge " +
                    format_number(100.0 * most, 3) +
                    " % longer, so that its springs will throw it off. Start it elsewhere: change \"place\".");
  }
  return lines;
}

/// Bodies with an obstacle deep in their gap: contact will accelerate them out of it.
std::vector<std::string> describe_too_near(const SpringNetwork& network, const ObstacleFrame& obstacles, const Points& positions) {
  constexpr double kDeep = 0.5;  // of the gap
  double obstacle_thickness = std::numeric_limits<double>::infinity();
  for (const Obstacle& obstacle : obstacles.set().obstacles()) {
    obstacle_thickness = std::min(obstacle_thickness, obstacle.material.thickness);
  }
  struct TooNear {
    std::vector<std::string> bodies;
    double nearest = std::numeric_limits<double>::infinity();
  };
  std::map<double, TooNear> of_gaps;
  for (const Body& body : network.bodies) {
    const double gap = body.material.thickness + obstacle_thickness;
    if (!std::isfinite(gap) || gap == 0.0) continue;
    std::vector<Index> free;
    for (Index i = body.first_particle; i < body.first_particle + body.contact_vertex_count(); ++i) {
      if (!network.is_pinned(i)) free.push_back(i);
    }
    const auto nearest = obstacles.min_distance(positions(Eigen::all, free), gap);
    if (!nearest || *nearest >= kDeep * gap) continue;
    TooNear& found = of_gaps[gap];
    found.bodies.push_back(body.name);
    found.nearest = std::min(found.nearest, *nearest);
  }
  std::vector<std::string> lines;
  for (const auto& [gap, found] : of_gaps) {
    lines.push_back(names_text("body", "bodies", found.bodies) + ": starts " + format_number(found.nearest, 3) +
                    " m from an obstacle, deep within the thickness of " + format_number(gap, 3) +
                    " m. Contact will accelerate it away. Start farther away, or use a smaller thickness.");
  }
  return lines;
}

/// Bodies that begin as another simulation ended are not where the scene places them.
std::string way_out(const SpringNetwork& network, const Points& positions) {
  for (Index i = 0; i < network.particle_count(); ++i) {
    if (!network.is_pinned(i) && positions.col(i) != network.positions.col(i))
      return "move an obstacle by \"place\", which does not move bodies that begin as another run ended";
  }
  return "move one of them by \"place\"";
}

}  // namespace

Start find_start(const SpringNetwork& network, const ObstacleFrame& obstacles, const ContactSettings& contact,
                 const Points& positions) {
  const CollisionSurface surface = contact_surface(network);
  const StartIntersections wanted = find_all(obstacles, surface, contact, positions);
  if (wanted.empty()) return {positions, describe_too_near(network, obstacles, positions), {}};
  if (contact.start == ContactSettings::Start::push_out) {
    const Points start =
        push_out(network, obstacles, surface, positions, contact.response == ContactSettings::Response::projection);
    const StartIntersections left = find_all(obstacles, surface, contact, start);
    if (!left.empty()) {
      const std::string remedy = "\"push_out\" found no free position: " + way_out(network, positions);
      throw InputError(start_problems(left, network, obstacles, surface, start, remedy));
    }
    return {start, describe_lengthened(network, obstacles, surface, wanted, positions, start),
            describe_moved(network, positions, start)};
  }
  std::string remedy = way_out(network, positions);
  if (push_out_helps(network, obstacles, surface, contact, positions, wanted)) remedy += ", or set contact.start to \"push_out\"";
  throw InputError(start_problems(wanted, network, obstacles, surface, positions, remedy));
}

}  // namespace sprung
