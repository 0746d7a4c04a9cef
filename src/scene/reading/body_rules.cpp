#include "network/bodies/corners.h"
#include "scene/reading/material_rules.h"
#include "scene/reading/scene_rules.h"

#include <optional>
#include <utility>
#include <vector>

namespace sprung {
namespace {

constexpr Index kMaxLatticeCells = 1024;  // along the longest side

Rule<Index> particle_count() { return integer(2, kMaxBodyParticles); }

RopeShape read_rope(Fields& fields) {
  RopeShape rope;
  const auto points = fields.optional("points", list_of(vector3(), 2));
  if (fields.one_of({"from", "points"}) == "points") {
    rope.points = points.value_or(std::vector<Vector3>{});
    rope.particles = fields.optional("particles", particle_count());
  } else {
    const auto from = fields.optional("from", vector3());
    const auto to = fields.required("to", vector3());
    rope.points = {from.value_or(Vector3::Zero()), to.value_or(Vector3::Zero())};
    rope.particles = fields.required("particles", particle_count());
  }
  rope.length = fields.optional("length", number(kPositive));
  return rope;
}

template <std::size_t n>
std::array<Index, n> read_resolution(Fields& fields) {
  const auto resolution = fields.required("resolution", array_of<n>(particle_count()));
  if (!resolution) return {};
  double particles = 1.0;
  for (const Index side : *resolution) particles *= side;
  if (particles > kMaxBodyParticles) {
    fields.location()
        .at("resolution")
        .report(fields.json()["resolution"], "must make at most " + std::to_string(kMaxBodyParticles) + " particles in all");
  }
  return *resolution;
}

ClothShape read_cloth(Fields& fields) {
  fields.set_remedy({"width", "height", "length"}, "did you mean \"size\": [X, Y]?");
  const auto size = fields.required("size", array_of<2>(number(kPositive)));
  return {.size = size.value_or(std::array<double, 2>{}), .resolution = read_resolution<2>(fields)};
}

SolidShape read_solid(Fields& fields) {
  fields.set_remedy({"width", "height", "depth", "length"}, "did you mean \"size\": [X, Y, Z]?");
  const auto size = fields.required("size", vector3(kPositive));
  return {.size = size.value_or(Vector3::Zero()), .resolution = read_resolution<3>(fields)};
}

LatticeFile read_lattice(Fields& fields) {
  LatticeFile lattice{.file = fields.required("file", text()).value_or("")};
  const auto cells = fields.optional("cells", integer(1, kMaxLatticeCells));
  const auto cell_size = fields.optional("cell_size", number(kPositive));
  const auto key = fields.one_of({"cells", "cell_size"});
  if (key == "cells") lattice.cells = cells.value_or(1);
  if (key == "cell_size") lattice.cell_size = cell_size.value_or(1.0);
  return lattice;
}

/// Shapes that other programs have, and those of obstacles.
WordRemedies remedies_of_other_shapes() {
  WordRemedies remedies{{"half_space", "only an obstacle may be one: move it to obstacles"},
                        {"plane", "a sheet is a cloth; an unbounded floor is an obstacle of type \"half_space\""},
                        {"sequence", "only an obstacle may be one: move it to obstacles"}};
  for (const char* box : {"box", "cube"})
    remedies[box] = "an elastic box is a \"solid\"; a rigid one is an obstacle of type \"box\"";
  for (const char* round : {"sphere", "ball", "capsule", "cylinder", "cone", "ellipsoid"}) {
    remedies[round] =
        "use a \"lattice\" of a closed mesh for an elastic body, a \"mesh\" with pressure for a balloon, "
        "both of a file such as meshes/ball.obj; a rigid one is an obstacle";
  }
  return remedies;
}

std::optional<BodyShapeScene> read_shape(Fields& fields) {
  const auto kind = fields.kind("type", {"rope", "cloth", "solid", "mesh", "lattice", "tetrahedra"}, remedies_of_other_shapes());
  if (!kind) {
    fields.accept_keys_of_all_kinds({"from", "to", "points", "particles", "length", "size", "resolution", "file", "weld", "cells",
                                     "cell_size", "radius", "radii", "height", "normal", "offset"});
    return std::nullopt;
  }
  switch (*kind) {
    case 0:
      return read_rope(fields);
    case 1:
      return read_cloth(fields);
    case 2:
      return read_solid(fields);
    case 4:
      return read_lattice(fields);
    case 5:
      return TetrahedraFile{fields.required("file", text()).value_or("")};
    default:
      return MeshFile{.file = fields.required("file", text()).value_or(""), .weld = fields.optional("weld", number(kNotNegative))};
  }
}

MassScene read_mass(Fields& fields) {
  const auto of_body = fields.optional("mass", number(kPositive));
  const auto of_particles = fields.optional("particle_mass", number(kPositive));
  const auto density = fields.optional("density", number(kPositive));
  const std::string key = fields.one_of({"mass", "particle_mass", "density"}).value_or("");
  if (key == "mass") return {.kind = MassScene::Kind::body, .value = of_body.value_or(0.0)};
  if (key == "particle_mass") return {.kind = MassScene::Kind::particle, .value = of_particles.value_or(0.0)};
  if (key == "density") return {.kind = MassScene::Kind::density, .value = density.value_or(0.0)};
  return {};
}

/// The springs of a body as the file gives them.
struct SpringsScene {
  SpringMaterials materials;
  std::vector<SpringGroupScene> groups;
};

/// Whether the springs have stiffness; true if that is invalid.
bool read_stiffness(Fields& fields, bool required, SpringMaterial& material) {
  const auto stiffness = fields.optional("stiffness", number(kNotNegative));
  const auto modulus = fields.optional("modulus", number(kNotNegative));
  const auto key = fields.one_of({"stiffness", "modulus"}, !required);
  if (!key) return required || material.value > 0.0;
  const bool by_modulus = *key == "modulus";
  material.measure = by_modulus ? SpringMaterial::Measure::modulus : SpringMaterial::Measure::stiffness;
  const std::optional<double> value = by_modulus ? modulus : stiffness;
  material.value = value.value_or(0.0);
  return value != 0.0;
}

bool has_cells(const BodyShapeScene& shape) {
  return std::holds_alternative<SolidShape>(shape) || std::holds_alternative<LatticeFile>(shape) ||
         std::holds_alternative<TetrahedraFile>(shape);
}

/// tension_only, yield and break.
void read_law(Fields& fields, bool has_stiffness, const std::optional<BodyShapeScene>& shape, SpringMaterial& material) {
  const auto report = [&](const char* key, const std::string& rule, const std::string& remedy) {
    fields.location().at(key).report(fields.json()[key], rule, remedy);
  };
  const auto read_strain = [&](const char* key, double& strain) {
    const auto given = fields.optional(key, number(kPositive));
    strain = given.value_or(strain);
    if (given && !has_stiffness) {
      report(key, "needs springs with stiffness",
             "give stiffness or modulus: a stretch limit leaves out springs that yield or break");
    }
    return given.has_value();
  };
  material.tension_only = fields.optional("tension_only", boolean()).value_or(material.tension_only);
  read_strain("yield", material.yield);
  if (read_strain("break", material.break_strain) && shape && has_cells(*shape)) {
    report("break", "needs a rope, a cloth or a mesh: a torn solid would need new faces inside", "remove it");
  }
}

SpringMaterial read_group(Fields& fields, const SpringMaterial& of_kind, const std::optional<BodyShapeScene>& shape) {
  SpringMaterial material = of_kind;
  fields.set_remedy({"damping_ratio"}, "it is one for all springs of the kind: give damping_time to the group");
  const bool has_stiffness = read_stiffness(fields, false, material);
  const auto damping = fields.optional("damping", number(kNotNegative));
  const auto damping_time = fields.optional("damping_time", number(kNotNegative));
  if (const auto key = fields.one_of({"damping", "damping_time"}, true)) {
    material.damping = damping.value_or(0.0);
    material.damping_time = damping_time.value_or(0.0);
    if (of_kind.damping_ratio) {
      fields.location().at(*key).report(fields.json()[*key], "is set by damping_ratio of the kind",
                                        "remove it, or give the kind damping_time");
    }
  }
  read_law(fields, has_stiffness, shape, material);
  return material;
}

void read_groups(Fields& fields, SpringKind kind, const SpringMaterial& material, const std::optional<BodyShapeScene>& shape,
                 SpringsScene& springs) {
  const auto group = object_of<SpringMaterial>([&](Fields& keys) { return read_group(keys, material, shape); });
  const Rule<bool> groups = [&](Json& json, const JsonLocation& location) -> std::optional<bool> {
    if (!check_object(json, location)) return std::nullopt;
    for (const auto& item : json.items()) {
      const auto read = group(item.value(), location.at(item.key()));
      if (read) springs.groups.push_back({.kind = kind, .name = item.key(), .material = *read});
    }
    return true;
  };
  if (!fields.optional("groups", groups) || !shape || std::holds_alternative<MeshFile>(*shape)) return;
  fields.location().at("groups").report_key("needs a mesh: other shapes have no groups", "remove it");
}

SpringMaterial read_spring(Fields& fields, SpringKind kind, const std::optional<BodyShapeScene>& shape, SpringsScene& springs) {
  SpringMaterial material;
  const bool has_stiffness = read_stiffness(fields, true, material);
  if (fields.has("damping_ratio")) {
    (void)fields.optional("damping", number(kNotNegative));
    (void)fields.optional("damping_time", number(kNotNegative));
    fields.one_of({"damping", "damping_ratio", "damping_time"});
    material.damping_ratio = fields.optional("damping_ratio", number(kNotNegative));
    if (!has_stiffness) {
      fields.location()
          .at("damping_ratio")
          .report(fields.json()["damping_ratio"], "needs springs with stiffness", "give damping instead");
    }
  } else if (fields.has("damping_time")) {
    (void)fields.optional("damping", number(kNotNegative));
    fields.one_of({"damping", "damping_time"});
    material.damping_time = fields.optional("damping_time", number(kNotNegative)).value_or(0.0);
  } else {
    material.damping = fields.value("damping", number(kNotNegative), 0.0).value_or(0.0);
  }
  read_law(fields, has_stiffness, shape, material);
  read_groups(fields, kind, material, shape, springs);
  return material;
}

/// Springs of a kind that tetrahedra lack.
void refuse_other_springs(Fields& fields, const std::optional<BodyShapeScene>& shape) {
  const auto refuse = [&](const char* kind, const std::string& rule) {
    if (fields.has(kind)) fields.location().at(kind).report_key(rule, "remove it");
  };
  if (shape && std::holds_alternative<LatticeFile>(*shape)) {
    refuse("bend", "is not for a lattice, which has structural and shear springs along its cells");
  }
  if (!shape || !std::holds_alternative<TetrahedraFile>(*shape)) return;
  for (const char* kind : {"shear", "bend"}) {
    refuse(kind, "is not for tetrahedra, which have structural springs along their edges and no others");
  }
}

/// Angles are no springs, and those of meshes have no stiffness of their own.
void check_angles(const Json& bend, const JsonLocation& location, bool is_mesh) {
  for (const char* key : {"tension_only", "yield", "break"}) {
    if (bend.contains(key)) location.at(key).report_key("needs the model spring: an angle has no length", "remove it");
  }
  if (is_mesh && bend.contains("stiffness")) {
    location.at("stiffness")
        .report_key("is not for the angles of a mesh, whose stiffness follows from its triangles", "give modulus, D in N m");
  }
  const auto groups = bend.find("groups");
  if (groups == bend.end() || !groups->is_object()) return;
  for (const auto& group : groups->items()) {
    if (group.value().is_object()) check_angles(group.value(), location.at("groups").at(group.key()), is_mesh);
  }
}

SpringsScene read_springs(Fields& fields, const std::optional<BodyShapeScene>& shape) {
  SpringsScene springs;
  const auto spring = [&](SpringKind kind) {
    return object_of<SpringMaterial>([&springs, &shape, kind](Fields& keys) { return read_spring(keys, kind, shape, springs); });
  };
  SpringMaterials& materials = springs.materials;
  materials.structural = fields.optional("structural", spring(SpringKind::structural));
  materials.shear = fields.optional("shear", spring(SpringKind::shear));
  const auto bend = object_of<SpringMaterial>([&](Fields& keys) {
    const auto model = keys.value("model", word_of({"spring", "angle"}), "spring");
    materials.bend_model = model == 1 ? SpringMaterials::BendModel::angle : SpringMaterials::BendModel::spring;
    const SpringMaterial material = read_spring(keys, SpringKind::bend, shape, springs);
    if (model == 1) check_angles(keys.json(), keys.location(), shape && std::holds_alternative<MeshFile>(*shape));
    return material;
  });
  materials.bend = fields.optional("bend", bend);
  refuse_other_springs(fields, shape);
  return springs;
}

BodyContact read_body_contact(Fields& fields) {
  const BodyContact fallback;
  return {.self = fields.value("self_contact", boolean(), fallback.self).value_or(fallback.self),
          .others = fields.value("body_contact", boolean(), fallback.others).value_or(fallback.others)};
}

/// Whether a mesh is written with new normals. Only frames that follow a file have normals.
bool read_normals(Fields& fields, const std::optional<BodyShapeScene>& shape) {
  const bool mesh = shape && (std::holds_alternative<MeshFile>(*shape) || std::holds_alternative<LatticeFile>(*shape));
  if (mesh) return fields.value("normals", boolean(), false).value_or(false);
  const auto normals = fields.optional("normals", boolean());
  if (normals && shape) {
    fields.location().at("normals").report(fields.json()["normals"], "is for bodies with a mesh or a lattice as their shape",
                                           "remove it");
  }
  return false;
}

/// `preserve` needs a body with cells, `factor` a closed mesh.
struct VolumeScene {
  bool preserve = false;
  double factor = 0.0;
};

VolumeScene read_volume(Fields& fields, const std::optional<BodyShapeScene>& shape) {
  VolumeScene volume;
  const auto report = [&](const char* key, const std::string& rule, const std::string& remedy) {
    fields.location().at(key).report(fields.json()[key], rule, remedy);
  };
  volume.preserve = fields.value("preserve", boolean(), false).value_or(false);
  if (volume.preserve && shape && !has_cells(*shape)) {
    report("preserve", "needs cells, which a solid, a lattice and tetrahedra have",
           "a closed mesh has \"factor\" instead; or remove it");
  }
  if (const auto factor = fields.optional("factor", number(kPositive))) {
    volume.factor = *factor;
    if (shape && !std::holds_alternative<MeshFile>(*shape)) {
      report("factor", "needs a closed mesh", "a solid has \"preserve\" instead; or remove it");
    }
  }
  return volume;
}

double read_pressure(Fields& fields, const std::optional<BodyShapeScene>& shape) {
  const auto pressure = fields.value("pressure", number(), 0.0);
  if (pressure.value_or(0.0) != 0.0 && shape && !std::holds_alternative<MeshFile>(*shape)) {
    fields.location().at("pressure").report(fields.json()["pressure"], "needs a closed mesh", "remove it");
  }
  return pressure.value_or(0.0);
}

/// A torn mesh encloses no volume.
void refuse_break_of_closed(const Fields& fields) {
  const auto refuse = [](const Json& springs, const JsonLocation& location) {
    if (!springs.is_object() || !springs.contains("break")) return;
    location.at("break").report(springs["break"],
                                "needs a mesh without pressure and volume.factor, as a torn one encloses no volume",
                                "remove one of them");
  };
  const Json springs = fields.json().value("springs", Json::object());
  for (const char* name : kSpringKindNames) {
    if (!springs.is_object() || !springs.contains(name)) continue;
    const JsonLocation location = fields.location().at("springs").at(name);
    const Json& kind = springs[name];
    refuse(kind, location);
    if (!kind.is_object() || !kind.contains("groups") || !kind["groups"].is_object()) continue;
    for (const auto& group : kind["groups"].items()) refuse(group.value(), location.at("groups").at(group.key()));
  }
}

BodyScene read_body(Fields& fields) {
  BodyScene body;
  set_remedies_of_place(fields);
  fields.set_remedy({"initial_velocity", "speed"}, "did you mean \"velocity\"?");
  fields.set_owner({"type", "file", "size", "resolution", "particles"}, "shape");
  const auto shape = fields.required("shape", object_of<BodyShapeScene>(read_shape));
  body.shape = shape.value_or(BodyShapeScene{});
  read_preset(fields, shape, body);
  body.mass = read_mass(fields);
  const auto springs_rule = object_of<SpringsScene>([&](Fields& keys) { return read_springs(keys, shape); });
  SpringsScene springs = fields.value("springs", springs_rule, Json::object()).value_or(SpringsScene{});
  body.springs = springs.materials;
  body.spring_groups = std::move(springs.groups);
  body.place = fields.value("place", placement_rule(), Json::object()).value_or(Placement{});
  const NamedParts parts = named_parts(shape);
  const auto pins = fields.value("pins", list_of(pin_rule(parts), 0), Json::array());
  body.pins = pins.value_or(std::vector<PinScene>{});
  const auto point_masses = fields.value("point_masses", list_of(point_mass_rule(parts), 0), Json::array());
  body.point_masses = point_masses.value_or(std::vector<PointMassScene>{});
  body.velocity = fields.value("velocity", vector3(), {0, 0, 0}).value_or(Vector3::Zero());
  const auto volume_rule = object_of<VolumeScene>([&](Fields& keys) { return read_volume(keys, shape); });
  const auto volume = fields.value("volume", volume_rule, Json::object()).value_or(VolumeScene{});
  body.preserve_volume = volume.preserve;
  body.volume_factor = volume.factor;
  body.pressure = read_pressure(fields, shape);
  if (body.pressure != 0.0 || body.volume_factor != 0.0) refuse_break_of_closed(fields);
  body.material = read_material(fields);
  body.contact = read_body_contact(fields);
  body.normals = read_normals(fields, shape);
  return body;
}

}  // namespace

NamedParts named_parts(const std::optional<BodyShapeScene>& shape) {
  if (!shape) {
    NamedParts all{.corners = {}, .groups = true};
    for (const auto& some : {corner_names(RopeShape{}), corner_names(ClothShape{}), corner_names(SolidShape{})})
      all.corners.insert(all.corners.end(), some.begin(), some.end());
    return all;
  }
  struct Parts {
    NamedParts operator()(const MeshFile& /*mesh*/) const { return {.corners = {}, .groups = true}; }
    NamedParts operator()(const LatticeFile& /*lattice*/) const { return {}; }
    NamedParts operator()(const TetrahedraFile& /*tetrahedra*/) const { return {}; }
    NamedParts operator()(const RopeShape& rope) const { return {.corners = corner_names(rope)}; }
    NamedParts operator()(const ClothShape& cloth) const { return {.corners = corner_names(cloth)}; }
    NamedParts operator()(const SolidShape& solid) const { return {.corners = corner_names(solid)}; }
  };
  return std::visit(Parts{}, *shape);
}

Rule<BodyScene> body_rule() { return object_of<BodyScene>(read_body); }

}  // namespace sprung
