#include "scene/reading/material_rules.h"

#include "scene/json/nearest_name.h"
#include "scene/materials/materials.h"

#include <algorithm>
#include <cmath>

namespace sprung {
namespace {

// From a spider's thread to a chimney [m]. What is scaled by them stays far within the numbers that the other keys may have.
constexpr Range kDiameters{.lower = 1e-6, .upper = 10.0};

// Of Young's modulus, which is that of tetrahedra, to the structural modulus of a solid's material (material_table.cpp).
constexpr double kYoungByStructural = 17.0 / 10.0;

const std::vector<MaterialKind> kAllKinds{MaterialKind::cloth, MaterialKind::rope, MaterialKind::solid};

/// A shape with its article, and the kinds of materials that it may have.
struct ShapeMaterials {
  std::string shape;
  std::vector<MaterialKind> kinds;
};

ShapeMaterials materials_of(const std::optional<BodyShapeScene>& shape) {
  if (!shape) return {"a body", kAllKinds};
  struct Visitor {
    ShapeMaterials operator()(const RopeShape& /*rope*/) const { return {"a rope", {MaterialKind::rope}}; }
    ShapeMaterials operator()(const ClothShape& /*cloth*/) const { return {"a cloth", {MaterialKind::cloth}}; }
    ShapeMaterials operator()(const SolidShape& /*solid*/) const { return {"a solid", {MaterialKind::solid}}; }
    ShapeMaterials operator()(const LatticeFile& /*lattice*/) const { return {"a lattice", {MaterialKind::solid}}; }
    ShapeMaterials operator()(const TetrahedraFile& /*tetrahedra*/) const { return {"tetrahedra", {MaterialKind::solid}}; }
    // With faces a mesh is a cloth, otherwise a rope. The builder compares it with the file.
    ShapeMaterials operator()(const MeshFile& /*mesh*/) const { return {"a mesh", {MaterialKind::cloth, MaterialKind::rope}}; }
  };
  return std::visit(Visitor{}, *shape);
}

/// The material that the body names; null after a report.
const Material* find_preset(Json& json, const JsonLocation& location, const ShapeMaterials& allowed) {
  const std::vector<std::string> names = material_names(allowed.kinds);
  const std::string rule = "must be a material for " + allowed.shape + ": " + joined(names);
  if (!json.is_string()) {
    location.report(json, rule);
    return nullptr;
  }
  const auto& name = json.get_ref<const std::string&>();
  const Material* material = find_material(name);
  if (material == nullptr) {
    location.report(json, rule, did_you_mean(name, names));
  } else if (std::ranges::find(allowed.kinds, material->kind) == allowed.kinds.end()) {
    location.report(json, rule, name + " is for a " + std::string(material_kind_name(material->kind)));
    return nullptr;
  }
  return material;
}

bool has_any(const Json& object, std::initializer_list<const char*> keys) {
  return std::ranges::any_of(keys, [&](const char* key) { return object.contains(key); });
}

/// Writes the value unless the object has one of the keys.
void fill(Json& object, std::initializer_list<const char*> keys, const char* key, const Json& value) {
  if (!has_any(object, keys)) object[key] = value;
}

/// Whether the body has an object for a kind of springs.
bool gives_springs(const Json& body, const std::string& kind) {
  if (!body.contains("springs") || !body["springs"].is_object()) return false;
  return body["springs"].contains(kind) && body["springs"][kind].is_object();
}

/// The object of a kind of springs; null if the user wrote something else there.
Json* springs_of_kind(Json& body, const std::string& kind) {
  if (!body.contains("springs")) body["springs"] = Json::object();
  Json& springs = body["springs"];
  if (!springs.is_object()) return nullptr;
  if (!springs.contains(kind)) springs[kind] = Json::object();
  return springs[kind].is_object() ? &springs[kind] : nullptr;
}

/// Whether the object has this number: that of a preset, also where a resolved scene repeats it.
bool is_value(const Json& object, const char* key, double value) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number() && found->get<double>() == value;
}

/// Whether springs of the body may break.
bool may_tear(const Json& body) {
  if (!body.contains("springs") || !body["springs"].is_object()) return false;
  const auto breaks = [](const Json& springs) { return springs.is_object() && springs.contains("break"); };
  return std::ranges::any_of(body["springs"], [&](const Json& spring) {
    if (breaks(spring)) return true;
    const auto groups = spring.find("groups");  // the end of what is no object
    return groups != spring.end() && groups->is_object() && std::ranges::any_of(*groups, breaks);
  });
}

/// Fills `springs.KIND.KEY`. A material gives a stiffness to angles. Bend springs (model spring) get none from it.
void fill_spring(const std::string& key, double value, Json& body) {
  const std::size_t dot = key.find('.', std::string("springs.").size());
  const std::string kind = key.substr(std::string("springs.").size(), dot - std::string("springs.").size());
  const bool bends = kind == "bend";
  Json* const spring = springs_of_kind(body, kind);
  if (spring == nullptr) return;
  if (bends) fill(*spring, {"model"}, "model", "angle");
  if (!key.ends_with(".modulus")) {
    fill(*spring, {"damping", "damping_ratio", "damping_time"}, key.c_str() + dot + 1, value);
  } else if (!bends || (*spring)["model"] != "spring") {
    fill(*spring, {"modulus", "stiffness"}, "modulus", value);
  }
}

void fill_value(const std::string& key, double value, Json& body) {
  if (key.starts_with("springs.")) {
    fill_spring(key, value, body);
  } else if (key == "density") {
    fill(body, {"mass", "particle_mass", "density"}, "density", value);
  } else if (key == "static_friction") {
    fill(body, {"friction", "static_friction"}, "static_friction", value);  // it follows a friction that is given
  } else if (key == "friction") {
    const Json at_rest = body.value("static_friction", Json());
    fill(body, {"friction"}, "friction", at_rest.is_number() ? std::min(value, at_rest.get<double>()) : value);
  } else {
    fill(body, {key.c_str()}, key.c_str(), value);
  }
}

void preserve_volume(Json& body) {
  if (!body.contains("volume")) body["volume"] = Json::object();
  if (body["volume"].is_object()) fill(body["volume"], {"preserve"}, "preserve", true);
}

/// Springs for which the user gave some keys, but neither a stiffness nor the preset has one.
void complete_springs(Json& body) {
  for (const char* kind : kSpringKindNames) {
    if (gives_springs(body, kind)) fill(body["springs"][kind], {"modulus", "stiffness"}, "modulus", 0.0);
  }
}

void check_bend_springs(const Material& preset, const JsonLocation& location, const Json& body) {
  if (!gives_springs(body, "bend") || has_any(body["springs"]["bend"], {"modulus", "stiffness"})) return;
  location.at("springs").at("bend").report_key("must have one of stiffness, modulus",
                                               preset.name + " has none for bend springs: add one of them, or remove bend");
}

bool gives_stiffness(const Json& body) {
  return gives_springs(body, "structural") && has_any(body["springs"]["structural"], {"modulus", "stiffness"});
}

}  // namespace

void read_preset(Fields& fields, const std::optional<BodyShapeScene>& shape, BodyScene& body) {
  const bool has_material = fields.has("material");
  const auto diameter = fields.optional("diameter", number(kDiameters));
  Json& json = fields.json();
  if (!has_material) {
    if (fields.has("diameter")) {
      fields.location()
          .at("diameter")
          .report(json["diameter"], "needs a rope's material", "add one of " + joined(material_names({MaterialKind::rope})));
    }
    return;
  }
  const Material* const preset = find_preset(json["material"], fields.location().at("material"), materials_of(shape));
  if (preset == nullptr) {
    fill(json, {"mass", "particle_mass", "density"}, "density", 1.0);
    return complete_springs(json);
  }
  const bool is_rope = preset->kind == MaterialKind::rope;
  if (fields.has("diameter") && !is_rope) {
    fields.location()
        .at("diameter")
        .report(json["diameter"], "needs a rope's material", preset->name + " has no diameter: remove it");
  }
  const double scale = is_rope && diameter ? *diameter / preset->find("diameter")->value : 1.0;
  const bool tetrahedra = shape && std::holds_alternative<TetrahedraFile>(*shape);
  if (preset->stretch_limited && !gives_stiffness(json)) body.preset_limits_stretch = true;
  body.preset = preset->name;
  const bool tears = preset->kind != MaterialKind::solid && may_tear(json);
  for (const MaterialValue& value : preset->values) {
    if (tetrahedra && value.key.starts_with("springs.shear")) continue;
    const double factor =
        tetrahedra && value.key == "springs.structural.modulus" ? kYoungByStructural : std::pow(scale, value.power);
    const bool stretches = value.key == "springs.structural.damping_time" || value.key == "springs.shear.damping_time";
    fill_value(value.key, tears && stretches ? kTearingDampingTime : value.value * factor, json);
  }
  if (is_rope) body.diameter = diameter.value_or(preset->find("diameter")->value);
  body.preset_mass = !has_any(json, {"mass", "particle_mass"}) &&
                     is_value(json, "density", preset->find("density")->value * std::pow(scale, preset->find("density")->power));
  if (preset->preserves_volume) preserve_volume(json);
  const bool lattice = shape && std::holds_alternative<LatticeFile>(*shape);
  if (!tetrahedra && !lattice) check_bend_springs(*preset, fields.location(), json);
  complete_springs(json);
}

}  // namespace sprung
