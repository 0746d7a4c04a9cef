// Scalar, vector and array types of all folders. SI units throughout: m, kg, s, N.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstdint>

namespace sprung {

/// Number of a particle, spring, triangle, body or obstacle, counted from 0; -1 means "none".
using Index = std::int32_t;
inline constexpr Index kNone = -1;

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;

/// A quantity per particle or vertex, 3 x n: column i belongs to particle i.
using Points = Eigen::Matrix3Xd;

/// A scalar per particle, spring or vertex.
using Scalars = Eigen::VectorXd;

/// Vertex indices, 3 x n: column t is triangle t, counter-clockwise seen from outside.
using Triangles = Eigen::Matrix<Index, 3, Eigen::Dynamic>;

/// Vertex indices, 2 x n: column e is edge e.
using Edges = Eigen::Matrix<Index, 2, Eigen::Dynamic>;

/// Axis-aligned box; empty when default constructed.
using Box3 = Eigen::AlignedBox3d;

/// Rotation and translation, x -> R x + t, without scale. A default one is uninitialized: begin with RigidTransform::Identity().
using RigidTransform = Eigen::Isometry3d;

}  // namespace sprung
