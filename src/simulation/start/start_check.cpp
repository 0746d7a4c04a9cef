#include "simulation/start/start_check.h"

#include "base/format.h"
#include "base/problem_list.h"
#include "collision/obstacles/obstacle_intersections.h"

#include <algorithm>
#include <map>
#include <span>
#include <utility>

namespace sprung {

namespace {

constexpr std::size_t kMaxNamed = 3;

constexpr int kDigits = 4;

std::string first_of(const std::vector<std::string>& texts) {
  std::string text;
  for (std::size_t i = 0; i < std::min(texts.size(), kMaxNamed); ++i) text += (i == 0 ? "" : ", ") + texts[i];
  if (texts.size() > kMaxNamed) text += " and " + std::to_string(texts.size() - kMaxNamed) + " more";
  return text;
}

std::string kind_of(const Element& element) {
  return element.corners == 3 ? "triangle" : element.corners == 2 ? "segment" : "particle";
}

/// Describes elements for users, who number particles within their body.
class ElementText {
 public:
  ElementText(const SpringNetwork& network, const Points& positions) : network_(network), positions_(positions) {}

  [[nodiscard]] std::string of(Index particle) const {
    return "particle " + number_of(particle) + " at " + vector_text(positions_.col(particle), kDigits);
  }

  [[nodiscard]] std::string of(const Element& element) const {
    if (element.corners == 1) return of(element.particles[0]);
    std::string text = kind_of(element) + " of particles ";
    Vector3 middle = Vector3::Zero();
    for (const Index i : std::span(element.particles.data(), static_cast<std::size_t>(element.corners))) {
      text += (i == element.particles[0] ? "" : ", ") + number_of(i);
      middle += positions_.col(i) / element.corners;
    }
    return text + " at " + vector_text(middle, kDigits);
  }

 private:
  [[nodiscard]] std::string number_of(Index particle) const {
    return std::to_string(particle - network_.body_of(particle).first_particle);
  }

  const SpringNetwork& network_;
  const Points& positions_;
};

/// Intersections of one body with one obstacle.
struct InObstacle {
  std::vector<std::string> particles{};
  std::vector<std::string> elements{};
  std::string kind{};
  double deepest = 0.0;
};

using NumberPair = std::pair<Index, Index>;

std::map<NumberPair, InObstacle> by_body_and_obstacle(const Intersections& found, const SpringNetwork& network,
                                                      const CollisionSurface& surface, const ElementText& text) {
  std::map<NumberPair, InObstacle> result;
  for (const auto& [particle, obstacle, depth] : found.inside) {
    const auto body = static_cast<Index>(&network.body_of(particle) - network.bodies.data());
    InObstacle& entry = result[{body, obstacle}];
    entry.particles.push_back(text.of(particle));
    entry.deepest = std::max(entry.deepest, depth);
  }
  for (const auto& [number, obstacle] : found.crossings) {
    const Element& element = surface.elements[static_cast<std::size_t>(number)];
    InObstacle& entry = result[{element.body, obstacle}];
    entry.elements.push_back(text.of(element));
    entry.kind = entry.elements.size() == 1 || entry.kind == kind_of(element) ? kind_of(element) : "element";
  }
  return result;
}

/// For each body and obstacle that intersect: the first pinned particle of the body that is inside the obstacle.
std::map<NumberPair, Index> pins_inside(const ObstacleFrame& obstacles, const SpringNetwork& network, CollisionSurface surface,
                                        const Points& positions) {
  std::ranges::fill(surface.motions, ParticleMotion::free);
  std::map<NumberPair, Index> pins;
  for (const auto& [particle, obstacle, depth] : find_intersections(obstacles, surface, positions).inside) {
    const auto body = static_cast<Index>(&network.body_of(particle) - network.bodies.data());
    if (network.is_pinned(particle)) pins.try_emplace({body, obstacle}, particle);
  }
  return pins;
}

Problem problem_of(const InObstacle& found, const std::string& body, const std::string& obstacle, const std::string& remedy) {
  std::string value;
  if (!found.particles.empty()) value = counted(found.particles.size(), "particle") + " inside";
  if (!found.elements.empty()) value += (value.empty() ? "" : ", ") + counted(found.elements.size(), found.kind) + " across";
  std::string rule = "intersects obstacle \"" + obstacle + "\" at the start";
  if (found.deepest > 0.0) rule += ", up to " + format_number(found.deepest, 3) + " m deep";
  rule += ": " + first_of(found.particles.empty() ? found.elements : found.particles);
  return {.key = "bodies." + body, .value = value, .rule = rule, .remedy = remedy};
}

Problem problem_of(const std::vector<std::string>& pairs, const std::string& body, const std::string& other,
                   const std::string& remedy) {
  const bool self = body == other;
  return {.key = "bodies." + body,
          .value = counted(pairs.size(), "pair") + " of elements",
          .rule = (self ? kIntersectsItself : "intersects body \"" + other + "\" at the start") + ": " + first_of(pairs),
          .remedy = self ? "change its shape, or set its self_contact to false"
                         : remedy + ", or set body_contact of one of them to false"};
}

}  // namespace

StartIntersections find_start_intersections(const ObstacleFrame& obstacles, const CollisionSurface& surface,
                                            const Points& positions) {
  return {find_intersections(obstacles, surface, positions), find_self_intersections(surface, positions)};
}

std::vector<Problem> start_problems(const StartIntersections& found, const SpringNetwork& network, const ObstacleFrame& obstacles,
                                    const CollisionSurface& surface, const Points& positions, const std::string& remedy) {
  const ElementText text(network, positions);
  const auto body_name = [&](Index number) { return network.bodies[static_cast<std::size_t>(number)].name; };
  std::vector<Problem> problems;
  const auto with_obstacles = by_body_and_obstacle(found.with_obstacles, network, surface, text);
  const auto pins = with_obstacles.empty() ? std::map<NumberPair, Index>{} : pins_inside(obstacles, network, surface, positions);
  for (const auto& [numbers, entry] : with_obstacles) {
    const std::string& obstacle = obstacles.obstacle(numbers.second).name;
    const auto pin = pins.find(numbers);
    const std::string own_remedy =
        pin == pins.end()
            ? remedy
            : "a pin holds " + text.of(pin->second) +
                  " inside, and \"push_out\" does not move pins: move the pin or the obstacle, or pin all particles inside";
    problems.push_back(problem_of(entry, body_name(numbers.first), obstacle, own_remedy));
  }

  std::map<NumberPair, std::vector<std::string>> crossing_bodies;
  for (const auto& [first, second] : found.with_each_other) {
    const Element& a = surface.elements[static_cast<std::size_t>(first)];
    const Element& b = surface.elements[static_cast<std::size_t>(second)];
    crossing_bodies[{a.body, b.body}].push_back(text.of(a) + " and " + text.of(b));
  }
  for (const auto& [numbers, pairs] : crossing_bodies) {
    problems.push_back(problem_of(pairs, body_name(numbers.first), body_name(numbers.second), remedy));
  }
  return problems;
}

}  // namespace sprung
