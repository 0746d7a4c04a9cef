#include "simulation/start/push_out.h"

#include "collision/obstacles/obstacle_intersections.h"
#include "dynamics/contact/collision_surface_builder.h"
#include "dynamics/contact/contact_projection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <vector>

namespace sprung {

namespace {

// Trial distances from surfaces, in element sizes: the edges of an element can cross a corner that its vertices do not.
constexpr std::array kTrialDistances{0.25, 0.5, 1.0};

// First trial displacement of a whole body, in element sizes; it is doubled up to kMaxDoublings times.
constexpr double kFirstDistance = 0.25;
constexpr int kMaxDoublings = 14;

/// Trial directions, up first. Of equally long free displacements the first is used.
std::vector<Vector3> escape_directions() {
  std::vector<Vector3> directions;
  for (const int axis : {1, 0, 2}) {
    for (const double sign : {1.0, -1.0}) directions.emplace_back(sign * Vector3::Unit(axis));
  }
  for (const double y : {1.0, -1.0}) {
    for (const double x : {1.0, -1.0}) {
      for (const double z : {1.0, -1.0}) directions.emplace_back(Vector3(x, y, z).normalized());
    }
  }
  return directions;
}

bool crosses_another(const std::set<BodyPair>& crossing, Index body) {
  return std::any_of(crossing.begin(), crossing.end(), [&](const BodyPair& pair) {
    return pair.first != pair.second && (pair.first == body || pair.second == body);
  });
}

/// Whether a body moves as a whole or not at all: a surface that moved alone would be out of the cells that carry it.
bool stays_whole(const SpringNetwork& network, Index body) {
  return !network.bodies[static_cast<std::size_t>(body)].carried.empty();
}

class FreePosition {
 public:
  FreePosition(const SpringNetwork& network, const ObstacleFrame& obstacles, const CollisionSurface& surface, Index body,
               const Points& wanted)
      : obstacles_(obstacles),
        surface_(surface),
        body_(body),
        wanted_(wanted),
        stays_whole_(stays_whole(network, body)),
        movable_(static_cast<std::size_t>(wanted.cols())) {
    const Body& own = network.bodies[static_cast<std::size_t>(body)];
    for (Index i = own.first_particle; i < own.first_particle + own.particle_count; ++i) {
      movable_[static_cast<std::size_t>(i)] = network.is_pinned(i) ? 0 : 1;
    }
  }

  [[nodiscard]] std::optional<Points> outside_obstacles() const {
    double depth = 0.0;
    for (const auto& inside : intersections(wanted_).inside) depth = std::max(depth, inside.depth);
    const double size = surface_.element_size[static_cast<std::size_t>(body_)];
    const bool shallow = !stays_whole_ && (depth <= size || size == 0.0);
    if (shallow) {
      if (auto moved = away_from_surfaces(size, depth)) return moved;
    }
    const auto is_outside = [&](const Points& x) { return is_outside_obstacles(x); };
    if (auto moved = translated(kFirstDistance * (size > 0.0 ? size : depth), is_outside)) return moved;
    return shallow || stays_whole_ ? std::nullopt : away_from_surfaces(size, depth);
  }

  /// A position of the whole body outside obstacles and other bodies.
  [[nodiscard]] std::optional<Points> outside_all() const {
    return translated(kFirstDistance * surface_.element_size[static_cast<std::size_t>(body_)], [&](const Points& x) {
      return !crosses_another(crossing_bodies(surface_, x), body_) && is_outside_obstacles(x);
    });
  }

 private:
  [[nodiscard]] Intersections intersections(const Points& x) const { return find_intersections(obstacles_, surface_, x, body_); }

  [[nodiscard]] bool is_outside_obstacles(const Points& x) const { return intersections(x).empty(); }

  [[nodiscard]] std::optional<Points> away_from_surfaces(double size, double depth) const {
    for (const double fraction : kTrialDistances) {
      Points moved = moved_off(fraction * size, depth);
      if (is_outside_obstacles(moved)) return moved;
    }
    return std::nullopt;
  }

  /// The wanted positions, with particles closer to a surface than gap + `beyond` [m], or inside it, moved to that distance.
  [[nodiscard]] Points moved_off(double beyond, double depth) const {
    Points moved = wanted_;
    for (const Contact& contact : obstacles_.contacts({wanted_, wanted_, surface_.thickness, beyond + depth})) {
      const Index i = contact.particles[0];
      if (movable_[static_cast<std::size_t>(i)] == 0) continue;
      const ContactMaterial& material = obstacles_.obstacle(contact.obstacle).material;
      const double gap = std::max(surface_.thickness[i] + material.thickness, 2.0 * contact.clearance);
      const double height = contact.normal.dot(moved.col(i) - contact.point);
      if (height < gap + beyond) moved.col(i) += (gap + beyond - height) * contact.normal;
    }
    return moved;
  }

  template <class IsFree>
  [[nodiscard]] std::optional<Points> translated(double first_distance, const IsFree& is_free) const {
    double distance = first_distance;
    for (int doubling = 0; doubling < kMaxDoublings; ++doubling, distance *= 2.0) {
      for (const Vector3& direction : escape_directions()) {
        Points moved = wanted_;
        for (Index i = 0; i < static_cast<Index>(moved.cols()); ++i) {
          if (movable_[static_cast<std::size_t>(i)] != 0) moved.col(i) += distance * direction;
        }
        if (is_free(moved)) return moved;
      }
    }
    return std::nullopt;
  }

  const ObstacleFrame& obstacles_;
  const CollisionSurface& surface_;
  Index body_;
  const Points& wanted_;
  bool stays_whole_;
  std::vector<char> movable_;  ///< per particle: 1 for unpinned particles of the body
};

// A body without segments and faces has no element size: it moves in so many strides.
constexpr int kStridesOfParticles = 8;

// Further strides, for particles that slide along an obstacle and so take a longer path.
constexpr int kMoreStrides = 32;

// Lower bound of a stopped particle's stride, as a fraction of a full stride.
constexpr double kShortest = 1.0 / 64.0;

// The approach ends when no particle moves by this fraction of a stride.
constexpr double kArrived = 1.0e-3;

// Afterwards, contact is solved until no particle moves by this fraction of a stride, at most so many times.
constexpr double kSettled = 1.0e-6;
constexpr int kMaxSettling = 16;

SpringNetwork only_moving(SpringNetwork network, Index body) {
  const Body& own = network.bodies[static_cast<std::size_t>(body)];
  for (Index i = 0; i < network.particle_count(); ++i) {
    if (i < own.first_particle || i >= own.first_particle + own.particle_count) network.inverse_masses[i] = 0.0;
  }
  for (Body& each : network.bodies) each.material.friction = each.material.static_friction = 0.0;
  return network;
}

/// Moves a body from an intersection-free position towards the wanted one, as far as obstacles and other bodies permit.
class Approach {
 public:
  /// Only this body moves. Keeps a reference to the frame.
  Approach(const SpringNetwork& network, const ObstacleFrame& obstacles, Index body);

  /// Positions [m] after an approach from `free`, where the body intersects nothing, towards `wanted`. The body moves in strides of
  /// its element size. Particles that touch a surface slide along it; the others reach their wanted positions exactly.
  [[nodiscard]] Points run(const Points& free, const Points& wanted);

 private:
  /// Moves `x` to `advanced` under contact and truncation. Returns the largest displacement of a particle [m].
  double stride(Points& x, const Points& advanced);

  SpringNetwork network_;  ///< without friction, all other bodies pinned
  double length_ = 0.0;    ///< of a stride [m]; 0 for a body without segments and faces
  const ObstacleFrame& obstacles_;
  ContactProjection contacts_;
};

Approach::Approach(const SpringNetwork& network, const ObstacleFrame& obstacles, Index body)
    : network_(only_moving(network, body)),
      length_(contact_surface(network_).element_size[static_cast<std::size_t>(body)]),
      obstacles_(obstacles),
      contacts_(network_, obstacles.set()) {}

double Approach::stride(Points& x, const Points& advanced) {
  const Points before = x;
  x = advanced;
  const Points none = Points::Zero(3, x.cols());
  const Slip no_slip{.displacement = none, .obstacle = std::vector<Index>(static_cast<std::size_t>(x.cols()), kNone)};
  const StepMotion motion{before, none, no_slip, advanced, 1.0};
  contacts_.find(obstacles_, motion);
  contacts_.push_out(x);
  contacts_.truncate(obstacles_, motion, x);
  return (x - before).colwise().norm().maxCoeff();
}

Points Approach::run(const Points& free, const Points& wanted) {
  const double path = (wanted - free).colwise().norm().maxCoeff();
  const double longest = length_ > 0.0 ? length_ : path / kStridesOfParticles;
  const int strides = static_cast<int>(std::ceil(path / longest)) + kMoreStrides;
  Scalars lengths = Scalars::Constant(free.cols(), longest);
  Points x = free;
  for (int k = 0; k < strides; ++k) {
    const Points before = x;
    Points advanced = x;
    for (Index i = 0; i < static_cast<Index>(x.cols()); ++i) {
      const Vector3 left = wanted.col(i) - x.col(i);
      const double distance = left.norm();
      advanced.col(i) = distance <= lengths[i] ? Vector3(wanted.col(i)) : Vector3(x.col(i) + lengths[i] / distance * left);
    }
    if (stride(x, advanced) <= kArrived * longest) break;
    // A stopped particle gets a short stride: the safe region of a long displacement spans much of an obstacle, at high cost.
    lengths = (2.0 * (x - before).colwise().norm().transpose()).cwiseMax(kShortest * longest).cwiseMin(longest);
  }
  for (int k = 0; k < kMaxSettling; ++k) {
    if (stride(x, Points(x)) <= kSettled * longest) break;
  }
  return x;
}

/// Bodies by their claim to stay.
struct Ranks {
  std::vector<Index> unpinned;  ///< those that come first in the network should stay
  std::vector<Index> pinned;    ///< at least in part: moving them would stretch them
};

Ranks ranks_of(const SpringNetwork& network) {
  Ranks ranks;
  for (Index number = 0; number < static_cast<Index>(network.bodies.size()); ++number) {
    const Body& body = network.bodies[static_cast<std::size_t>(number)];
    const bool free = (network.inverse_masses.segment(body.first_particle, body.particle_count).array() > 0.0).all();
    (free ? ranks.unpinned : ranks.pinned).push_back(number);
  }
  return ranks;
}

std::vector<Index> joined(std::vector<Index> first, const std::vector<Index>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

/// Layers are put on one after another, in the given order: each body is lifted off those before it that it crosses. Those after it
/// do not matter yet.
void put_on(const SpringNetwork& network, const ObstacleFrame& obstacles, const CollisionSurface& surface,
            const std::vector<Index>& order, Points& positions) {
  std::set<BodyPair> crossing = crossing_bodies(surface, positions);
  SpringNetwork worn = network;
  for (Body& body : worn.bodies) body.contact.others = false;
  std::vector<Index> below;
  for (const Index body : order) {
    const auto number = static_cast<std::size_t>(body);
    worn.bodies[number].contact.others = network.bodies[number].contact.others;
    const auto crosses = [&](Index other) { return crossing.contains(std::minmax(body, other)); };
    if (!stays_whole(network, body) && std::any_of(below.begin(), below.end(), crosses)) {
      if (const auto free = lifted_off(network, obstacles, surface, body, below, positions)) {
        positions = Approach(worn, obstacles, body).run(*free, positions);
        crossing = crossing_bodies(surface, positions);
      }
    }
    below.push_back(body);
  }
}

}  // namespace

Points push_out(const SpringNetwork& network, const ObstacleFrame& obstacles, const CollisionSurface& surface, const Points& wanted,
                bool apart) {
  Points positions = wanted;
  const auto approach_from = [&](Index body, const std::optional<Points>& free) {
    if (!free) return;
    positions = stays_whole(network, body) ? *free : Approach(network, obstacles, body).run(*free, positions);
  };
  for (Index body = 0; body < static_cast<Index>(network.bodies.size()); ++body) {
    if (find_intersections(obstacles, surface, positions, body).empty()) continue;
    approach_from(body, FreePosition(network, obstacles, surface, body, positions).outside_obstacles());
  }
  if (!apart) return positions;
  auto [unpinned, pinned] = ranks_of(network);
  put_on(network, obstacles, surface, joined(pinned, unpinned), positions);
  // A body that could not be lifted off one that should rather stay: now the other way round.
  std::reverse(unpinned.begin(), unpinned.end());
  std::reverse(pinned.begin(), pinned.end());
  put_on(network, obstacles, surface, joined(pinned, unpinned), positions);
  std::set<BodyPair> crossing = crossing_bodies(surface, positions);
  for (const Index body : joined(unpinned, pinned)) {
    if (!crosses_another(crossing, body)) continue;
    approach_from(body, FreePosition(network, obstacles, surface, body, positions).outside_all());
    crossing = crossing_bodies(surface, positions);
  }
  return positions;
}

}  // namespace sprung
