// The presets of "material": one table for the program, the schema and the documentation.
#include "scene/materials/materials.h"

#include "network/bodies/body_shape.h"
#include "scene/building/scene_builder.h"
#include "scene/scene_schema.h"
#include "scene/scene_text.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numeric>
#include <set>

namespace sprung {
namespace {

using testing::AnyOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

const std::vector<MaterialKind> kKinds{MaterialKind::cloth, MaterialKind::rope, MaterialKind::solid};

std::vector<std::string> keys_of(const Material& material) {
  std::vector<std::string> keys;
  for (const MaterialValue& value : material.values) keys.push_back(value.key);
  return keys;
}

TEST(Materials, EachKindHasOneSetOfKeysAndUnits) {
  for (const MaterialKind kind : kKinds) {
    const std::vector<std::string> names = material_names({kind});
    ASSERT_FALSE(names.empty());
    const Material& first = *find_material(names.front());
    for (const std::string& name : names) {
      const Material& material = *find_material(name);
      EXPECT_EQ(keys_of(material), keys_of(first)) << name;
      for (std::size_t v = 0; v < material.values.size(); ++v) {
        EXPECT_EQ(material.values[v].unit, first.values[v].unit) << name << " " << material.values[v].key;
        EXPECT_EQ(material.values[v].power, first.values[v].power) << name << " " << material.values[v].key;
      }
    }
  }
  EXPECT_EQ(find_material("cotton")->find("density")->unit, "kg/m^2");
  EXPECT_EQ(find_material("hemp")->find("density")->unit, "kg/m");
  EXPECT_EQ(find_material("foam")->find("density")->unit, "kg/m^3");
  EXPECT_EQ(find_material("cotton")->find("springs.bend.modulus")->unit, "N m");
  EXPECT_EQ(find_material("hemp")->find("springs.bend.modulus")->unit, "N m^2");
  EXPECT_EQ(find_material("foam")->find("springs.shear.modulus")->unit, "Pa");
}

TEST(Materials, JelliesPreserveTheirVolumeUnlessTheBodySaysOtherwise) {
  const auto preserves = [](const std::string& keys) {
    const SceneFolder folder;
    const Scene scene = folder.read(
        R"({"duration": 1, "bodies": {"block": {"shape": {"type": "solid", "size": [1, 1, 1], "resolution": [3, 3, 3]}, )" + keys +
        "}}}");
    return scene.bodies.front().preserve_volume;
  };
  EXPECT_TRUE(preserves(R"("material": "soft_jelly")"));
  EXPECT_TRUE(preserves(R"("material": "firm_jelly", "volume": {})"));
  EXPECT_FALSE(preserves(R"("material": "firm_jelly", "volume": {"preserve": false})"));
  EXPECT_FALSE(preserves(R"("material": "foam")"));
  EXPECT_FALSE(preserves(R"("material": "rubber_block")"));
  EXPECT_THAT(material_description(*find_material("soft_jelly")), HasSubstr("volume.preserve = true"));
}

TEST(Materials, EachValueIsPositiveAndHasASourceThatSaysWhereOrWhy) {
  for (const Material& material : materials()) {
    EXPECT_FALSE(material.what.empty()) << material.name;
    for (const MaterialValue& value : material.values) {
      EXPECT_GT(value.value, 0.0) << material.name << " " << value.key;
      EXPECT_THAT(value.source, AnyOf(StartsWith("published: "), StartsWith("chosen: "))) << material.name << " " << value.key;
      EXPECT_GT(value.source.size(), std::string("published: ").size() + 4) << material.name << " " << value.key;
    }
    EXPECT_LE(material.find("friction")->value, material.find("static_friction")->value) << material.name;
  }
}

// Springs whose waves travel at c = sqrt(modulus / density) need 2 c / l steps a second or more between particles l apart.
TEST(Materials, NoSpringsOfClothsAndRopesCarryWavesFasterThanTheRuleSays) {
  EXPECT_THAT(stretch_limit_rule(), HasSubstr("faster than 50 m/s"));
  EXPECT_THAT(stretch_limit_rule(), HasSubstr("ropes: 60 m/s"));
  for (const Material& material : materials()) {
    if (material.kind == MaterialKind::solid) continue;
    const double fastest = material.kind == MaterialKind::rope ? 60.0 : 50.0;
    for (const MaterialValue& value : material.values) {
      if (value.unit != "N" && value.unit != "N/m") continue;
      EXPECT_LE(std::sqrt(value.value / material.find("density")->value), fastest * 1.001) << material.name << " " << value.key;
    }
  }
  for (const char* limited :
       {"cotton", "silk", "wool", "denim", "leather", "felt", "paper", "hemp", "nylon", "steel_cable", "hair"})
    EXPECT_TRUE(find_material(limited)->stretch_limited) << limited;
  for (const char* free : {"jersey", "rubber_sheet", "soft_jelly", "firm_jelly", "foam", "rubber_block"})
    EXPECT_FALSE(find_material(free)->stretch_limited) << free;
}

TEST(Materials, TheSchemaHasTheNamesOfTheTable) {
  const Json& definitions = scene_schema()["definitions"];
  for (const MaterialKind kind : kKinds) {
    const std::string name = std::string(material_kind_name(kind)) + "_material";
    EXPECT_EQ(definitions[name]["enum"].get<std::vector<std::string>>(), material_names({kind}));
  }
}

TEST(Materials, TheReadmeOfTheExamplesShowsTheOutputOfTheProgram) {
  std::ifstream stream(SPRUNG_SOURCE_DIR "/examples/README.md");
  const std::string readme(std::istreambuf_iterator<char>(stream), {});
  EXPECT_THAT(readme, HasSubstr("```\n" + materials_overview() + "```\n"));
}

TEST(Materials, ADescriptionHasEachValueWithItsUnitAndSource) {
  for (const Material& material : materials()) {
    const std::string text = material_description(material);
    for (const MaterialValue& value : material.values) {
      EXPECT_THAT(text, HasSubstr(value.key + " = "));
      EXPECT_THAT(text, HasSubstr(value.source + "\n"));
      EXPECT_THAT(text, HasSubstr(value.unit == "1" ? "" : " " + value.unit));
    }
  }
  EXPECT_THAT(material_description(*find_material("cotton")), HasSubstr("replaces 21400 N/m (published: "));
}

/// A scene with a body of each material and nothing else.
std::string scene_of(const Material& material, const std::string& keys = "") {
  const std::map<MaterialKind, std::string> shapes{
      {MaterialKind::cloth, R"({"type": "cloth", "size": [1, 1], "resolution": [9, 9]})"},
      {MaterialKind::rope, R"({"type": "rope", "from": [0, 0, 0], "to": [1, 0, 0], "particles": 21})"},
      {MaterialKind::solid, R"({"type": "solid", "size": [0.3, 0.3, 0.3], "resolution": [4, 4, 4]})"}};
  return R"({"duration": 0.1, "bodies": {"thing": {"shape": )" + shapes.at(material.kind) + R"(, "material": ")" + material.name +
         "\"" + keys + "}}}";
}

TEST(Materials, AShapeAndAMaterialAreAWholeBody) {
  const SceneFolder folder;
  for (const Material& material : materials()) {
    const Scene scene = folder.read(scene_of(material));
    EXPECT_THAT(schema_violations(parse_json(scene_of(material), "").document), IsEmpty()) << material.name;
    const BuiltScene built = build_scene(scene);
    EXPECT_THAT(built.warnings, IsEmpty()) << material.name;
    const Body& body = built.network.bodies.front();
    EXPECT_NEAR(built.network.masses.sum() / body.measure, material.find("density")->value, 1e-9 * material.find("density")->value)
        << material.name;
    EXPECT_GT(body.spring_count, 0);
    EXPECT_EQ(body.angle_bend_count > 0, material.kind != MaterialKind::solid) << material.name;
    EXPECT_EQ(body.material.friction, material.find("friction")->value);
    EXPECT_EQ(body.material.static_friction, material.find("static_friction")->value);
    EXPECT_EQ(body.material.thickness, material.find("thickness")->value);
    EXPECT_EQ(scene.settings.stretch_limit.has_value(), material.stretch_limited) << material.name;
    EXPECT_EQ(scene.limited_bodies.size(), material.stretch_limited ? 1U : 0U) << material.name;
  }
}

// The resolved scene of a run is complete: read again, it is the same scene.
TEST(Materials, TheResolvedSceneHasTheValuesAndReadsBackTheSame) {
  const SceneFolder folder;
  for (const Material& material : materials()) {
    const std::string once = folder.read(scene_of(material)).resolved;
    const Json body = Json::parse(once)["bodies"]["thing"];
    for (const MaterialValue& value : material.values) {
      std::string pointer = "/" + value.key;
      std::ranges::replace(pointer, '.', '/');
      ASSERT_TRUE(body.contains(Json::json_pointer(pointer))) << material.name << " " << value.key;
      EXPECT_EQ(body[Json::json_pointer(pointer)].get<double>(), value.value) << material.name << " " << value.key;
    }
    EXPECT_EQ(folder.read(once).resolved, once) << material.name;
  }
}

TEST(Materials, KeysBesideTheMaterialWin) {
  const SceneFolder folder;
  const Material& cotton = *find_material("cotton");
  const auto body = [&](const std::string& keys) { return folder.read(scene_of(cotton, keys)).bodies.front(); };
  EXPECT_EQ(body(R"(, "mass": 3)").mass.kind, MassScene::Kind::body);
  EXPECT_EQ(body(R"(, "particle_mass": 3)").mass.kind, MassScene::Kind::particle);
  EXPECT_EQ(body(R"(, "density": 3)").mass.value, 3.0);
  EXPECT_EQ(body(R"(, "thickness": 0.01)").material.thickness, 0.01);
  EXPECT_EQ(body(R"(, "friction": 0.9)").material.static_friction, 0.9) << "static friction follows friction";
  EXPECT_EQ(body(R"(, "static_friction": 0.1)").material.friction, 0.1) << "friction is at most static friction";

  const BodyScene partial = body(R"(, "springs": {"shear": {"stiffness": 7}, "bend": {"damping": 0.5}})");
  EXPECT_EQ(partial.springs.shear->measure, SpringMaterial::Measure::stiffness);
  EXPECT_EQ(partial.springs.shear->value, 7.0);
  EXPECT_EQ(partial.springs.shear->damping_time, cotton.find("springs.shear.damping_time")->value);
  EXPECT_EQ(partial.springs.bend->value, cotton.find("springs.bend.modulus")->value);
  EXPECT_EQ(partial.springs.bend->damping, 0.5);
  EXPECT_EQ(partial.springs.bend->damping_time, 0.0);
  EXPECT_EQ(partial.springs.bend_model, SpringMaterials::BendModel::angle);
  EXPECT_EQ(partial.springs.structural->value, cotton.find("springs.structural.modulus")->value);
  EXPECT_EQ(body(R"(, "springs": {"bend": {"model": "spring", "modulus": 4}})").springs.bend_model,
            SpringMaterials::BendModel::spring);
}

// Also those that the scene gives, and those of a kind for which the material has none.
TEST(Materials, AllDampersOfABodyWithAMaterialAreThoseOfAMaterial) {
  using Damps = std::array<bool, 3>;
  const SceneFolder folder;
  const auto damps = [&](const std::string& scene) {
    return build_scene(folder.read(scene)).network.bodies.front().has_material_dampers;
  };
  const Material& cotton = *find_material("cotton");
  EXPECT_EQ(damps(scene_of(cotton)), (Damps{true, true, true}));
  EXPECT_EQ(damps(scene_of(cotton, R"(, "springs": {"structural": {"damping_ratio": 0.5}, "bend": {"damping": 0.5}})")),
            (Damps{true, true, true}));
  EXPECT_EQ(damps(scene_of(*find_material("foam"))), (Damps{true, true, true}));
  EXPECT_EQ(damps(R"({"duration": 1, "bodies": {"thing": {"shape": {"type": "rope", "from": [0, 0, 0], "to": [1, 0, 0],
            "particles": 3}, "mass": 1, "springs": {"structural": {"stiffness": 1, "damping": 1}}}}})"),
            Damps{});
}

TEST(Materials, AResolvedSceneKeepsTheMassOfTheMaterial) {
  const SceneFolder folder;
  const Material& cotton = *find_material("cotton");
  EXPECT_TRUE(folder.read(folder.read(scene_of(cotton)).resolved).bodies.front().preset_mass);
  EXPECT_FALSE(folder.read(scene_of(cotton, R"(, "density": 3)")).bodies.front().preset_mass);
}

// Nobody asked for it: a scene that says nothing of a limit needs no advice about it.
TEST(Materials, ALimitThatStandsInForStiffnessIsToldFromOneThatTheSceneGives) {
  const SceneFolder folder;
  const std::string scene = scene_of(*find_material("cotton"));
  EXPECT_TRUE(folder.read(scene).settings.stretch_limit->of_materials);
  for (const char* written :
       {"stretch_limit={}", R"(stretch_limit={"bodies": ["thing"]})", R"(stretch_limit={"max_stretch": 0.05})"}) {
    EXPECT_FALSE(folder.read(scene, {written}).settings.stretch_limit->of_materials) << written;
  }
}

TEST(Materials, BodiesThatMayTearDampTheirRecoil) {
  const SceneFolder folder;
  for (const char* name : {"cotton", "hemp"}) {
    const std::string scene = scene_of(*find_material(name), R"(, "springs": {"structural": {"break": 0.1}})");
    const BodyScene tears = folder.read(scene).bodies.front();
    EXPECT_EQ(tears.springs.structural->damping_time, kTearingDampingTime) << name;
    EXPECT_TRUE(!tears.springs.shear || tears.springs.shear->damping_time == kTearingDampingTime) << name;
    EXPECT_LT(folder.read(scene_of(*find_material(name))).bodies.front().springs.structural->damping_time, kTearingDampingTime);
    EXPECT_EQ(
        folder.read(scene, {"bodies.thing.springs.structural.damping_time=3e-4"}).bodies.front().springs.structural->damping_time,
        3e-4);
  }
}

TEST(Materials, ABodyOfWhichOnlyAGroupMayTearDampsItsRecoilToo) {
  const SceneFolder folder;
  const auto damping_time = [&](const std::string& keys_of_seam) {
    const std::string scene =
        R"({"duration": 1, "bodies": {"dress": {"shape": {"type": "mesh", "file": "a.obj"}, "material": "cotton",
        "springs": {"structural": {"groups": {"seam": {)" +
        keys_of_seam + "}}}}}}}";
    return folder.read(scene).bodies.front().springs.structural->damping_time;
  };
  EXPECT_LT(damping_time(R"("modulus": 50)"), kTearingDampingTime);
  EXPECT_EQ(damping_time(R"("modulus": 50, "break": 0.2)"), kTearingDampingTime);
}

// EI and D are constants of angles, with other units than EA: broken_scenes.h has the scenes that lack a stiffness of their own.
TEST(Materials, BendSpringsTakeTheDampingTimeOfAMaterialButNoStiffness) {
  const SceneFolder folder;
  const Material& cotton = *find_material("cotton");
  const BodyScene cloth =
      folder.read(scene_of(cotton, R"(, "springs": {"bend": {"model": "spring", "stiffness": 4}})")).bodies.front();
  EXPECT_EQ(cloth.springs.bend->value, 4.0);
  EXPECT_EQ(cloth.springs.bend->damping_time, cotton.find("springs.bend.damping_time")->value);
  const std::string mesh =
      R"({"duration": 1, "bodies": {"thing": {"shape": {"type": "mesh", "file": "a.obj"}, "material": "cotton")";
  const BodyScene plain = folder.read(mesh + "}}}").bodies.front();
  EXPECT_EQ(plain.springs.bend->value, cotton.find("springs.bend.modulus")->value);
  EXPECT_EQ(plain.springs.bend_model, SpringMaterials::BendModel::angle);
  const BodyScene sheet = folder.read(mesh + R"(, "springs": {"bend": {"model": "spring", "stiffness": 4}}}}})").bodies.front();
  EXPECT_EQ(sheet.springs.bend->value, 4.0);
  EXPECT_EQ(sheet.springs.bend->damping_time, cotton.find("springs.bend.damping_time")->value);
  EXPECT_EQ(sheet.springs.bend_model, SpringMaterials::BendModel::spring);
}

// All values of a rope follow from its diameter, so a diameter without sense is the only problem.
TEST(Materials, ADiameterIsTheOnlyProblemOfARopeOrNone) {
  const SceneFolder folder;
  const auto problems = [&](const std::string& name, const std::string& diameter) {
    const std::string scene = scene_of(*find_material(name), ", \"diameter\": " + diameter);
    return problems_of([&] { (void)build_scene(folder.read(scene)); });
  };
  for (const std::string& name : material_names({MaterialKind::rope})) {
    for (const char* diameter : {"1e-6", "10"}) EXPECT_THAT(problems(name, diameter), IsEmpty()) << name << " " << diameter;
    for (const char* diameter : {"1e-150", "1e20"}) {
      EXPECT_THAT(problems(name, diameter), ElementsAre(testing::Field(&Problem::key, "bodies.thing.diameter")))
          << name << " " << diameter;
    }
  }
}

TEST(Materials, ABodyWithoutAKnownMaterialHasNoFurtherProblems) {
  const SceneFolder folder;
  const std::string damped = R"(, "springs": {"bend": {"damping": 0.5}})";
  Material misspelt = *find_material("cotton");
  misspelt.name = "coton";
  EXPECT_EQ(problems_of([&] { (void)folder.read(scene_of(misspelt, damped)); }).size(), 1U) << "the name is the only problem";
}

TEST(Materials, TheLimitOfAMaterialHoldsItsBodiesAlone) {
  const SceneFolder folder;
  const std::string two = R"({"duration": 0.1, "bodies": {
    "stiff": {"shape": {"type": "cloth", "size": [1, 1], "resolution": [3, 3]}, "material": "cotton"},
    "soft": {"shape": {"type": "cloth", "size": [1, 1], "resolution": [3, 3]}, "material": "jersey", "place": {"position": [0, 1, 0]}}}})";
  const Scene scene = folder.read(two);
  EXPECT_THAT(scene.limited_bodies, ElementsAre("stiff"));
  const BuiltScene built = build_scene(scene);
  EXPECT_TRUE(built.network.bodies[0].stretch_limited);
  EXPECT_FALSE(built.network.bodies[1].stretch_limited);

  EXPECT_THAT(folder.read(two, {"stretch_limit.max_stretch=0.1"}).limited_bodies, IsEmpty()) << "the scene's own limit holds all";
  EXPECT_THAT(folder.read(two, {"stretch_limit.bodies=[\"soft\"]"}).limited_bodies, ElementsAre("soft"));
  const Scene own = folder.read(two, {"bodies.stiff.springs.structural.stiffness=1000"});
  EXPECT_FALSE(own.settings.stretch_limit.has_value()) << "a structural stiffness of the body needs no limit";
}

TEST(Materials, ARopeScalesWithItsDiameter) {
  const SceneFolder folder;
  const Material& hemp = *find_material("hemp");
  const double d = hemp.find("diameter")->value;
  const BodyScene twice = folder.read(scene_of(hemp, ", \"diameter\": " + std::to_string(2.0 * d))).bodies.front();
  const auto expect = [&](double value, const std::string& key, double factor) {
    EXPECT_NEAR(value, factor * hemp.find(key)->value, 1e-9 * value) << key;
  };
  expect(twice.mass.value, "density", 4.0);
  expect(twice.springs.structural->value, "springs.structural.modulus", 4.0);
  expect(twice.springs.bend->value, "springs.bend.modulus", 16.0);
  expect(twice.material.thickness, "thickness", 2.0);
  expect(twice.material.friction, "friction", 1.0);
}

TEST(Materials, AMeshWithFacesIsAClothAndOneOfLinesIsARope) {
  const SceneFolder folder;
  folder.write("sheet.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
  folder.write("string.obj", "v 0 0 0\nv 0.5 0 0\nv 1 0 0\nl 1 2\nl 2 3\n");
  const auto scene = [](const std::string& file, const std::string& material) {
    return R"({"duration": 0.1, "bodies": {"thing": {"shape": {"type": "mesh", "file": ")" + file + R"("}, "material": ")" +
           material + "\"}}}";
  };
  EXPECT_NEAR(build_scene(folder.read(scene("sheet.obj", "cotton"))).network.masses.sum(),
              find_material("cotton")->find("density")->value, 1e-15);
  // EA = k l: k of a segment of half a metre is EA / 0.5.
  const BuiltScene string = build_scene(folder.read(scene("string.obj", "hemp")));
  EXPECT_NEAR(string.network.springs.stiffness[0], 2.0 * find_material("hemp")->find("springs.structural.modulus")->value, 1e-9);
  const auto says = [&](const std::string& file, const std::string& material) {
    const auto problems = problems_of([&] { (void)build_scene(folder.read(scene(file, material))); });
    return problems.empty() ? "" : to_string(problems.front());
  };
  EXPECT_THAT(says("sheet.obj", "hemp"), HasSubstr("must be a material for a mesh with faces, which is a cloth: cotton"));
  EXPECT_THAT(says("string.obj", "cotton"), HasSubstr("must be a material for a mesh of lines, which is a rope: hemp"));
}

/// The energy per volume [J/m^3] of a block of foam under the strain u = gradient * x.
double energy_density(const Eigen::Matrix3d& gradient) {
  const SceneFolder folder;
  const BuiltScene built = build_scene(folder.read(scene_of(*find_material("foam"))));
  const Springs& springs = built.network.springs;
  double energy = 0.0;
  for (Index s = 0; s < springs.count(); ++s) {
    const Vector3 before = built.network.positions.col(springs.second[s]) - built.network.positions.col(springs.first[s]);
    const double longer = before.normalized().dot(gradient * before);
    energy += 0.5 * springs.stiffness[s] * longer * longer;
  }
  return energy / built.network.bodies.front().measure;
}

// The springs of tetrahedra are made from Young's modulus, a solid's from 10/17 of it and from a modulus of shear.
TEST(Materials, TetrahedraTakeYoungsModulusAndNoShearSprings) {
  const SceneFolder folder;
  const std::string scene =
      R"({"duration": 1, "bodies": {"thing": {"shape": {"type": "tetrahedra", "file": "a.msh"}, "material": "foam"}}})";
  const BodyScene body = folder.read(scene).bodies.front();
  EXPECT_NEAR(body.springs.structural->value, 3.0e5, 5e-4 * 3.0e5) << "foam; values of the table have four digits";
  EXPECT_EQ(body.springs.structural->damping_ratio, find_material("foam")->find("springs.structural.damping_ratio")->value);
  EXPECT_FALSE(body.springs.shear);
  EXPECT_FALSE(body.springs.bend);
  EXPECT_EQ(folder.read(scene, {"bodies.thing.springs.structural.modulus=7"}).bodies.front().springs.structural->value, 7.0);
}

// An isotropic solid has the energy 1/2 E eps^2 under a tension that leaves its sides free to contract by eps / 4, and 1/2 G
// gamma^2 with G = E / (2 (1 + 1/4)) under shear, in any direction. Values of the table have four digits.
TEST(Materials, ASolidHasItsYoungsModulusInEachDirection) {
  const double young = 3.0e5;  // of foam [Pa]
  Eigen::Matrix3d tension = Eigen::Vector3d(1.0, -0.25, -0.25).asDiagonal();
  const Eigen::Matrix3d turn = rotation_from_degrees({20.0, 35.0, 50.0});
  EXPECT_NEAR(energy_density(tension), 0.5 * young, 5e-4 * young);
  EXPECT_NEAR(energy_density(turn * tension * turn.transpose()), 0.5 * young, 5e-4 * young);
  Eigen::Matrix3d shear = Eigen::Matrix3d::Zero();
  shear(0, 1) = 1.0;
  EXPECT_NEAR(energy_density(shear), 0.5 * young / 2.5, 5e-4 * young);
}

}  // namespace
}  // namespace sprung
