#include "scene/step_choice/step_choice.h"
#include "base/format.h"
#include "dynamics/stretch_limit/stretch_limit.h"
#include "scene/building/scene_builder.h"
#include "scene/scene_text.h"

#include <gmock/gmock.h>

#include <cmath>

namespace sprung {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;
using testing::Not;

// Two particles of 1 kg, 1 m apart, one pinned: the free one oscillates with omega^2 = k / m, so symplectic Euler is stable up to
// 2 / sqrt(k).
BuiltScene build(double stiffness, const std::vector<std::string>& changes = {}) {
  const SceneFolder folder;
  const std::string text = R"({"duration": 1, "frame_rate": 10, "integrator": {"type": "symplectic_euler"}, "bodies": {"pair": {
      "shape": {"type": "rope", "from": [0, 0, 0], "to": [1, 0, 0], "particles": 2}, "particle_mass": 1,
      "springs": {"structural": {"stiffness": )" +
                           std::to_string(stiffness) + R"(}}, "pins": [{"indices": [0]}]}}})";
  return build_scene(folder.read(text, changes));
}

// The bounds come from an iteration that converges from below, and exceed the eigenvalue by at most 1.5 %: 0.75 % of the step.
constexpr double kBoundSlack = 0.0075;

TEST(StepChoice, LargestStableStepHasItsClosedForm) {
  const BuiltScene built = build(100.0);
  EXPECT_LE(built.largest_stable_step, 0.2);
  EXPECT_GE(built.largest_stable_step, 0.2 * (1.0 - kBoundSlack));
}

// While both particles are free, omega^2 = 2 k / m.
TEST(StepChoice, LargestStableStepIsThatOfTheFreestNetwork) {
  const double free = std::sqrt(0.5) * 0.2;
  for (const char* times : {"bodies.pair.pins[0].until=0.5", "bodies.pair.pins[0].from=0.5"}) {
    EXPECT_NEAR(build(100.0, {times}).largest_stable_step, free, kBoundSlack * free) << times;
  }
}

TEST(StepChoice, LargestStableStepDependsOnTheScheme) {
  EXPECT_NEAR(build(100.0, {R"(integrator={"type": "velocity_verlet"})"}).largest_stable_step, 0.2, kBoundSlack * 0.2);
  EXPECT_NEAR(build(100.0, {R"(integrator={"type": "rk4"})"}).largest_stable_step, 0.2828, kBoundSlack * 0.2828);
}

TEST(StepChoice, AutoUsesTheFewestStepsWithinNineTenthsOfTheStableStep) {
  for (const double stiffness : {100.0, 1000.0, 54321.0, 1e6}) {
    const double damping = 0.05 * std::sqrt(stiffness);
    const BuiltScene built = build(stiffness, {"bodies.pair.springs.structural.damping=" + std::to_string(damping)});
    const int n = built.settings.steps_per_frame;
    EXPECT_EQ(built.settings.step, 1.0 / (10.0 * n));
    EXPECT_LE(built.settings.step, 0.9 * built.largest_stable_step);
    if (n > 1) {
      EXPECT_GT(1.0 / (10.0 * (n - 1)), 0.9 * built.largest_stable_step);
    }
  }
}

// Who chose a material has no stiffness to lower. A grid of 0.5 mm has angle bends that need steps of 2e-6 s.
TEST(StepChoice, AutoAdvisesACoarserMeshOfAMaterial) {
  const auto warnings = [](int resolution) {
    const SceneFolder folder;
    const std::string n = std::to_string(resolution);
    const std::string text =
        R"({"duration": 1, "bodies": {"cloth": {"shape": {"type": "cloth", "size": [0.02, 0.02], "resolution": [)" + n + ", " + n +
        R"(]}, "material": "cotton"}}})";
    return build_scene(folder.read(text)).warnings;
  };
  EXPECT_THAT(warnings(41), ElementsAre(HasSubstr("Use a coarser mesh or resolution, or \"implicit_euler\".")));
  EXPECT_THAT(warnings(9), testing::IsEmpty());
}

/// A cloth of cotton, 41 x 41, of this side [m].
BuiltScene cotton(double side, const std::vector<std::string>& changes = {}) {
  const SceneFolder folder;
  const std::string size = std::to_string(side);
  return build_scene(folder.read(R"({"duration": 1, "bodies": {"cloth": {"shape": {"type": "cloth", "size": [)" + size + ", " +
                                     size + R"(], "resolution": [41, 41]}, "material": "cotton"}}})",
                                 changes));
}

// As many steps as its springs need without dampers: 1,089 by six steps a period; dampers make those unnecessary.
TEST(StepChoice, DampersOfAMaterialNeedNoSmallerStepThanItsSprings) {
  const std::vector<std::string> undamped{"bodies.cloth.springs.structural.damping=0", "bodies.cloth.springs.shear.damping=0",
                                          "bodies.cloth.springs.bend.damping=0"};
  for (const char* integrator : {"verlet", "symplectic_euler", "velocity_verlet", "rk4"}) {
    const std::string change = std::string(R"(integrator={"type": ")") + integrator + "\"}";
    std::vector<std::string> without = undamped;
    without.push_back(change);
    EXPECT_LE(cotton(0.1, {change}).settings.steps_per_frame, cotton(0.1, without).settings.steps_per_frame) << integrator;
  }
  EXPECT_LE(cotton(0.1).settings.steps_per_frame, 1200);
  EXPECT_GT(cotton(0.001).settings.steps_per_frame, 1000) << "is not refused";
}

TEST(StepChoice, DampersBesideAMaterialNeedNoSmallerStepEither) {
  const int steps = cotton(0.1).settings.steps_per_frame;
  for (const char* kind : {"structural", "shear", "bend"}) {
    const std::string key = std::string("bodies.cloth.springs.") + kind + ".damping_time=";
    for (const char* time : {"0.01", "100"}) EXPECT_EQ(cotton(0.1, {key + time}).settings.steps_per_frame, steps) << key << time;
  }
}

/// Lines of an OBJ file: a square of triangles with n x n vertices, which begins at x = `from` [m].
std::string square_mesh(int n, double from, double side, int first_vertex = 1) {
  std::string mesh;
  const auto coordinate = [&](int i) { return format_number(side * i / (n - 1)); };
  for (int i = 0; i < n * n; ++i) mesh += "v " + format_number(from + side * (i % n) / (n - 1)) + " " + coordinate(i / n) + " 0\n";
  for (int i = 0; i < n * (n - 1); ++i) {
    if (i % n == n - 1) continue;
    const auto corner = [&](int offset) { return " " + std::to_string(i + first_vertex + offset); };
    mesh += "f" + corner(0) + corner(1) + corner(n + 1) + "\nf" + corner(0) + corner(n + 1) + corner(n) + "\n";
  }
  return mesh;
}

/// A sheet of silk of this mesh.
BuiltScene silk(const std::string& mesh, const std::string& keys = "", const std::string& of_body = "") {
  const SceneFolder folder;
  folder.write("mesh.obj", mesh);
  return build_scene(folder.read(R"({"duration": 1, )" + keys +
                                 R"("bodies": {"sheet": {"shape": {"type": "mesh", "file": "mesh.obj"},
                                    "material": "silk")" +
                                 of_body + "}}}"));
}

// A square of 15 x 15 vertices, one of which is 0.1 mm from its neighbour: without the adjustment about a thousand times the steps.
TEST(StepChoice, OneShortEdgeOfAMaterialDoesNotSlowTheScene) {
  std::string mesh = square_mesh(15, 0.0, 1.0);
  const std::string eighth = "v " + format_number(8.0 / 14.0) + " 0.5 0\n";
  mesh.replace(mesh.find(eighth), eighth.size(), "v 0.5001 0.5 0\n");
  const BuiltScene adjusted = silk(mesh);
  ASSERT_EQ(adjusted.adjustments.size(), 1);
  EXPECT_EQ(adjusted.adjustments[0].body, "sheet");
  EXPECT_NEAR(adjusted.adjustments[0].length, 0.0001, 1e-6);
  EXPECT_LE(adjusted.settings.steps_per_frame, 100);
  EXPECT_TRUE(silk(mesh, R"("frame_rate": 100, "step": 1e-5, "stability": "warn", )").adjustments.empty())
      << "the scene sets the step";
}

// Beside it lies a square of 5 x 5 vertices 0.25 mm apart: too many springs to become softer, but they weigh next to nothing.
TEST(StepChoice, AutoNamesWhatPreventsMassScaling) {
  const std::string mesh = square_mesh(15, 0.0, 1.0) + square_mesh(5, 1.1, 1e-3, 226);
  EXPECT_THAT(silk(mesh, R"("mass_scaling": false, )").warnings,
              ElementsAre(HasSubstr("merge the two vertices, or leave out \"mass_scaling\".")));
  EXPECT_THAT(silk(mesh, "", R"(, "density": 0.1)").warnings,
              ElementsAre(HasSubstr("merge the two vertices, or leave the mass to the material, which permits \"mass_scaling\".")));
  const BuiltScene scaled = silk(mesh);
  EXPECT_THAT(scaled.warnings, testing::IsEmpty());
  EXPECT_LE(scaled.settings.steps_per_frame, 150) << "instead of more than 1,000";
}

// Vertex 5 is 0.1 mm from vertex 3.
TEST(StepChoice, AutoNamesTheShortEdgeOfAMesh) {
  const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.9999 1 0\n";
  EXPECT_THAT(
      silk(square + "f 1 2 3 5\nf 1 5 4\n").warnings,
      ElementsAre(AllOf(HasSubstr("from [1, 1, 0] to [0.9999, 1, 0], 0.0001 m long"), HasSubstr("merge the two vertices."))));
  EXPECT_THAT(silk("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n").warnings, testing::IsEmpty());
}

// Up to a thousand steps per frame cause no warning. The warning of more steps names the cause and a remedy.
TEST(StepChoice, AutoWarnsOfTheCauseOfVeryManySteps) {
  EXPECT_THAT(build(1.0e8).warnings, testing::IsEmpty());
  EXPECT_THAT(build(1.0e10).warnings,
              ElementsAre(AllOf(HasSubstr("body \"pair\""), HasSubstr("structural"), HasSubstr("1e+10 N/m"), HasSubstr("1 kg"),
                                HasSubstr("less stiffness"), HasSubstr("implicit_euler"))));
  EXPECT_THAT(build(1.0e10, {R"(obstacles={"floor": {"shape": {"type": "half_space", "offset": -5}}})"}).warnings,
              ElementsAre(AllOf(HasSubstr("less stiffness, more mass."), Not(HasSubstr("implicit_euler")))))
      << "which is slow in contact";
  EXPECT_THAT(build(1.0, {"bodies.pair.springs.structural.damping=1e6"}).warnings,
              ElementsAre(AllOf(HasSubstr("body \"pair\""), HasSubstr("1e+06 N s/m"), HasSubstr("less damping"))));
  const auto with_bends = [](const std::string& bends) {
    return build(1.0e6, {"bodies.pair.shape.particles=3", "bodies.pair.springs.bend={\"model\": \"angle\", " + bends + "}"})
        .warnings;
  };
  EXPECT_THAT(with_bends(R"("stiffness": 1e10)"),
              ElementsAre(AllOf(HasSubstr("body \"pair\" has angle bends of 1e+10 N m "), HasSubstr("less stiffness"))));
  EXPECT_THAT(with_bends(R"("stiffness": 0, "damping": 1e6)"),
              ElementsAre(AllOf(HasSubstr("body \"pair\" has angle bends of 1e+06 N m s damping"), HasSubstr("less damping"))));
  EXPECT_THAT(build(1.0e10, {R"(integrator={"type": "implicit_euler"})"}).warnings, testing::IsEmpty());
  EXPECT_THAT(build(1.0e6, {R"(integrator={"type": "explicit_euler"})"}).warnings, Contains(HasSubstr("symplectic_euler")));
  EXPECT_THAT(build(0.0, {R"(stretch_limit={"max_stretch": 0, "tolerance": 0, "iterations": 1, "solver": "gauss_seidel"})",
                          "bodies.pair.shape.particles=1000"})
                  .warnings,
              ElementsAre(AllOf(HasSubstr("passes"), HasSubstr("newton"))));
  EXPECT_THAT(build(1.0e10, {"step=1e-7"}).warnings, testing::IsEmpty()) << "the scene sets the step";
}

// Six steps per oscillation.
TEST(StepChoice, AutoKeepsUndampedSpringsFromResonance) {
  for (const double stiffness : {1000.0, 54321.0, 1e6}) {
    const double resonant = 1.0 / std::sqrt(stiffness);
    const BuiltScene built = build(stiffness);
    EXPECT_LE(built.settings.step, resonant);
    EXPECT_GT(1.0 / (10.0 * (built.settings.steps_per_frame - 1)), resonant * (1.0 - kBoundSlack));
  }
}

TEST(StepChoice, AutoLimitsTheGrowthOfExplicitEulerWithinTheScene) {
  const std::string explicit_euler = R"(integrator={"type": "explicit_euler"})";
  // |1 + i omega dt| is sqrt(1 + omega^2 dt^2), so motion grows by a factor of e in the time 2 / (omega^2 dt). This is the scene's
  // duration of 1 s for dt = 2 / k.
  const BuiltScene built = build(1000.0, {explicit_euler});
  EXPECT_LE(built.settings.step, 2.0 / 1000.0);
  EXPECT_GT(1.0 / (10.0 * (built.settings.steps_per_frame - 1)), 2.0 / 1000.0 * (1.0 - 2.0 * kBoundSlack));
}

// Half a period of the penalty spring, pi sqrt(m / k), with 1 kg, takes three steps, damped or not, with any explicit scheme.
TEST(StepChoice, APenaltyBounceTakesThreeAutoSteps) {
  const auto penalty = [](const std::string& scheme, const std::string& damping) {
    return build(0.0,
                 {R"(contact={"response": "penalty", "stiffness": 543210, "damping": )" + damping + "}",
                  R"(integrator={"type": ")" + scheme + R"("})", R"(obstacles.floor.shape={"type": "half_space", "offset": -5})"});
  };
  const double third = 1.0 / std::sqrt(543210.0);
  for (const std::string scheme : {"verlet", "symplectic_euler", "velocity_verlet", "rk4"}) {
    for (const std::string damping : {"0", "10"}) {
      EXPECT_LE(penalty(scheme, damping).settings.step, third) << scheme;
      EXPECT_GT(1.0 / (10.0 * (penalty(scheme, damping).settings.steps_per_frame - 1)), third) << scheme;
    }
  }
  EXPECT_GT(penalty("implicit_euler", "0").settings.step, third);
}

TEST(StepChoice, AutoRespectsTheStretchLimit) {
  const BuiltScene free = build(0.0);
  const BuiltScene limited =
      build(0.0, {"bodies.pair.shape.particles=50",
                  "stretch_limit={\"iterations\":1,\"tolerance\":1e-3,\"max_stretch\":0,\"solver\":\"gauss_seidel\"}"});
  EXPECT_LT(limited.settings.step, free.settings.step);
  const StretchLimit limit(limited.network, *limited.settings.stretch_limit);
  EXPECT_LE(limited.settings.step, limit.suggested_step(9.81));
  EXPECT_GT(1.0 / (10.0 * (limited.settings.steps_per_frame - 1)), limit.suggested_step(9.81));
}

// Layers of a cloth that falls by its own extent L reach a speed of sqrt(g L). In a step they move by half their thickness at most,
// unless springs pull them back.
TEST(StepChoice, AutoRespectsLayersOfAClothWithoutStiffness) {
  const auto built = [](const std::vector<std::string>& changes) {
    const SceneFolder folder;
    const std::string text = R"({"duration": 1, "frame_rate": 10, "stretch_limit": {"solver": "gauss_seidel"},
        "bodies": {"cloth": {"shape": {"type": "cloth", "size": [1, 2], "resolution": [4, 8]}, "mass": 1, "thickness": 0.002,
        "self_contact": true, "springs": {"structural": {"stiffness": 0}}, "pins": [{"at": "corner", "which": ["min_max"]}]}}})";
    return build_scene(folder.read(text, changes));
  };
  const double bound = 0.5 * 0.002 / std::sqrt(9.81 * 2.0);
  const BuiltScene layers = built({});
  EXPECT_LE(layers.settings.step, bound);
  EXPECT_GT(1.0 / (10.0 * (layers.settings.steps_per_frame - 1)), bound);
  EXPECT_GT(built({"bodies.cloth.self_contact=false"}).settings.step, 2.0 * bound);
  EXPECT_GT(built({"bodies.cloth.springs.structural.stiffness=0.001"}).settings.step, 2.0 * bound);
}

TEST(StepChoice, AutoAllowsSubstepsForSuitableCloths) {
  const auto substeps = [](const std::vector<std::string>& changes) {
    const SceneFolder folder;
    const std::string text = R"({"duration": 1, "stretch_limit": {"max_compression": 0, "kinds": ["structural", "shear"],
        "tethers": true, "solver": "gauss_seidel"}, "bodies": {"cloth": {"shape": {"type": "cloth", "size": [1, 1], "resolution": [8, 8]}, "mass": 1,
        "springs": {"structural": {"stiffness": 0}, "shear": {"stiffness": 0}},
        "pins": [{"at": "corner", "which": ["min_max", "max_max"]}]}}})";
    return build_scene(folder.read(text, changes)).settings.max_substeps;
  };
  EXPECT_EQ(substeps({}), kAutoSubsteps);
  EXPECT_EQ(substeps({"frame_rate=10", "step=0.001"}), 1);
  EXPECT_EQ(substeps({"stretch_limit.max_compression=1"}), 1);
  EXPECT_EQ(substeps({"stretch_limit.kinds=[\"structural\"]"}), 1);
  EXPECT_EQ(substeps({"stretch_limit.tethers=false"}), 1);
  EXPECT_EQ(substeps({R"(integrator={"type": "verlet", "damping": 0.01})"}), 1);
}

TEST(StepChoice, AutoIsAFrameUnderAGlobalSolveWithoutContact) {
  const auto built = [](const std::vector<std::string>& changes) {
    const SceneFolder folder;
    const std::string text = R"({"duration": 1, "stretch_limit": {"solver": "newton"},
        "bodies": {"cloth": {"shape": {"type": "cloth", "size": [1, 1], "resolution": [4, 4]}, "mass": 1,
        "springs": {"structural": {"stiffness": 0}}, "pins": [{"at": "corner", "which": ["min_max", "max_max"]}]}}})";
    return build_scene(folder.read(text, changes));
  };
  for (const std::string solver : {"newton", "auto"}) {
    EXPECT_EQ(built({"stretch_limit.solver=" + solver}).settings.steps_per_frame, 1);
    EXPECT_EQ(built({"stretch_limit.solver=" + solver}).settings.max_substeps, kAutoSubsteps);
  }
  EXPECT_EQ(built({"obstacles.floor.shape={\"type\":\"half_space\",\"offset\":-5}"}).settings.steps_per_frame, 8);
  EXPECT_EQ(built({"bodies.cloth.self_contact=true"}).settings.steps_per_frame, 8);
  EXPECT_EQ(built({R"(integrator={"type": "verlet", "damping": 0.01})"}).settings.steps_per_frame, 8)
      << "damping acts on each step";
  EXPECT_EQ(built({R"(integrator={"type": "verlet", "damping": 0.01})"}).settings.max_substeps, 1);
  const std::string second = R"(bodies.other={"shape": {"type": "cloth", "size": [1, 1], "resolution": [2, 2]}, "mass": 1,
      "place": {"position": [0, 0, 1]}, "springs": {"structural": {"stiffness": 0}})";
  EXPECT_EQ(built({second + "}"}).settings.steps_per_frame, 8);
  EXPECT_EQ(built({second + R"(, "body_contact": false})"}).settings.steps_per_frame, 1);
}

// Contact of a cloth that falls on an obstacle does not need the small steps that passes need.
TEST(StepChoice, AutoUsesInnerSubstepsForPassesWhereContactIsPossible) {
  const auto built = [](int side, const std::vector<std::string>& changes = {}) {
    const SceneFolder folder;
    const std::string text = R"({"duration": 1, "frame_rate": 60, "stretch_limit": {"max_stretch": 0.02},
        "obstacles": {"floor": {"shape": {"type": "half_space", "offset": -5}}},
        "bodies": {"cloth": {"shape": {"type": "cloth", "size": [1, 1], "resolution": [16, 16]}, "mass": 1,
        "springs": {"structural": {"stiffness": 0}}}}})";
    std::vector<std::string> all = changes;
    all.push_back("bodies.cloth.shape.resolution=[" + std::to_string(side) + "," + std::to_string(side) + "]");
    return build_scene(folder.read(text, all)).settings;
  };
  for (const int side : {64, 128}) {
    EXPECT_EQ(built(side).steps_per_frame, 4) << "1/240 s, as without a limit";
    // The step that passes suggest is inversely proportional to the square root of the load, which grows with the side.
    const double suggested = built(side, {"obstacles={}", "stretch_limit.solver=gauss_seidel"}).steps_per_frame;
    EXPECT_NEAR(built(side).inner_substeps, suggested / 1.15 / 4, 1.0) << side;
  }
  EXPECT_GT(built(128).inner_substeps, built(64).inner_substeps);
  EXPECT_EQ(built(64, {"obstacles={}"}).inner_substeps, 1) << "nothing to find";
  EXPECT_EQ(built(64, {R"(integrator={"type": "implicit_euler"})"}).inner_substeps, 1);
  EXPECT_EQ(built(64, {R"(integrator={"type": "verlet", "damping": 0.01})"}).inner_substeps, 1) << "damping acts on each step";
  EXPECT_EQ(built(64, {"step=0.0005208333333333333"}).inner_substeps, 1) << "the step is given";
}

// Contact of a body that falls on an obstacle does not need the small steps that its springs need either.
TEST(StepChoice, AutoUsesInnerSubstepsForStiffSpringsWhereContactIsPossible) {
  const auto built = [](double stiffness, const std::vector<std::string>& changes = {}) {
    const SceneFolder folder;
    const std::string text =
        R"({"duration": 1, "frame_rate": 60, "obstacles": {"floor": {"shape": {"type": "half_space", "offset": -5}}},
        "bodies": {"rope": {"shape": {"type": "rope", "from": [0, 0, 0], "to": [1, 0, 0], "particles": 11}, "mass": 0.11,
        "springs": {"structural": {"stiffness": 100}}}}})";
    std::vector<std::string> all = changes;
    all.push_back("bodies.rope.springs.structural.stiffness=" + std::to_string(stiffness));
    return build_scene(folder.read(text, all)).settings;
  };
  for (const double stiffness : {2.0e4, 2.0e5}) {
    const SimulatorSettings settings = built(stiffness);
    EXPECT_EQ(settings.steps_per_frame, 4) << "1/240 s";
    // What forces bear without contact.
    const SimulatorSettings free = built(stiffness, {"obstacles={}"});
    EXPECT_EQ(free.inner_substeps, 1);
    EXPECT_LE(settings.longest_substep(), free.step * (1.0 + 1e-12)) << stiffness;
    EXPECT_GT(settings.longest_substep(), 0.8 * free.step) << stiffness;
  }
  // 64 inner substeps are the most; more contact steps follow.
  const SimulatorSettings stiffest = built(2.0e9);
  EXPECT_GT(stiffest.steps_per_frame, 4);
  EXPECT_LE(stiffest.longest_substep(), built(2.0e9, {"obstacles={}"}).step * (1.0 + 1e-12));
  EXPECT_EQ(built(2.0e4, {R"(integrator={"type": "implicit_euler"})"}).inner_substeps, 1);
  EXPECT_EQ(built(2.0e4, {"bodies.rope.self_contact=true"}).inner_substeps, 1) << "no gap between layers";
  EXPECT_GT(built(2.0e4, {"bodies.rope.self_contact=true", "bodies.rope.thickness=0.01"}).inner_substeps, 1);
  EXPECT_EQ(built(2.0e4, {R"(stretch_limit={"max_stretch": 0.02})"}).inner_substeps, 1) << "Newton's method solves for the rope";
  EXPECT_EQ(built(2.0e4, {R"(contact={"response": "penalty", "stiffness": 100, "damping": 0.01})", "bodies.rope.thickness=0.01"})
                .inner_substeps,
            1);
}

// Passes need the substeps. After a handover to the global solve, the whole step suffices.
TEST(StepChoice, AutoUsesSubstepsForPassesThatMayBeReplaced) {
  const auto built = [](const std::vector<std::string>& changes) {
    const SceneFolder folder;
    const std::string text = R"({"duration": 1, "stretch_limit": {"solver": "auto", "iterations": 4},
        "integrator": {"type": "implicit_euler"}, "obstacles": {"floor": {"shape": {"type": "half_space", "offset": -5}}},
        "bodies": {"cloth": {"shape": {"type": "cloth", "size": [1, 1], "resolution": [16, 16]}, "mass": 1,
        "springs": {"structural": {"stiffness": 0}}, "pins": [{"at": "corner", "which": ["min_max", "max_max"]}]}}})";
    return build_scene(folder.read(text, changes));
  };
  const BuiltScene passes = built({"stretch_limit.solver=gauss_seidel"});
  const BuiltScene automatic = built({});
  const int substeps = automatic.settings.max_substeps;
  const int at_least = built({"stretch_limit.solver=newton"}).settings.steps_per_frame;
  EXPECT_EQ(passes.settings.max_substeps, 1);
  EXPECT_GT(substeps, 1);
  EXPECT_GE(automatic.settings.steps_per_frame, at_least);
  EXPECT_LT(automatic.settings.steps_per_frame, 2 * at_least);
  EXPECT_GE(automatic.settings.steps_per_frame * substeps, passes.settings.steps_per_frame);
  EXPECT_LT((automatic.settings.steps_per_frame - 1) * substeps, passes.settings.steps_per_frame);
  const std::string damping = R"(integrator={"type": "verlet", "damping": 0.01})";
  EXPECT_EQ(built({damping}).settings.max_substeps, 1) << "damping acts on each step";
  EXPECT_EQ(built({damping}).settings.steps_per_frame, passes.settings.steps_per_frame);
}

TEST(StepChoice, WithoutAnyBoundAutoIsAtMostTheDocumentedStep) {
  const BuiltScene built = build(0.0);
  EXPECT_TRUE(std::isinf(built.largest_stable_step));
  EXPECT_EQ(built.settings.steps_per_frame, 24);  // 10 frames a second of 24 steps: 1/240 s
}

// A frame is a tenth of a second.
TEST(StepChoice, AutoOfImplicitEulerIsSmallerWithContactOrALimitBesideSprings) {
  const std::string implicit = R"(integrator={"type": "implicit_euler"})";
  EXPECT_EQ(build(1.0e6, {implicit, R"(obstacles.ball={"shape": {"type": "sphere", "radius": 0.1}})"}).settings.steps_per_frame,
            24);
  const std::string newton = R"(stretch_limit={"solver": "newton"})";
  EXPECT_EQ(build(0.0, {implicit, newton}).settings.steps_per_frame, 1);
  EXPECT_EQ(build(1.0e6, {implicit, newton}).settings.steps_per_frame, 24);
}

TEST(StepChoice, AutoOfImplicitEulerIsAFrameOrTheStepOfTheStretchLimit) {
  const std::string implicit = R"(integrator={"type": "implicit_euler"})";
  const BuiltScene free = build(1.0e6, {implicit});
  EXPECT_TRUE(std::isinf(free.largest_stable_step));
  EXPECT_EQ(free.settings.steps_per_frame, 1);
  EXPECT_EQ(build(1.0e6, {implicit, "step=0.1"}).settings.steps_per_frame, 1) << "a given step is never refused";
  const BuiltScene limited =
      build(0.0, {implicit, "bodies.pair.shape.particles=50", "stretch_limit={\"iterations\":1,\"solver\":\"gauss_seidel\"}"});
  EXPECT_GT(limited.settings.steps_per_frame, 1);
  EXPECT_LE(limited.settings.step, StretchLimit(limited.network, *limited.settings.stretch_limit).suggested_step(9.81));
}

TEST(StepChoice, StepBeyondTheStableOneIsRefusedNamingTheLargestPossibleOne) {
  const auto problems = problems_of([] { (void)build(1000.0, {"step=0.1"}); });
  // 2 / sqrt(1000) = 0.0632: the step that "auto" takes is the largest below half of that which divides a frame of 0.1 s, 0.025.
  EXPECT_THAT(problems, ElementsAre(AllOf(Field(&Problem::key, "step"), Field(&Problem::value, "0.1"),
                                          Field(&Problem::rule, HasSubstr("is beyond the largest stable step, 0.06")),
                                          Field(&Problem::remedy, AllOf(HasSubstr("use a step of at most 0.025 s, or \"auto\""),
                                                                        HasSubstr("\"stability\": \"warn\""))))));
  EXPECT_EQ(build(1000.0, {"step=0.05"}).settings.steps_per_frame, 2);
  // 2 / sqrt(8200) = 0.0221: 1 / 120 likewise, told in three digits.
  EXPECT_THAT(problems_of([] {
                (void)build(8200.0, {"frame_rate=30", "step=0.03333333333333333"});
              }),
              ElementsAre(Field(&Problem::remedy, HasSubstr("use a step of at most 0.00833 s, or"))));
}

// The largest stable step is 2 / sqrt(400) = 0.1, as long as two frames at a rate of 20. A frame at a rate of 9 is 0.111.
TEST(StepChoice, AStepThatDividesNoFrameIsRefusedNamingStableOnes) {
  const auto refused = [](const std::vector<std::string>& changes) { return problems_of([&] { (void)build(400.0, changes); }); };
  const auto advice = [](const std::string& text) {
    return ElementsAre(AllOf(Field(&Problem::key, "step"), Field(&Problem::rule, HasSubstr("must divide a frame")),
                             Field(&Problem::remedy, text + ", or \"auto\"")));
  };
  EXPECT_THAT(refused({"frame_rate=25", "step=0.003"}), advice("use 0.00307 or 0.00285"));
  EXPECT_THAT(refused({"frame_rate=20", "step=0.08"}), advice("use 0.05")) << "longer than a frame";
  EXPECT_THAT(refused({"frame_rate=9", "step=0.08"}), advice("use 0.0555"));
  EXPECT_THAT(refused({"step=1e-29"}), advice("use a larger step"));
  EXPECT_THAT(refused({"frame_rate=9", "step=0.105"}),
              ElementsAre(Field(&Problem::rule, HasSubstr("is beyond the largest stable"))));
  EXPECT_THAT(refused({"frame_rate=9", "step=0.105", "stability=warn"}), advice("use 0.111 or 0.0555"));
}

TEST(StepChoice, StepBeyondTheStableOneRunsWithAWarning) {
  const BuiltScene built = build(1000.0, {"step=0.1", "stability=warn"});
  EXPECT_EQ(built.settings.step, 0.1);
  EXPECT_EQ(built.settings.steps_per_frame, 1);
}

TEST(StepChoice, PenaltyContactCountsAsASpringToTheGround) {
  const std::vector<std::string> penalty{"contact={\"response\":\"penalty\",\"stiffness\":300,\"damping\":0}",
                                         "obstacles.floor.shape={\"type\":\"half_space\",\"offset\":-5}"};
  EXPECT_NEAR(build(100.0, penalty).largest_stable_step, 2.0 / std::sqrt(400.0), kBoundSlack * 0.1);
  EXPECT_NEAR(build(100.0, {penalty[0]}).largest_stable_step, 0.2, kBoundSlack * 0.2) << "there is no obstacle";
}

TEST(StepChoice, TooManyStepsAFrameAreRefused) {
  EXPECT_THAT(problems_of([] { (void)build(1e20); }),
              ElementsAre(AllOf(Field(&Problem::key, "step"), Field(&Problem::rule, HasSubstr("too many steps per frame")),
                                Field(&Problem::remedy, HasSubstr("less stiffness")))));
}

TEST(StepChoice, ARefusedExplicitEulerSuggestsAnotherScheme) {
  EXPECT_THAT(problems_of([] { (void)build(1e12, {R"(integrator={"type": "explicit_euler"})"}); }),
              ElementsAre(Field(&Problem::remedy, HasSubstr("symplectic_euler"))));
}

}  // namespace
}  // namespace sprung
