#include "base/format.h"
#include "scene/reading/scene_rules.h"

#include <cmath>
#include <limits>

namespace sprung {
namespace {

VerletSettings read_verlet(Fields& fields) {
  VerletSettings verlet;
  fields.one_of({"damping", "damping_rate"}, true);
  verlet.damping = fields.optional("damping", number(kFraction)).value_or(0.0);
  verlet.damping_rate = fields.optional("damping_rate", number(kNotNegative)).value_or(0.0);
  verlet.start_at_rest = fields.value("start_at_rest", boolean(), false).value_or(false);
  return verlet;
}

IntegratorSettings read_integrator(Fields& fields) {
  const auto kind =
      fields.kind("type", {"explicit_euler", "symplectic_euler", "verlet", "velocity_verlet", "rk4", "implicit_euler"});
  fields.set_remedy({"step"}, "it belongs to the top level of the scene: move it there");
  if (!kind) {
    fields.accept_keys_of_all_kinds({"damping", "damping_rate", "start_at_rest"});
    return {};
  }
  if (kind != 2) {
    fields.set_remedy({"damping", "damping_rate", "start_at_rest"},
                      "only the integrator verlet has it: remove it, or use the damping of springs or the drag of air");
  }
  if (kind == 0) return ExplicitEulerSettings{};
  if (kind == 1) return SymplecticEulerSettings{};
  if (kind == 2) return read_verlet(fields);
  if (kind == 3) return VelocityVerletSettings{};
  if (kind == 4) return RungeKutta4Settings{};
  return ImplicitEulerSettings{};
}

std::vector<SpringKind> read_kinds(Fields& fields) {
  const auto kinds = fields.value("kinds", list_of(word_of({"structural", "shear", "bend"}), 1), Json::array({"structural"}));
  if (!kinds) return {};
  std::vector<SpringKind> result;
  for (const std::size_t kind : *kinds) result.push_back(static_cast<SpringKind>(kind));
  return result;
}

std::vector<std::string> bodies_limited_by_materials(const Scene& scene) {
  std::vector<std::string> names;
  for (const BodyScene& body : scene.bodies) {
    if (body.preset_limits_stretch) names.push_back(body.name);
  }
  return names;
}

/// The settings of the limit, and the names of the bodies to which it applies.
struct StretchLimitScene {
  StretchLimitSettings settings;
  std::vector<std::string> bodies;
};

StretchLimitScene read_stretch_limit(Fields& fields, const Json& bodies) {
  StretchLimitScene read;
  StretchLimitSettings& limit = read.settings;
  limit.max_stretch = fields.value("max_stretch", number(kNotNegative), limit.max_stretch).value_or(0.0);
  limit.max_compression = fields.value("max_compression", number(kFraction), limit.max_compression).value_or(0.0);
  limit.kinds = read_kinds(fields);
  limit.iterations = fields.value("iterations", integer(1, 1'000'000), limit.iterations).value_or(1);
  const auto solver = fields.value("solver", word_of({"gauss_seidel", "newton", "auto"}), "auto");
  limit.solver = static_cast<StretchLimitSettings::Solver>(solver.value_or(0));
  limit.tolerance = fields.value("tolerance", number(kNotNegative), default_tolerance(limit.max_stretch)).value_or(0.0);
  limit.tethers = fields.value("tethers", boolean(), limit.tethers).value_or(false);
  read.bodies = fields.optional("bodies", list_of(name_of(bodies, "a body"), 1)).value_or(std::vector<std::string>{});
  return read;
}

ContactSettings read_contact(Fields& fields) {
  ContactSettings contact;
  const auto start = fields.value("start", word_of({"refuse", "push_out"}), "refuse");
  contact.start = start == 1 ? ContactSettings::Start::push_out : ContactSettings::Start::refuse;
  fields.set_remedy({"stiffness", "damping"}, "only \"response\": \"penalty\" has it: remove it");
  if (fields.kind("response", {"projection", "penalty"}, "projection") != 1) return contact;
  contact.response = ContactSettings::Response::penalty;
  contact.stiffness = fields.required("stiffness", number(kPositive)).value_or(0.0);
  contact.damping = fields.required("damping", number(kNotNegative)).value_or(0.0);
  return contact;
}

struct OutputKeys {
  bool forces = false;
  bool record = true;
};

OutputKeys read_output(Fields& fields) {
  return {.forces = fields.value("forces", boolean(), false).value_or(false),
          .record = fields.value("record", boolean(), true).value_or(true)};
}

Rule<Vector3> gravity_rule() {
  return [](Json& json, const JsonLocation& location) -> std::optional<Vector3> {
    if (!json.is_number()) return vector3()(json, location);
    const double size = std::abs(json.get<double>());
    const std::string text = format_number(size > 0.0 ? -size : 0.0);
    location.report(json, "must be a list of 3 entries, written in [ ]", "Y is up: did you mean [0, " + text + ", 0]?");
    return std::nullopt;
  };
}

/// An object, or false for vacuum.
Rule<bool> air_rule(Scene& scene) {
  return [&scene](Json& json, const JsonLocation& location) -> std::optional<bool> {
    if (json == false) {
      scene.air_of_materials = false;
      return true;
    }
    if (json.is_object()) {
      return object_of<bool>([&scene](Fields& keys) {
        read_air(keys, scene);
        return true;
      })(json, location);
    }
    location.report(json, "must be an object, written in { }, or false for vacuum");
    return std::nullopt;
  };
}

}  // namespace

void read_settings(Fields& fields, Scene& scene) {
  SimulatorSettings& settings = scene.settings;
  settings.gravity = fields.value("gravity", gravity_rule(), {0, -9.81, 0}).value_or(Vector3::Zero());
  (void)fields.value("air", air_rule(scene), Json::object());
  const auto integrator = fields.value("integrator", object_of<IntegratorSettings>(read_integrator), {{"type", "verlet"}});
  settings.integrator = integrator.value_or(IntegratorSettings{});
  const Json bodies = fields.json().value("bodies", Json());
  const auto read_limit = object_of<StretchLimitScene>([&](Fields& keys) { return read_stretch_limit(keys, bodies); });
  const std::vector<std::string> limited = bodies_limited_by_materials(scene);
  const bool gives_limit = fields.has("stretch_limit");
  const auto limit = limited.empty() ? fields.optional("stretch_limit", read_limit)
                                     : fields.value("stretch_limit", read_limit, {{"bodies", limited}});
  if (limit) {
    settings.stretch_limit = limit->settings;
    settings.stretch_limit->of_materials = !gives_limit;
    scene.limited_bodies = limit->bodies;
  }
  const auto contact = fields.value("contact", object_of<ContactSettings>(read_contact), Json::object());
  settings.contact = contact.value_or(ContactSettings{});
  const auto stability = fields.value("stability", word_of({"refuse", "warn"}), "refuse");
  settings.stability = stability == 1 ? StabilityCheck::warn : StabilityCheck::refuse;
  settings.sleep = fields.value("sleep", boolean(), settings.sleep).value_or(settings.sleep);
  settings.perturb = fields.value("perturb", boolean(), settings.perturb).value_or(settings.perturb);
  settings.seed = static_cast<std::uint64_t>(fields.value("seed", integer(0, std::numeric_limits<Index>::max()), 0).value_or(0));
  scene.strength_scatter = fields.value("strength_scatter", number(kFraction), scene.strength_scatter).value_or(0.0);
  const auto output = fields.value("output", object_of<OutputKeys>(read_output), Json::object()).value_or(OutputKeys{});
  settings.record_forces = output.forces;
  scene.write_record = output.record;
}

}  // namespace sprung
