// The shapes of the generated environments, in metres, Y up.
#pragma once

#include "geometry/mesh/polygon_mesh.h"
#include "geometry/mesh/triangle_mesh.h"

#include <vector>

namespace sprung::meshes {

/// Rounds to the micrometre, so that the sines of every machine give the same files.
[[nodiscard]] double to_micrometre(double metres);

/// A point of a profile that turns about the Y axis.
struct ProfilePoint {
  double radius = 0.0;
  double height = 0.0;
};

/// The solid that a closed profile sweeps about the Y axis. Requires the profile counter-clockwise, radius to the right and height
/// up.
[[nodiscard]] TriangleMesh revolve(const std::vector<ProfilePoint>& profile, Index segments);

/// A sphere.
[[nodiscard]] TriangleMesh ball();

/// A closed ring of tube.
[[nodiscard]] TriangleMesh torus();

/// A closed cone with a wall and a hole, standing on its neck.
[[nodiscard]] TriangleMesh funnel();

/// A closed disc with a needle in its middle.
[[nodiscard]] TriangleMesh spike();

/// A closed sphere of radius 1 m: an icosahedron, each triangle of which is divided into four so many times.
[[nodiscard]] TriangleMesh sphere(int divisions);

/// A closed balloon of 40 cm that narrows downwards, in triangles of about 2 cm.
[[nodiscard]] TriangleMesh balloon();

/// Hills over the unit square in x and z, heights in [-1, 1]: an open sheet.
[[nodiscard]] TriangleMesh hills();

/// A closed flight of steps that goes down along x, in quads.
[[nodiscard]] PolygonMesh stairs();

/// An open, level sheet of one layer, in quads.
[[nodiscard]] PolygonMesh thin_sheet();

/// A closed slab of water, in quads, whose top is a wave at `part` of its period: it goes along x for ever.
[[nodiscard]] PolygonMesh waves(double part);

}  // namespace sprung::meshes
