// Resistance of triangles to bending, as arrays.
#pragma once

#include "base/types.h"

#include <array>
#include <vector>

namespace sprung {

/// Edges between two triangles, as arrays; entry h of each array belongs to hinge h. The angle theta of a hinge is that between the
/// normals of the triangles, 0 where they lie in one plane, positive where their far corners lie on the side of the normals.
struct Hinges {
  std::vector<std::array<Index, 4>>
      particles;                   ///< both ends of the edge, the far corner of the triangle on its left, and the other
  std::vector<double> rest_angle;  ///< [rad]
  std::vector<std::array<double, 2>> rest_area;  ///< of the triangle on the left and the other [m^2], > 0
  /// For slight bends of flat triangles, theta is the sum of `weights` [1/m] times the displacements of `particles` along the
  /// normal.
  std::vector<std::array<double, 4>> weights;

  [[nodiscard]] Index count() const { return static_cast<Index>(particles.size()); }
};

/// Elements that keep the curvature of triangles, as arrays; entry f of each array belongs to element f. With the angles phi by
/// which its hinges deviate from rest, the energy is 1/2 k |F phi|^2 [J].
struct FaceBends {
  std::vector<std::array<Index, 3>> hinges;  ///< of the network or body; kNone at an edge without a second triangle
  /// F [1]: F phi is the change of curvature, as xx, yy and sqrt(2) xy, times the square root of the triangle's area.
  std::vector<Matrix3> curvature;
  std::vector<double> stiffness;  ///< k, the flexural rigidity [N m], >= 0
  std::vector<double> damping;    ///< c [N m s], >= 0: moments as those of k, of the rates of phi

  [[nodiscard]] Index count() const { return static_cast<Index>(hinges.size()); }
};

/// The corners of an element's triangle and of its neighbours.
struct BendStencil {
  std::array<Index, 6> particles{};                       ///< entries that are not used repeat the first
  std::array<std::array<std::size_t, 4>, 3> of_hinges{};  ///< where the particles of each hinge are in `particles`
};

[[nodiscard]] BendStencil stencil_of(const FaceBends& bends, const Hinges& hinges, Index element);

/// The rows of F phi of flat triangles with slight bends, as products with the displacements [m] of the stencil along the normal.
[[nodiscard]] std::array<std::array<double, 6>, 3> weights_of(const FaceBends& bends, const Hinges& hinges, Index element);

}  // namespace sprung
