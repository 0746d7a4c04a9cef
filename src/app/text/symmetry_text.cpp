#include "app/text/symmetry_text.h"

#include "app/text/mesh_text.h"
#include "base/format.h"
#include "geometry/mesh/triangle_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace sprung {
namespace {

/// What a mirror image must have: position, velocity, mass, and whether the particle is fixed, in units of rounding.
using Mark = std::array<std::int64_t, 8>;

/// The marks of all particles, sorted; of their mirror images where `sign` is -1. Positions along `axis` count from `middle` [m].
std::vector<Mark> marks_of(const Simulator& simulator, Index axis, double middle, double extent, double sign) {
  constexpr double kRounding = 1e-9;
  const SpringNetwork& network = simulator.network();
  const Points& positions = simulator.positions();
  std::vector<Mark> marks;
  marks.reserve(static_cast<std::size_t>(network.particle_count()));
  for (Index i = 0; i < network.particle_count(); ++i) {
    Vector3 position = positions.col(i);
    Vector3 velocity = simulator.state().v.col(i);
    position[axis] = sign * (position[axis] - middle);
    velocity[axis] *= sign;
    Mark mark{};
    for (Index k = 0; k < 3; ++k) {
      mark[static_cast<std::size_t>(k)] = std::llround(position[k] / (kRounding * extent));
      mark[static_cast<std::size_t>(k) + 3] = std::llround(velocity[k] / kRounding);
    }
    mark[6] = std::llround(std::log(network.masses[i]) / kRounding);
    mark[7] = network.is_pinned(i) ? 1 : 0;
    marks.push_back(mark);
  }
  std::ranges::sort(marks);
  return marks;
}

}  // namespace

std::string symmetry_row(const Simulator& simulator) {
  const Box3 box = bounds(simulator.positions());
  const double extent = box.sizes().maxCoeff();
  for (const Index axis : {Index{0}, Index{2}}) {
    const double middle = box.center()[axis];
    if (box.sizes()[axis] <= 0.0) continue;  // a scene in the plane itself
    if (marks_of(simulator, axis, middle, extent, 1.0) != marks_of(simulator, axis, middle, extent, -1.0)) continue;
    return text_row("symmetry", fmt::format("the bodies begin in mirror symmetry across {} = {} m; folds and sliding lose it to "
                                            "millimetres per metre within seconds, as constraints are solved in an order",
                                            axis == 0 ? "x" : "z", format_number(middle, 4)));
  }
  return "";
}

}  // namespace sprung
