#include "simulation/settings/settings_check.h"

#include "base/format.h"
#include "base/grouped_warnings.h"
#include "dynamics/contact/contact_materials.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sprung {
namespace {

std::string names_of(const std::vector<SpringKind>& kinds) {
  std::string names;
  for (const SpringKind kind : kinds) {
    names += (names.empty() ? "\"" : ", \"") + std::string(kSpringKindNames[static_cast<std::size_t>(kind)]) + "\"";
  }
  return "[" + names + "]";
}

class Finder {
 public:
  Finder(const SimulatorSettings& settings, const SpringNetwork& network, const std::vector<Obstacle>& obstacles)
      : settings_(settings), network_(network), obstacles_(obstacles) {}

  std::vector<std::string> find() {
    if (settings_.stretch_limit) check_limit(*settings_.stretch_limit);
    check_air();
    if (settings_.contact.response == ContactSettings::Response::penalty) check_penalty();
    check_friction();
    check_attachments();
    return std::move(warnings_);
  }

 private:
  void check_limit(const StretchLimitSettings& limit) {
    std::vector<SpringKind> present;
    for (const SpringKind kind : {SpringKind::structural, SpringKind::shear, SpringKind::bend}) {
      if (std::ranges::find(network_.springs.kind, kind) != network_.springs.kind.end()) present.push_back(kind);
    }
    std::vector<SpringKind> absent = limit.kinds;
    std::erase_if(absent, [&](SpringKind kind) { return std::ranges::find(present, kind) != present.end(); });
    if (!present.empty() && !absent.empty()) {
      warnings_.push_back("stretch_limit.kinds = " + names_of(limit.kinds) + " limits no spring" +
                          (absent.size() < limit.kinds.size() ? " of the kinds " + names_of(absent) : "") +
                          ": the network has only springs of the kinds " + names_of(present) + ". Name kinds of these only.");
    }
    check_laws(limit);
    const double largest = std::pow(1.0 + limit.max_stretch, 3);
    for (const Body& body : network_.bodies) {
      if (!body.stretch_limited || body.volume_factor <= largest) continue;
      warnings_.push_back("body \"" + body.name + "\": volume.factor = " + format_number(body.volume_factor, 4) +
                          " needs springs that stretch by " + format_lower_bound(100.0 * (std::cbrt(body.volume_factor) - 1.0), 3) +
                          " %, but stretch_limit.max_stretch is " + format_number(100.0 * limit.max_stretch, 3) +
                          " %. Use a smaller factor, or a larger max_stretch.");
    }
    if (limit.tethers && network_.pins.empty()) {
      warnings_.emplace_back(
          "stretch_limit.tethers has no effect without pins: tethers hold particles to pins. Remove it, or add pins.");
    }
  }

  /// Springs of limited bodies that the limit leaves out or works against.
  void check_laws(const StretchLimitSettings& limit) {
    const Springs& springs = network_.springs;
    std::vector<std::string> failing;  // bodies
    std::vector<SpringKind> kept;      // kinds of which no spring fails
    GroupedWarnings of_bodies("body", "bodies");
    bool limits_others = false;
    std::array<bool, 3> is_present{};
    std::array<bool, 3> kind_fails{};
    for (const Body& body : network_.bodies) {
      if (!body.stretch_limited) continue;
      bool fails = false;
      bool pushes = false;
      for (Index s = body.first_spring; s < body.first_spring + body.spring_count; ++s) {
        const auto kind = static_cast<std::size_t>(springs.kind[s]);
        is_present[kind] = true;
        if (std::ranges::find(limit.kinds, springs.kind[s]) == limit.kinds.end()) continue;
        const SpringLaw law = springs.law(s);
        kind_fails[kind] = kind_fails[kind] || law.yields() || law.breaks();
        fails = fails || law.yields() || law.breaks();
        pushes = pushes || (law.tension_only && limit.max_compression < 1.0);
      }
      if (fails) failing.push_back(body.name);
      limits_others = limits_others || !fails;
      if (pushes) {
        of_bodies.add(body.name,
                      "stretch_limit.max_compression pushes its tension_only springs, which then cannot get slack. "
                      "Remove one of them.");
      }
    }
    add(of_bodies);
    if (failing.empty() || limit.of_materials) return;
    for (const SpringKind kind : limit.kinds) {
      if (is_present[static_cast<std::size_t>(kind)] && !kind_fails[static_cast<std::size_t>(kind)]) kept.push_back(kind);
    }
    std::string remedy = "Remove stretch_limit";
    if (!kept.empty()) remedy += ", or set stretch_limit.kinds to " + names_of(kept);
    if (limits_others) remedy += ", or list only other bodies in stretch_limit.bodies";
    warnings_.push_back(names_text("body", "bodies", failing) +
                        ": the stretch limit leaves out springs that yield or break, as their load decides when they do so. " +
                        remedy + ".");
  }

  void check_air() {
    const SurfaceDrag& surface = settings_.air_surface;
    if (surface.is_zero() && surface.quadratic) {
      warnings_.emplace_back("air.surface has no effect: its coefficients are 0. Give normal or tangential, or remove quadratic.");
    }
    if (!surface.is_zero() && !has_triangles(network_)) {
      warnings_.emplace_back("air.surface has no effect: it acts on faces, and no body has any. Use air.drag.");
    }
    check_wind();
  }

  void check_wind() {
    if (settings_.has_air()) return;
    const std::vector<WindKeyframe>& mean = settings_.wind.keyframes();
    const bool blows = std::ranges::any_of(mean, [](const WindKeyframe& key) { return !key.velocity.isZero(0.0); });
    GroupedWarnings of_bodies("body", "bodies");
    for (const Body& body : network_.bodies) {
      if (!body.drag.is_zero()) continue;
      if (blows) of_bodies.add(body.name, std::string("air.wind") + kNoDrag);
      if (settings_.wind.gusts()) of_bodies.add(body.name, std::string("air.gusts") + kNoDrag);
    }
    add(of_bodies);
  }

  void check_penalty() {
    check_gaps();
    check_bounces();
    const auto collides = [](const Body& body) { return body.contact.others; };
    if (std::ranges::count_if(network_.bodies, collides) > 1) {
      warnings_.emplace_back(
          "contact.response \"penalty\" acts between bodies and obstacles only: bodies pass through each other. Use "
          "\"projection\", or "
          "set body_contact of the bodies to false.");
    }
  }

  void check_gaps() {
    GroupedWarnings of_bodies("body", "bodies");
    for (const Body& body : network_.bodies) {
      std::vector<std::string> names;
      for (const Obstacle& obstacle : obstacles_) {
        if (combine(body.material, obstacle.material).thickness == 0.0) names.push_back(obstacle.name);
      }
      if (names.empty()) continue;
      of_bodies.add(body.name, "the penalty of contact has no effect before " + names_text("obstacle", "obstacles", names) +
                                   ": it acts within the thickness, which is 0. Give the body or the obstacle a thickness.");
    }
    add(of_bodies);
  }

  // A penalty bounces by its damping, and has one coefficient of friction.
  void check_bounces() {
    for (const auto& [one, several, materials] : things()) {
      GroupedWarnings of_things(one, several);
      for (const auto& [name, material] : materials) {
        if (material->restitution > 0.0) {
          of_things.add(
              name, "restitution has no effect with penalty contact. Choose the bounce by contact.damping, or use \"projection\".");
        }
        if (material->static_friction > material->friction) {
          of_things.add(name, "static_friction has no effect with penalty contact, which uses friction. Use \"projection\".");
        }
      }
      add(of_things);
    }
  }

  // The friction of a pair is the geometric mean, so it is 0 if one side has none.
  void check_friction() {
    GroupedWarnings of_bodies("body", "bodies");
    for (const Body& body : network_.bodies) {
      if (has_friction(body.material) && may_touch(body) && !rubs(body)) of_bodies.add(body.name, kFrictionOfOneSide);
    }
    add(of_bodies);
    GroupedWarnings of_obstacles("obstacle", "obstacles");
    const bool bodies_rub = std::ranges::any_of(network_.bodies, [](const Body& body) { return has_friction(body.material); });
    for (const Obstacle& obstacle : obstacles_) {
      if (has_friction(obstacle.material) && !bodies_rub) of_obstacles.add(obstacle.name, kFrictionOfOneSide);
    }
    add(of_obstacles);
  }

  // Contact wins over attachments.
  void check_attachments() {
    if (!acts_between_bodies()) return;
    for (const Attachment& attachment : network_.attachments) {
      if (!attachment.rest_length) continue;
      const Body& body = network_.body_of(attachment.particles.front());
      std::string other;
      double gap = 0.0;
      if (const auto* end = std::get_if<ObstacleEnd>(&attachment.second)) {
        if (end->obstacle < 0 || static_cast<std::size_t>(end->obstacle) >= obstacles_.size()) continue;
        const Obstacle& obstacle = obstacles_[static_cast<std::size_t>(end->obstacle)];
        other = "obstacle \"" + obstacle.name + "\"";
        gap = combine(body.material, obstacle.material).thickness;
      } else {
        const Body& second = second_body(attachment);
        if (!may_meet(body, second)) continue;
        other = "body \"" + second.name + "\"";
        gap = 0.5 * (body.material.thickness + second.material.thickness);
      }
      if (*attachment.rest_length >= gap) continue;
      warnings_.push_back(attachment.name + ": rest_length = " + format_number(*attachment.rest_length, 6) +
                          " is below the gap of " + format_number(gap, 6) + " m that contact keeps between body \"" + body.name +
                          "\" and " + other + ", so that they work against each other. Use at least " + format_lower_bound(gap) +
                          ", leave it out, or reduce the thickness.");
    }
  }

  /// Requires a second end that is no obstacle.
  [[nodiscard]] const Body& second_body(const Attachment& attachment) const {
    if (const auto* end = std::get_if<SurfaceEnd>(&attachment.second)) return network_.bodies[static_cast<std::size_t>(end->body)];
    return network_.body_of(std::get<ParticleEnds>(attachment.second).particles.front());
  }

  static constexpr const char* kNoDrag =
      " has no effect here, because there is no drag. Give air.drag or air.surface, or give the body a material and leave out "
      "both.";
  static constexpr const char* kFrictionOfOneSide =
      "friction has no effect: nothing that it can touch has friction, and a pair has the geometric mean of both. "
      "Give the other side friction too.";

  static bool has_friction(const ContactMaterial& material) { return material.static_friction > 0.0; }

  [[nodiscard]] bool acts_between_bodies() const { return settings_.contact.response == ContactSettings::Response::projection; }

  [[nodiscard]] bool may_meet(const Body& body, const Body& other) const {
    return acts_between_bodies() && (&body == &other ? body.contact.self : body.contact.others && other.contact.others);
  }

  [[nodiscard]] bool may_touch(const Body& body) const {
    return !obstacles_.empty() || std::ranges::any_of(network_.bodies, [&](const Body& other) { return may_meet(body, other); });
  }

  /// Requires a body with friction.
  [[nodiscard]] bool rubs(const Body& body) const {
    return std::ranges::any_of(obstacles_, [](const Obstacle& obstacle) { return has_friction(obstacle.material); }) ||
           std::ranges::any_of(network_.bodies,
                               [&](const Body& other) { return may_meet(body, other) && has_friction(other.material); });
  }

  struct Things {
    const char* one;
    const char* several;
    std::vector<std::pair<std::string, const ContactMaterial*>> materials;
  };

  [[nodiscard]] std::vector<Things> things() const {
    std::vector<Things> all{{"body", "bodies", {}}, {"obstacle", "obstacles", {}}};
    for (const Body& body : network_.bodies) all[0].materials.emplace_back(body.name, &body.material);
    for (const Obstacle& obstacle : obstacles_) all[1].materials.emplace_back(obstacle.name, &obstacle.material);
    return all;
  }

  void add(const GroupedWarnings& grouped) {
    for (std::string& line : grouped.lines()) warnings_.push_back(std::move(line));
  }

  const SimulatorSettings& settings_;
  const SpringNetwork& network_;
  const std::vector<Obstacle>& obstacles_;
  std::vector<std::string> warnings_;
};

}  // namespace

std::vector<std::string> unused_settings(const SimulatorSettings& settings, const SpringNetwork& network,
                                         const std::vector<Obstacle>& obstacles) {
  return Finder(settings, network, obstacles).find();
}

}  // namespace sprung
