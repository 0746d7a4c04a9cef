#include "base/format.h"
#include "network/corners.h"
#include "scene/building/body_builder.h"
#include "scene/json/json_text.h"

#include <algorithm>
#include <map>

namespace sprung {
namespace {

/// Finds the particles of one pin.
class PinFinder {
 public:
  PinFinder(const Scene& scene, const BodyScene& body, const BuiltBody& placed, std::string key, std::vector<Problem>& problems)
      : scene_(scene),
        body_(body),
        placed_(placed),
        positions_(placed.shape.positions),
        key_(std::move(key)),
        problems_(problems) {}

  std::vector<Index> find(const PinScene& pin) {
    std::vector<Index> particles = std::visit([&](const auto& where) { return at(where); }, pin.where);
    std::sort(particles.begin(), particles.end());
    particles.erase(std::unique(particles.begin(), particles.end()), particles.end());
    return particles;
  }

 private:
  std::vector<Index> at(const PinCorners& corners) {
    std::vector<Index> particles;
    for (const std::string& name : corners.which) {
      if (const auto particle = std::visit([&](const auto& shape) { return corner(shape, name); }, body_.shape)) {
        particles.push_back(*particle);
      }
    }
    return particles;
  }

  static std::optional<Index> corner(const MeshFile& /*mesh*/, const std::string& /*name*/) { return std::nullopt; }
  template <class Shape>
  static std::optional<Index> corner(const Shape& shape, const std::string& name) {
    return corner_particle(shape, name);
  }

  std::vector<Index> at(const PinIndices& indices) {
    std::vector<Index> particles;
    const bool welded = placed_.source && !placed_.source->particle_of.empty();
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

  std::vector<Index> at(const PinNearest& nearest) {
    const auto nearer = [&](const Vector3& a, const Vector3& b) {
      return (a - nearest.point).squaredNorm() < (b - nearest.point).squaredNorm();
    };
    return {static_cast<Index>(std::min_element(positions_.begin(), positions_.end(), nearer) - positions_.begin())};
  }

  std::vector<Index> at(const PinBox& box) {
    // Rounding error of placed particles, so that a box that ends exactly at a row of particles contains it.
    constexpr double kRounding = 1e-12;
    double size = 0.0;
    for (const Vector3& position : positions_) size = std::max(size, position.cwiseAbs().maxCoeff());
    const Vector3 slack = Vector3::Constant(kRounding * size);
    const Box3 wide(box.lower - slack, box.upper + slack);
    std::vector<Index> particles;
    for (std::size_t i = 0; i < positions_.size(); ++i) {
      if (wide.contains(positions_[i])) particles.push_back(static_cast<Index>(i));
    }
    if (particles.empty()) report(".box", "", "contains no particle of the body", extent_text());
    return particles;
  }

  std::string extent_text() const {
    Box3 bounds;
    for (const Vector3& position : positions_) bounds.extend(position);
    const auto list = [](const Vector3& point) { return Json{point.x(), point.y(), point.z()}; };
    return "at time 0 the body lies in the box " + shortened(Json::array({list(bounds.min()), list(bounds.max())}));
  }

  void report(const std::string& suffix, const std::string& value, const std::string& rule, const std::string& remedy) {
    problems_.push_back({scene_.file.string(), key_ + suffix, value, rule, remedy});
  }

  const Scene& scene_;
  const BodyScene& body_;
  const BuiltBody& placed_;
  const std::vector<Vector3>& positions_;
  std::string key_;
  std::vector<Problem>& problems_;
};

}  // namespace

std::vector<ResolvedPin> resolve_pins(const Scene& scene, const BodyScene& body, const BuiltBody& placed,
                                      std::vector<Problem>& problems) {
  const std::string key = join_path("bodies", body.name) + ".pins";
  std::map<Index, std::size_t> first_pin;  // the first pin of a particle
  std::vector<Index> still;
  std::vector<ResolvedPin> resolved;
  for (std::size_t p = 0; p < body.pins.size(); ++p) {
    const PinScene& pin = body.pins[p];
    std::vector<Index> particles = PinFinder(scene, body, placed, join_path(key, p), problems).find(pin);
    for (const Index particle : particles) {
      const auto [first, is_new] = first_pin.emplace(particle, p);
      if (is_new || (!pin.motion.moves() && !body.pins[first->second].motion.moves())) continue;
      problems.push_back(
          {scene.file.string(), join_path(key, p), "",
           "pins particle " + std::to_string(particle) + " like " + join_path("pins", first->second) + ", but with another motion",
           "pin each particle once"});
      break;
    }
    if (pin.motion.moves()) {
      resolved.push_back({std::move(particles), pin.motion});
    } else {
      still.insert(still.end(), particles.begin(), particles.end());
    }
  }
  if (still.empty()) return resolved;
  std::sort(still.begin(), still.end());
  still.erase(std::unique(still.begin(), still.end()), still.end());
  resolved.push_back({std::move(still), {}});
  return resolved;
}

}  // namespace sprung
