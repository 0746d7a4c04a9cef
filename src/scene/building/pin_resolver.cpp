#include "scene/building/pin_resolver.h"

#include "base/problem_list.h"
#include "network/model/activity.h"
#include "scene/building/particle_selector.h"
#include "scene/json/json_text.h"

#include <algorithm>
#include <map>
#include <set>

namespace sprung {
namespace {

bool rests_for_ever(const Pin& pin) { return !pin.moves() && pin.holds_always(); }

Index number_of_obstacle(const Scene& scene, const std::string& name) {
  const auto found = std::ranges::find(scene.obstacles, name, &ObstacleScene::name);
  return found != scene.obstacles.end() ? static_cast<Index>(found - scene.obstacles.begin()) : kNone;
}

/// Reports particles that two pins hold at one time.
class PinComparison {
 public:
  PinComparison(const Scene& scene, std::string key, std::vector<Problem>& problems)
      : scene_(scene), key_(std::move(key)), problems_(problems) {}

  /// Compares the next pin of the body with those before.
  void add(const Pin& pin) {
    const std::size_t p = pins_.size();
    bool reported = false;
    for (const Index particle : pin.particles) {
      std::vector<std::size_t>& others = pins_of_[particle];
      for (const std::size_t number : others) {
        const Pin& other = pins_[number];
        if (reported || !hold_together(other, pin) || (rests_for_ever(other) && rests_for_ever(pin))) continue;
        report(p, pin, particle, number, other);
        reported = true;
      }
      others.push_back(p);
    }
    pins_.push_back(pin);
    pins_.back().particles.clear();
  }

 private:
  void report(std::size_t p, const Pin& pin, Index particle, std::size_t number, const Pin& other) {
    const bool always = pin.holds_always() && other.holds_always();
    problems_.push_back({scene_.file.string(), join_path(key_, p), "",
                         "pins particle " + std::to_string(particle) + " like " + join_path("pins", number) + ", but " +
                             (always ? "with another motion" : "at the same time"),
                         always ? "pin each particle once" : "let one of them end when the other begins, or earlier"});
  }

  const Scene& scene_;
  std::string key_;
  std::vector<Problem>& problems_;
  std::vector<Pin> pins_;                              // without their particles
  std::map<Index, std::vector<std::size_t>> pins_of_;  // numbers of the pins of a particle
};

}  // namespace

std::vector<Pin> resolve_pins(const Scene& scene, const BodyScene& body, const BuiltBody& placed, std::vector<Problem>& problems) {
  const std::string key = join_path("bodies", body.name) + ".pins";
  PinComparison comparison(scene, key, problems);
  std::set<Index> at_rest;
  std::vector<Pin> resolved;
  for (std::size_t p = 0; p < body.pins.size(); ++p) {
    const PinScene& text = body.pins[p];
    Pin pin{.particles = select_particles(text.where, body, placed, {scene.file.string(), join_path(key, p)}, problems),
            .origin = body.place.position,
            .motion = text.motion,
            .obstacle = number_of_obstacle(scene, text.follow),
            .from = text.from,
            .until = text.until,
            .name = text.name.empty() ? body.name + "." + entry_key("pins", p) : text.name};
    comparison.add(pin);
    if (rests_for_ever(pin)) {
      std::ranges::sort(pin.particles);
      std::erase_if(pin.particles, [&](Index particle) { return !at_rest.insert(particle).second; });
      if (pin.particles.empty()) continue;
    }
    resolved.push_back(std::move(pin));
  }
  return resolved;
}

}  // namespace sprung
