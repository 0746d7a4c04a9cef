// Boxes of cubes, each cut into tetrahedra.
#pragma once

#include "geometry/tetrahedra/tetrahedra_mesh.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <random>
#include <utility>

namespace sprung::test {

enum class Cut : std::uint8_t {
  five,     ///< one regular tetrahedron in the middle and four in corners; mirrored from cube to cube
  six,      ///< around one space diagonal, the same in all cubes (Kuhn)
  mirrored  ///< into six, mirrored from cube to cube
};

/// The box [0, cubes[0] side] x ..., whose vertices are numbered x fastest, then y, then z.
inline TetrahedraMesh make_box(const std::array<Index, 3>& cubes, double side, Cut cut) {
  TetrahedraMesh mesh;
  mesh.vertices.resize(3, Eigen::Index{cubes[0] + 1} * (cubes[1] + 1) * (cubes[2] + 1));
  const auto number = [&](const std::array<Index, 3>& node) {
    return node[0] + (cubes[0] + 1) * (node[1] + (cubes[1] + 1) * node[2]);
  };
  for (Index k = 0; k <= cubes[2]; ++k) {
    for (Index j = 0; j <= cubes[1]; ++j) {
      for (Index i = 0; i <= cubes[0]; ++i) mesh.vertices.col(number({i, j, k})) = side * Vector3(i, j, k);
    }
  }
  // Bits 0, 1, 2 of a corner are its x, y, z in the cube.
  constexpr int kFive[5][4] = {{0, 3, 5, 6}, {1, 0, 3, 5}, {2, 0, 3, 6}, {4, 0, 5, 6}, {7, 3, 5, 6}};
  constexpr int kSix[6][4] = {{0, 1, 3, 7}, {0, 1, 5, 7}, {0, 2, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 4, 6, 7}};
  const auto add = [&](const std::array<Index, 3>& cube, const int(&corners)[4]) {
    const int mirror = cut == Cut::six    ? 0
                       : cut == Cut::five ? (cube[0] + cube[1] + cube[2]) % 2
                                          : cube[0] % 2 + 2 * (cube[1] % 2) + 4 * (cube[2] % 2);
    std::array<Index, 4>& tetrahedron = mesh.tetrahedra.emplace_back();
    for (std::size_t c = 0; c < 4; ++c) {
      const int corner = corners[c] ^ mirror;
      tetrahedron[c] = number({cube[0] + (corner & 1), cube[1] + (corner >> 1 & 1), cube[2] + (corner >> 2)});
    }
    if (tetrahedron_volume(mesh.vertices, tetrahedron) < 0.0) std::swap(tetrahedron[2], tetrahedron[3]);
  };
  for (Index k = 0; k < cubes[2]; ++k) {
    for (Index j = 0; j < cubes[1]; ++j) {
      for (Index i = 0; i < cubes[0]; ++i) {
        if (cut == Cut::five) {
          for (const auto& corners : kFive) add({i, j, k}, corners);
        } else {
          for (const auto& corners : kSix) add({i, j, k}, corners);
        }
      }
    }
  }
  return mesh;
}

/// Moves each vertex by up to `distance` along each axis, those on a face of the box within the face.
inline void jitter(TetrahedraMesh& mesh, double distance, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> shift(-distance, distance);
  const Vector3 upper = mesh.vertices.rowwise().maxCoeff();
  for (Eigen::Index i = 0; i < mesh.vertices.cols(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      double& x = mesh.vertices(axis, i);
      const double moved = x + shift(random);
      if (x > 0.0 && x < upper[axis]) x = moved;
    }
  }
}

}  // namespace sprung::test
