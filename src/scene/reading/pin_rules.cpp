#include "scene/reading/scene_rules.h"

namespace sprung {
namespace {

PinScene read_pin(Fields& fields, const NamedParts& parts) {
  PinScene pin;
  if (const auto name = fields.optional("name", text())) {
    pin.name = *name;
    if (!is_name(*name)) {
      fields.location().at("name").report(Json(*name), "may have at most 200 letters, digits, _ and -", "choose another name");
    }
  }
  if (auto where = read_selector(fields, parts)) pin.where = std::move(*where);
  const auto follow = fields.optional("follow", text());
  pin.follow = follow.value_or("");
  if (!fields.has("follow")) {
    pin.motion = fields.value("motion", motion_rule(), Json::object()).value_or(Motion{});
  } else if (fields.has("motion")) {
    (void)fields.optional("motion", motion_rule());
    fields.one_of({"follow", "motion"});
  }
  read_times(fields, pin.from, pin.until);
  return pin;
}

PointMassScene read_point_mass(Fields& fields, const NamedParts& parts) {
  PointMassScene point_mass;
  if (auto where = read_selector(fields, parts)) point_mass.where = std::move(*where);
  point_mass.mass = fields.required("mass", number(kPositive)).value_or(0.0);
  return point_mass;
}

}  // namespace

Rule<PinScene> pin_rule(const NamedParts& parts) {
  return object_of<PinScene>([parts](Fields& fields) { return read_pin(fields, parts); });
}

Rule<PointMassScene> point_mass_rule(const NamedParts& parts) {
  return object_of<PointMassScene>([parts](Fields& fields) { return read_point_mass(fields, parts); });
}

}  // namespace sprung
