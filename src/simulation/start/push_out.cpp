#include "simulation/start/push_out.h"

#include "collision/obstacles/obstacle_intersections.h"
#include "collision/surface/self_intersections.h"
#include "simulation/start/approach.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>
#include <vector>

namespace sprung {

namespace {

// How far off the surfaces a body is free, in sizes of its elements, whose edges cut corners that their ends do not.
constexpr std::array kDistancesOff{0.25, 0.5, 1.0};

// A body as a whole is tried this part of its elements' size away, then twice as far, and so on.
constexpr double kFirstWay = 0.25;
constexpr int kMostDoublings = 14;

/// Up first; where ways are as long, the first is taken.
std::vector<Vector3> ways_out() {
  std::vector<Vector3> ways;
  for (const int axis : {1, 0, 2}) {
    for (const double sign : {1.0, -1.0}) ways.emplace_back(sign * Vector3::Unit(axis));
  }
  for (const double y : {1.0, -1.0}) {
    for (const double x : {1.0, -1.0}) {
      for (const double z : {1.0, -1.0}) ways.emplace_back(Vector3(x, y, z).normalized());
    }
  }
  return ways;
}

bool crosses_another(const CollisionSurface& surface, Index body, const Points& positions) {
  const auto body_of = [&](Index element) { return surface.elements[static_cast<std::size_t>(element)].body; };
  const std::vector<CrossingElements> found = find_self_intersections(surface, positions);
  return std::any_of(found.begin(), found.end(), [&](const CrossingElements& crossing) {
    const Index first = body_of(crossing.first);
    const Index second = body_of(crossing.second);
    return first != second && (first == body || second == body);
  });
}

class FreePlace {
 public:
  FreePlace(const Environment& environment, const CollisionSurface& surface, Index body, const Points& wanted)
      : environment_(environment),
        surface_(surface),
        body_(body),
        wanted_(wanted),
        movable_(static_cast<std::size_t>(wanted.cols())) {
    for (const Element& element : surface.elements) {
      if (element.body != body) continue;
      for (std::size_t k = 0; k < static_cast<std::size_t>(element.corners); ++k) {
        const auto i = static_cast<std::size_t>(element.particles[k]);
        movable_[i] = surface.pinned[i] == 0 ? 1 : 0;
      }
    }
  }

  [[nodiscard]] std::optional<Points> off_obstacles() const {
    double depth = 0.0;
    for (const auto& inside : intersections(wanted_).inside) depth = std::max(depth, inside.depth);
    const double size = surface_.element_size[static_cast<std::size_t>(body_)];
    const bool shallow = depth <= size || size == 0.0;
    if (shallow) {
      if (auto place = off_surfaces(size, depth)) return place;
    }
    const auto is_off = [&](const Points& x) { return is_off_obstacles(x); };
    if (auto place = as_a_whole(kFirstWay * (size > 0.0 ? size : depth), is_off)) return place;
    return shallow ? std::nullopt : off_surfaces(size, depth);
  }

  /// Off other bodies too.
  [[nodiscard]] std::optional<Points> off_all() const {
    return as_a_whole(kFirstWay * surface_.element_size[static_cast<std::size_t>(body_)],
                      [&](const Points& x) { return !crosses_another(surface_, body_, x) && is_off_obstacles(x); });
  }

 private:
  [[nodiscard]] Intersections intersections(const Points& x) const {
    return find_intersections(environment_.set(), surface_, x, body_);
  }

  [[nodiscard]] bool is_off_obstacles(const Points& x) const { return intersections(x).empty(); }

  [[nodiscard]] std::optional<Points> off_surfaces(double size, double depth) const {
    for (const double part : kDistancesOff) {
      Points place = led_off(part * size, depth);
      if (is_off_obstacles(place)) return place;
    }
    return std::nullopt;
  }

  /// Particles that are nearer to a surface than their gap and `beyond` [m], or in it, at that distance.
  [[nodiscard]] Points led_off(double beyond, double depth) const {
    Points place = wanted_;
    for (const Contact& contact : environment_.contacts({wanted_, wanted_, surface_.thickness, beyond + depth})) {
      const Index i = contact.particles[0];
      if (movable_[static_cast<std::size_t>(i)] == 0) continue;
      const ContactMaterial& material = environment_.obstacles()[static_cast<std::size_t>(contact.obstacle)].material;
      const double gap = std::max(surface_.thickness[i] + material.thickness, 2.0 * contact.clearance);
      const double height = contact.normal.dot(place.col(i) - contact.point);
      if (height < gap + beyond) place.col(i) += (gap + beyond - height) * contact.normal;
    }
    return place;
  }

  template <class IsFree>
  [[nodiscard]] std::optional<Points> as_a_whole(double first_way, const IsFree& is_free) const {
    double way = first_way;
    for (int doubling = 0; doubling < kMostDoublings; ++doubling, way *= 2.0) {
      for (const Vector3& direction : ways_out()) {
        Points place = wanted_;
        for (Index i = 0; i < static_cast<Index>(place.cols()); ++i) {
          if (movable_[static_cast<std::size_t>(i)] != 0) place.col(i) += way * direction;
        }
        if (is_free(place)) return place;
      }
    }
    return std::nullopt;
  }

  const Environment& environment_;
  const CollisionSurface& surface_;
  Index body_;
  const Points& wanted_;
  std::vector<char> movable_;  ///< by particle: 1 for those of the body that no pin holds
};

/// Those that are to stay come last: bodies that pins hold, and of others the first.
std::vector<Index> in_order_of_leaving(const SpringNetwork& network) {
  std::vector<Index> order(network.bodies.size());
  std::iota(order.rbegin(), order.rend(), 0);
  std::stable_partition(order.begin(), order.end(), [&](Index number) {
    const Body& body = network.bodies[static_cast<std::size_t>(number)];
    return (network.inverse_masses.segment(body.first_particle, body.particle_count).array() > 0.0).all();
  });
  return order;
}

}  // namespace

Points push_out(const SpringNetwork& network, Environment& environment, const CollisionSurface& surface, const Points& wanted,
                bool apart) {
  Points positions = wanted;
  const auto come_back = [&](Index body, const std::optional<Points>& place) {
    if (place) positions = WayBack(network, environment, body).walk(*place, positions);
  };
  for (Index body = 0; body < static_cast<Index>(network.bodies.size()); ++body) {
    if (find_intersections(environment.set(), surface, positions, body).empty()) continue;
    come_back(body, FreePlace(environment, surface, body, positions).off_obstacles());
  }
  if (!apart) return positions;
  for (const Index body : in_order_of_leaving(network)) {
    if (crosses_another(surface, body, positions)) come_back(body, FreePlace(environment, surface, body, positions).off_all());
  }
  return positions;
}

}  // namespace sprung
