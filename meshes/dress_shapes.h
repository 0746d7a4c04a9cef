// A dress and the figure that wears it, in metres, Y up.
#pragma once

#include "geometry/mesh/polygon_mesh.h"
#include "geometry/mesh/triangle_mesh.h"

namespace sprung::meshes {

/// A closed lay figure on a stand: an ellipse at each height, with shoulders, a waist and hips.
[[nodiscard]] TriangleMesh figure();

/// A dress around the figure, 6 mm off its bodice, with a wide skirt: an open mesh of quads. Its panels, a front and a back, have
/// vertices and UVs of their own along the two seams, where the vertices coincide. Groups from the top: collar, bodice, waist,
/// skirt.
[[nodiscard]] PolygonMesh dress();

}  // namespace sprung::meshes
