#include "scene/building/particle_selector.h"

#include "base/format.h"
#include "network/bodies/corners.h"
#include "scene/json/json_text.h"
#include "scene/json/nearest_name.h"

#include <algorithm>
#include <limits>
#include <optional>

namespace sprung {
namespace {

/// The positions of the particles that a scene can name [m]: all but the vertices that contact alone has, so that a selector
/// means the same for coarse meshes as for fine ones.
std::vector<Vector3> named_positions(const BodyShape& shape) {
  std::vector<Vector3> positions = shape.positions;
  const auto end = positions.begin() + std::ssize(shape.carried);
  positions.erase(end - shape.contact_only, end);
  return positions;
}

/// Finds the particles of one selector.
class ParticleFinder {
 public:
  ParticleFinder(const BodyScene& body, const BuiltBody& placed, const SelectorLocation& location, std::vector<Problem>& problems)
      : body_(body), placed_(placed), positions_(named_positions(placed.shape)), location_(location), problems_(problems) {}

  std::vector<Index> find(const Selector& selector) {
    std::vector<Index> particles = std::visit([&](const auto& where) { return at(where); }, selector);
    std::sort(particles.begin(), particles.end());
    particles.erase(std::unique(particles.begin(), particles.end()), particles.end());
    const BodyShape& shape = placed_.shape;
    const auto exported = static_cast<Index>(shape.carried.size()) - shape.contact_only;
    for (Index& particle : particles) particle += particle < exported ? 0 : shape.contact_only;
    return particles;
  }

 private:
  std::vector<Index> at(const CornersSelector& corners) {
    std::vector<Index> particles;
    for (const std::string& name : corners.which) {
      if (const auto particle = std::visit([&](const auto& shape) { return corner(shape, name); }, body_.shape)) {
        particles.push_back(*particle);
      }
    }
    return particles;
  }

  static std::optional<Index> corner(const TetrahedraFile& /*tetrahedra*/, const std::string& /*name*/) { return std::nullopt; }
  static std::optional<Index> corner(const MeshFile& /*mesh*/, const std::string& /*name*/) { return std::nullopt; }
  static std::optional<Index> corner(const LatticeFile& /*lattice*/, const std::string& /*name*/) { return std::nullopt; }
  template <class Shape>
  static std::optional<Index> corner(const Shape& shape, const std::string& name) {
    return corner_particle(shape, name);
  }

  std::vector<Index> at(const IndicesSelector& indices) {
    std::vector<Index> particles;
    const bool welded = is_welded();
    const std::size_t count = welded ? placed_.source->particle_of.size() : positions_.size();
    for (std::size_t i = 0; i < indices.indices.size(); ++i) {
      const Index index = indices.indices[i];
      if (static_cast<std::size_t>(index) < count) {
        particles.push_back(welded ? placed_.source->particle_of[index] : index);
      } else {
        report(join_path(".indices", i), std::to_string(index),
               welded ? "the file has " + std::to_string(count) + " vertices" : "the body has " + counted(count, "particle"),
               "they are numbered from 0 to " + std::to_string(count - 1));
      }
    }
    return particles;
  }

  std::vector<Index> at(const NearestSelector& nearest) {
    const auto nearer = [&](const Vector3& a, const Vector3& b) {
      return (a - nearest.point).squaredNorm() < (b - nearest.point).squaredNorm();
    };
    return {static_cast<Index>(std::min_element(positions_.begin(), positions_.end(), nearer) - positions_.begin())};
  }

  std::vector<Index> at(const BoxSelector& box) {
    const Vector3 slack = Vector3::Constant(rounding());
    const Box3 wide(box.lower - slack, box.upper + slack);
    std::vector<Index> particles;
    for (std::size_t i = 0; i < positions_.size(); ++i) {
      if (wide.contains(positions_[i])) particles.push_back(static_cast<Index>(i));
    }
    if (particles.empty()) report(".box", "", "contains no particle of the body", extent_text());
    return particles;
  }

  std::vector<Index> at(const SphereSelector& sphere) {
    const double reach = sphere.radius + rounding();
    std::vector<Index> particles;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < positions_.size(); ++i) {
      const double distance = (positions_[i] - sphere.centre).norm();
      nearest = std::min(nearest, distance);
      if (distance <= reach) particles.push_back(static_cast<Index>(i));
    }
    if (particles.empty()) {
      report(".sphere", "", "contains no particle of the body",
             "at time 0 the nearest particle is " + format_number(nearest, 6) + " m from its centre");
    }
    return particles;
  }

  std::vector<Index> at(const GroupSelector& group) {
    const auto found = placed_.groups.find(group.name);
    if (found == placed_.groups.end()) {
      const Problem problem = unknown_group(group.name, placed_.groups);
      report(".group", problem.value, problem.rule, problem.remedy);
      return {};
    }
    std::vector<Index> particles = found->second.vertices;
    if (is_welded()) {
      for (Index& vertex : particles) vertex = placed_.source->particle_of[vertex];
    }
    return particles;
  }

  [[nodiscard]] bool is_welded() const { return placed_.source && !placed_.source->particle_of.empty(); }

  /// Rounding error of placed particles [m], so that a box or sphere that ends exactly at a row of particles contains it.
  [[nodiscard]] double rounding() const {
    constexpr double kRounding = 1e-12;
    double size = 0.0;
    for (const Vector3& position : positions_) size = std::max(size, position.cwiseAbs().maxCoeff());
    return kRounding * size;
  }

  std::string extent_text() const {
    Box3 bounds;
    for (const Vector3& position : positions_) bounds.extend(position);
    const auto list = [](const Vector3& point) { return Json{point.x(), point.y(), point.z()}; };
    return "at time 0 the body lies in the box " + shortened(Json::array({list(bounds.min()), list(bounds.max())}));
  }

  void report(const std::string& suffix, const std::string& value, const std::string& rule, const std::string& remedy) {
    problems_.push_back({location_.file, location_.key + suffix, value, rule, remedy});
  }

  const BodyScene& body_;
  const BuiltBody& placed_;
  const std::vector<Vector3> positions_;
  const SelectorLocation& location_;
  std::vector<Problem>& problems_;
};

}  // namespace

Problem unknown_group(const std::string& name, const ObjGroups& groups) {
  std::vector<std::string> names;
  for (const auto& named : groups) names.push_back(named.first);
  return {.value = "\"" + name + "\"",
          .rule = names.empty() ? "the mesh has no group, object or material with faces or lines"
                                : "must be a group, object or material of the mesh: " + joined(names),
          .remedy = did_you_mean(name, names)};
}

std::vector<Index> select_particles(const Selector& selector, const BodyScene& body, const BuiltBody& placed,
                                    const SelectorLocation& location, std::vector<Problem>& problems) {
  return ParticleFinder(body, placed, location, problems).find(selector);
}

}  // namespace sprung
