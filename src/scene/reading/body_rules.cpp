#include "network/bodies/corners.h"
#include "scene/reading/material_rules.h"
#include "scene/reading/scene_rules.h"

#include <optional>

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
  const auto size = fields.required("size", array_of<2>(number(kPositive)));
  return {.size = size.value_or(std::array<double, 2>{}), .resolution = read_resolution<2>(fields)};
}

SolidShape read_solid(Fields& fields) {
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

std::optional<BodyShapeScene> read_shape(Fields& fields) {
  const auto kind = fields.kind("type", {"rope", "cloth", "solid", "mesh", "lattice", "tetrahedra"});
  if (!kind) {
    fields.accept_keys_of_all_kinds(
        {"from", "to", "points", "particles", "length", "size", "resolution", "file", "weld", "cells", "cell_size"});
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

/// What selectors may name in the shape; in any shape if it is invalid.
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

SpringMaterial read_spring(Fields& fields) {
  SpringMaterial material;
  const auto stiffness = fields.optional("stiffness", number(kNotNegative));
  const auto modulus = fields.optional("modulus", number(kNotNegative));
  std::optional<double> value;
  if (const auto key = fields.one_of({"stiffness", "modulus"})) {
    const bool by_modulus = *key == "modulus";
    material.measure = by_modulus ? SpringMaterial::Measure::modulus : SpringMaterial::Measure::stiffness;
    value = by_modulus ? modulus : stiffness;
    material.value = value.value_or(0.0);
  }
  if (fields.has("damping_ratio")) {
    (void)fields.optional("damping", number(kNotNegative));
    (void)fields.optional("damping_time", number(kNotNegative));
    fields.one_of({"damping", "damping_ratio", "damping_time"});
    material.damping_ratio = fields.optional("damping_ratio", number(kNotNegative));
    if (value == 0.0) {
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

SpringMaterials read_springs(Fields& fields, const std::optional<BodyShapeScene>& shape) {
  const auto spring = object_of<SpringMaterial>(read_spring);
  SpringMaterials materials;
  materials.structural = fields.optional("structural", spring);
  materials.shear = fields.optional("shear", spring);
  const auto bend = object_of<SpringMaterial>([&](Fields& keys) {
    const auto model = keys.value("model", word_of({"spring", "angle"}), "spring");
    materials.bend_model = model == 1 ? SpringMaterials::BendModel::angle : SpringMaterials::BendModel::spring;
    return read_spring(keys);
  });
  materials.bend = fields.optional("bend", bend);
  refuse_other_springs(fields, shape);
  return materials;
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

/// `preserve` of what has cells, `factor` of a closed mesh.
struct VolumeScene {
  bool preserve = false;
  double factor = 0.0;
};

bool has_cells(const BodyShapeScene& shape) {
  return std::holds_alternative<SolidShape>(shape) || std::holds_alternative<LatticeFile>(shape) ||
         std::holds_alternative<TetrahedraFile>(shape);
}

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

BodyScene read_body(Fields& fields) {
  BodyScene body;
  const auto shape = fields.required("shape", object_of<BodyShapeScene>(read_shape));
  body.shape = shape.value_or(BodyShapeScene{});
  read_preset(fields, shape, body);
  body.mass = read_mass(fields);
  const auto springs = object_of<SpringMaterials>([&](Fields& keys) { return read_springs(keys, shape); });
  body.springs = fields.value("springs", springs, Json::object()).value_or(SpringMaterials{});
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
  body.material = read_material(fields);
  body.contact = read_body_contact(fields);
  body.normals = read_normals(fields, shape);
  return body;
}

}  // namespace

Rule<BodyScene> body_rule() { return object_of<BodyScene>(read_body); }

}  // namespace sprung
