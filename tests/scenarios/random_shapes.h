// Random bodies and obstacles, for random scenes.
#pragma once

#include "collision/sample_meshes.h"
#include "collision/shapes/obstacle.h"
#include "network/bodies/body_shape.h"

#include <cstdint>
#include <initializer_list>
#include <vector>

namespace sprung::testing {

using test::Random;

[[nodiscard]] double one_of(Random& random, std::initializer_list<double> values);
[[nodiscard]] Matrix3 random_rotation(Random& random);

/// A coarse cloth, a rope or a jelly, constrained by the stretch limit or by a few soft springs alone. One in three has springs
/// that yield, break or both.
[[nodiscard]] BodyShape random_shape(Random& random);

/// A rope, cloth or mesh that resists bending. One in three has springs that yield, break or both.
[[nodiscard]] BodyShape random_bent_shape(Random& random);

enum class Filled : std::uint8_t { lattice, coarse_lattice, tetrahedra, balloon };

/// A closed surface that cells carry, tetrahedra, or a skin around a gas or a liquid.
[[nodiscard]] BodyShape random_filled_shape(Filled kind, Random& random);

[[nodiscard]] ObstacleGeometry random_primitive(Random& random);

/// Moves in a straight line with a rotation to a random pose and back, again and again, from `begin` to `begin` + 1 [s].
[[nodiscard]] Motion swing(double begin, Random& random);

/// A primitive, a mesh or a deforming mesh that rests, or moves and rotates up to very fast.
[[nodiscard]] Obstacle random_obstacle(Random& random);

/// A rigid obstacle that swings above a floor from `begin` [s] on. There always is room between the two.
[[nodiscard]] std::vector<Obstacle> swing_above_floor(double begin, Random& random);

}  // namespace sprung::testing
