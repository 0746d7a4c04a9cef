// Small networks that collide with themselves, a brute-force count of their crossings, and a simple truncation.
#pragma once

#include "collision/impact_zones/pair_separation.h"
#include "collision/sample_meshes.h"
#include "geometry/queries/side_of_plane.h"

#include <functional>
#include <vector>

namespace sprung::test {

/// Bodies, one after another.
struct SelfNetwork {
  Points positions;
  std::vector<Element> elements;
  std::vector<Index> body_of;
  ParticleMotions motions;
  Index bodies = 0;

  [[nodiscard]] Index count() const { return static_cast<Index>(positions.cols()); }

  /// `side` x `side` squares along u and v, cut into triangles by alternating diagonals.
  void add_cloth(Index side, const Vector3& corner, const Vector3& u, const Vector3& v) {
    const Index first = count();
    for (Index j = 0; j <= side; ++j) {
      for (Index i = 0; i <= side; ++i) add_particle(corner + i * u + j * v);
    }
    const auto id = [&](Index i, Index j) { return first + j * (side + 1) + i; };
    for (Index j = 0; j < side; ++j) {
      for (Index i = 0; i < side; ++i) {
        const bool even = (i + j) % 2 == 0;
        const Index a = even ? id(i, j) : id(i + 1, j);
        const Index b = even ? id(i + 1, j) : id(i + 1, j + 1);
        const Index c = even ? id(i + 1, j + 1) : id(i, j + 1);
        const Index d = even ? id(i, j + 1) : id(i, j);
        elements.push_back({{a, b, c}, 3, bodies});
        elements.push_back({{a, c, d}, 3, bodies});
      }
    }
    ++bodies;
  }

  void add_rope(Index segments, const Vector3& from, const Vector3& step) {
    const Index first = count();
    for (Index i = 0; i <= segments; ++i) add_particle(from + i * step);
    for (Index i = 0; i < segments; ++i) elements.push_back({{first + i, first + i + 1, kNone}, 2, bodies});
    ++bodies;
  }

  void add_single_particle(const Vector3& position) {
    add_particle(position);
    ++bodies;
  }

  /// Every body collides with itself and all others.
  [[nodiscard]] CollisionSurface surface(double thickness) const {
    const std::vector<char> all(static_cast<std::size_t>(bodies), 1);
    return make_collision_surface(elements, positions, body_of, Scalars::Constant(count(), thickness), motions, all, all);
  }

 private:
  void add_particle(const Vector3& position) {
    positions.conservativeResize(3, count() + 1);
    positions.col(count() - 1) = position;
    body_of.push_back(bodies);
    motions.push_back(ParticleMotion::free);
  }
};

/// Whether the segment intersects the closed triangle, by exact predicates; false if all five points are coplanar.
inline bool segment_meets_triangle(const Vector3& p, const Vector3& q, const Vector3& a, const Vector3& b, const Vector3& c) {
  const double begin = side_of_plane(a, b, c, p);
  const double end = side_of_plane(a, b, c, q);
  if ((begin > 0.0 && end > 0.0) || (begin < 0.0 && end < 0.0) || (begin == 0.0 && end == 0.0)) return false;
  const double ab = side_of_plane(p, q, a, b);
  const double bc = side_of_plane(p, q, b, c);
  const double ca = side_of_plane(p, q, c, a);
  return (ab >= 0.0 && bc >= 0.0 && ca >= 0.0) || (ab <= 0.0 && bc <= 0.0 && ca <= 0.0);
}

/// Number of edges of an element that intersect a face with which they share no particle.
inline int count_crossings(const Element& element, const Element& face, const Points& x) {
  if (face.corners != 3) return 0;
  const auto& t = face.particles;
  Box3 box;
  for (const Index i : corners_of(face)) box.extend(x.col(i));
  int crossings = 0;
  for (int k = 0; k < (element.corners == 3 ? 3 : element.corners - 1); ++k) {
    const Index p = element.particles[static_cast<std::size_t>(k)];
    const Index q = element.particles[static_cast<std::size_t>((k + 1) % element.corners)];
    if (p == t[0] || p == t[1] || p == t[2] || q == t[0] || q == t[1] || q == t[2]) continue;
    Box3 edge(x.col(p));
    edge.extend(x.col(q));
    if (edge.intersects(box) && segment_meets_triangle(x.col(p), x.col(q), x.col(t[0]), x.col(t[1]), x.col(t[2]))) ++crossings;
  }
  return crossings;
}

/// Number of edges that intersect triangles with which they share no particle.
inline int count_crossings(const std::vector<Element>& elements, const Points& x) {
  int crossings = 0;
  for (const Element& face : elements) {
    for (const Element& other : elements) crossings += count_crossings(other, face, x);
  }
  return crossings;
}

/// Moves constrained particles near their targets by projections onto their half-spaces, or to their safe position.
inline Index truncate(PairSeparation& separation, const Points& before, Points& targets) {
  const std::vector<Index> constrained = separation.constrain(before, targets);
  std::vector<HalfSpace> half_spaces;
  for (const Index i : constrained) {
    Vector3 p = targets.col(i);
    half_spaces.clear();
    separation.append_half_spaces(i, half_spaces);
    const PairSeparation::Sphere sphere = separation.sphere(i);
    for (int sweep = 0; sweep < 8 && !separation.allows(i, p); ++sweep) {
      for (const HalfSpace& bound : half_spaces) {
        const double depth = bound.offset - bound.normal.dot(p);
        if (depth > 0.0) p += 1.001 * depth * bound.normal;
      }
      const Vector3 out = p - sphere.center;
      if (out.norm() > sphere.radius) p = sphere.center + 0.999 * sphere.radius / out.norm() * out;
    }
    targets.col(i) = separation.allows(i, p) ? p : separation.safe_position(i);
  }
  return static_cast<Index>(constrained.size());
}

/// Runs steps with the targets `move(step, before)` and returns the final positions. `look` sees those of each step.
inline Points run(const SelfNetwork& network, PairSeparation& separation, int steps,
                  const std::function<Points(int, const Points&)>& move, const std::function<void(const Points&)>& look = {}) {
  Points x = network.positions;
  std::vector<Contact> contacts;
  for (int step = 0; step < steps; ++step) {
    Points targets = move(step, x);
    contacts.clear();
    separation.begin_step(x, targets, contacts);
    truncate(separation, x, targets);
    x = targets;
    if (look) look(x);
  }
  return x;
}

}  // namespace sprung::test
