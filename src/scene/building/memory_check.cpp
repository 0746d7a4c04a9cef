#include "scene/building/memory_check.h"

#include "base/format.h"
#include "scene/json/json_text.h"

#include <algorithm>
#include <span>
#include <string>
#include <variant>

namespace sprung {
namespace {

// Memory per particle with structural springs only, measured with a million particles [bytes].
constexpr double kBytesOfRope = 560.0;
constexpr double kBytesOfCloth = 800.0;
constexpr double kBytesOfSolid = 680.0;

constexpr double kGigabyte = 1.0e9;

double product(std::span<const Index> resolution) {
  double particles = 1.0;
  for (const Index side : resolution) particles *= side;
  return particles;
}

struct ShapeBytes {
  double operator()(const RopeShape& rope) const {
    return kBytesOfRope * rope.particles.value_or(static_cast<Index>(rope.points.size()));
  }
  double operator()(const ClothShape& cloth) const { return kBytesOfCloth * product(cloth.resolution); }
  double operator()(const SolidShape& solid) const { return kBytesOfSolid * product(solid.resolution); }
  double operator()(const MeshFile& /*mesh*/) const { return 0.0; }              // it is not read yet
  double operator()(const LatticeFile& /*lattice*/) const { return 0.0; }        // likewise
  double operator()(const TetrahedraFile& /*tetrahedra*/) const { return 0.0; }  // likewise
};

double bytes_of(const BodyScene& body) { return std::visit(ShapeBytes{}, body.shape); }

std::string gigabytes(double bytes) { return format_number(bytes / kGigabyte, 3) + " GB"; }

}  // namespace

void check_memory(const std::vector<BodyScene>& bodies, double memory, std::vector<Problem>& problems) {
  double all = 0.0;
  for (const BodyScene& body : bodies) all += bytes_of(body);
  if (bodies.empty() || all <= memory) return;
  const auto largest = std::ranges::max_element(bodies, {}, bytes_of);
  const bool is_rope = std::holds_alternative<RopeShape>(largest->shape);
  problems.push_back(
      {.key = join_path("bodies", largest->name) + (is_rope ? ".shape.particles" : ".shape.resolution"),
       .rule = "is too large: the bodies take at least " + gigabytes(all) + " of memory, and this machine has " + gigabytes(memory),
       .remedy = "use fewer particles"});
}

}  // namespace sprung
