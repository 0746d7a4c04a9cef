// The examples of small systems, run by the program and judged by laws.
#include "example_run.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace sprung {
namespace {

using testing::ExampleRun;
using ::testing::HasSubstr;

// How far the lower of two masses hangs below the upper, less the spring's rest length of 1 m.
double extension(const ExampleRun& run, int frame) {
  const Points x = run.positions("masses", frame);
  EXPECT_EQ(x.col(0), Vector3::Zero()) << "the upper mass is held";
  return (x.col(1) - x.col(0)).norm() - 1.0;
}

TEST(TwoMasses, TheSpringEndsAsLongAsTheWeightAsks) {
  const ExampleRun run("two_masses");
  ASSERT_EQ(run.exit_code(), 0) << run.messages();
  // m g / k. The swing about it began with that amplitude and lost a part 0.01 / 2 of it in each of 3,000 steps: e^-15 remains.
  EXPECT_NEAR(extension(run, run.frames()), 9.81 / 20, 9.81 / 20 * std::exp(-15.0) * 2);
}

TEST(TwoMasses, TheHeavierMassStretchesTheSpringFurther) {
  const ExampleRun light("two_masses");
  const ExampleRun heavy("heavy_mass");
  ASSERT_EQ(heavy.exit_code(), 0) << heavy.messages();
  const double reached = extension(heavy, heavy.frames());
  EXPECT_GT(reached, extension(light, light.frames()));
  EXPECT_NEAR(reached, 3 * 9.81 / 20, 3 * 9.81 / 20 * std::exp(-15.0) * 2);
}

// The sweep of examples/README.md.
TEST(TwoMasses, ASweepEndsEachSpringAsTheReadmeStates) {
  const testing::ScratchFolder scratch;
  const std::string scene = "examples/two_masses.json";
  const std::vector<std::string> options{"--vary", "bodies.masses.particle_mass=0.5,1,2,4", "--vary",
                                         "bodies.masses.springs.structural.stiffness=20,40"};
  const std::string readme = testing::read_text(SPRUNG_SOURCE_DIR "/examples/README.md");
  std::string command = "sprung sweep " + scene;
  for (const std::string& word : options) command += " " + word;
  EXPECT_THAT(readme, HasSubstr("\n" + command + " --out swept\n"));

  std::vector<std::string> words{"sweep", SPRUNG_SOURCE_DIR "/" + scene, "--quiet", "--out", (scratch / "swept").string()};
  words.insert(words.end(), options.begin(), options.end());
  const testing::Ending ending = testing::Program(words).wait();
  ASSERT_EQ(ending.code, 0) << ending.err;
  const testing::Columns results = testing::read_columns(scratch / "swept/results.csv");
  ASSERT_EQ(results.at("number").size(), 8u);
  for (std::size_t run = 0; run < 8; ++run) {
    const double mass = results.at("bodies.masses.particle_mass")[run];
    const double stiffness = results.at("bodies.masses.springs.structural.stiffness")[run];
    const double stretch = mass * 9.81 / stiffness;
    EXPECT_NEAR(results.at("max_stretch")[run], stretch, stretch * std::exp(-15.0) * 2);
    // The swing stretch (1 - exp(-0.5 t) cos(omega t)) of Verlet's damping of 0.01 a step of 0.01 s, half a period after the start,
    // at the nearest of the frames, which are 0.1 s apart.
    const double omega = std::sqrt(stiffness / mass);
    const double half_period = std::numbers::pi / omega;
    EXPECT_GE(results.at("largest_stretch")[run], stretch * (1 + std::exp(-0.5 * (half_period + 0.05)) * std::cos(0.05 * omega)));
    EXPECT_LE(results.at("largest_stretch")[run], stretch * (1 + std::exp(-0.5 * (half_period - 0.05))));
  }
}

// How the energy of the rope differs from that at the start, at most and at the end.
struct EnergyGain {
  double most = 0.0;
  double last = 0.0;
};

EnergyGain energy_gain(const std::string& scheme) {
  const ExampleRun run("six_schemes", {"--set", "integrator.type=" + scheme});
  EXPECT_EQ(run.exit_code(), 0) << run.messages();
  EnergyGain gain;
  for (std::size_t i = 0; i < run.column("frame").size(); ++i) {
    const double energy = run.column("kinetic_energy")[i] + run.column("elastic_energy")[i] + run.column("gravity_energy")[i];
    gain.last = energy - run.column("elastic_energy")[0] - run.column("gravity_energy")[0];
    gain.most = std::max(gain.most, std::abs(gain.last));
  }
  return gain;
}

// The table of energies in examples/README.md. The rope falls a metre: 5 J.
TEST(SixSchemes, TreatEnergyAsTheReadmeStates) {
  EXPECT_EQ(ExampleRun("six_schemes", {"--set", "integrator.type=explicit_euler"}).exit_code(), 4);
  EXPECT_LT(energy_gain("symplectic_euler").most, 0.11);
  EXPECT_LT(energy_gain("verlet").most, 0.11);
  EXPECT_LT(energy_gain("velocity_verlet").most, 0.011);
  EXPECT_NEAR(energy_gain("rk4").last, -0.004, 0.001);
  EXPECT_NEAR(energy_gain("implicit_euler").last, -1.6, 0.05);
}

TEST(TooLargeStep, IsRefusedWithTheLargestStableOne) {
  const ExampleRun run("too_large_step");
  EXPECT_EQ(run.exit_code(), 3);
  EXPECT_THAT(run.messages(), HasSubstr("too_large_step.json"));
  EXPECT_THAT(run.messages(), HasSubstr("step"));
  // 2 / sqrt(k / m) = 0.02 s for one mass that hangs on the other; the bound for any network keeps a margin below it.
  EXPECT_THAT(run.messages(), ::testing::AnyOf(HasSubstr("0.019"), HasSubstr("0.02")));
  EXPECT_FALSE(std::filesystem::exists(run.output())) << "nothing is written";
}

TEST(TooLargeStep, DivergesClearlyWhenOnlyWarnedOf) {
  const ExampleRun run("too_large_step_warned");
  EXPECT_EQ(run.exit_code(), 4);
  for (const char* part : {"diverged", "step", "time", "\"masses\"", "particle 1", "spring 0", "use a step of at most"}) {
    EXPECT_THAT(run.messages(), HasSubstr(part));
  }
}

TEST(TooLargeStep, AStableStepRuns) {
  const ExampleRun run("too_large_step", {"--set", "step=0.0125"});
  EXPECT_EQ(run.exit_code(), 0) << run.messages();
}

// The web page's rope by its own recurrence: x' = x + (1 - 0.005) (x - x_previous) + (F / m) 1^2, beginning at rest.
Points five_nodes_after(int steps) {
  Points x(3, 5);
  for (Index i = 0; i < 5; ++i) x.col(i) = Vector3(3 * i, 0, 0);
  Points before = x;
  for (int step = 0; step < steps; ++step) {
    Points next = x;
    for (Index i = 1; i < 4; ++i) {
      Vector3 force(0, -1, 0);
      for (const Index j : {i - 1, i + 1}) {
        const Vector3 s = x.col(i) - x.col(j);
        force -= (s.norm() - 2.0) * s.normalized();
      }
      next.col(i) += 0.995 * (x.col(i) - before.col(i)) + force / 500;
    }
    before = x;
    x = next;
  }
  return x;
}

TEST(FiveNodeRope, FollowsThePublishedRecurrence) {
  const ExampleRun run("five_node_rope");
  ASSERT_EQ(run.exit_code(), 0) << run.messages();
  ASSERT_EQ(run.frames(), 601);
  for (const int frame : {1, 2, 101, 301, 601}) {
    // Both round positions of size 10 by some 2e-15 a step, which adds up to at most 2e-15 * 600^2 / 2 = 4e-10.
    EXPECT_LT((run.positions("rope", frame) - five_nodes_after(frame - 1)).norm(), 1e-9) << "frame " << frame;
  }
}

TEST(FiveNodeRope, SagsSymmetricallyBetweenItsHeldEnds) {
  const ExampleRun run("five_node_rope");
  const Points x = run.positions("rope", run.frames());
  EXPECT_EQ(x.col(0), Vector3(0, 0, 0));
  EXPECT_EQ(x.col(4), Vector3(12, 0, 0));
  EXPECT_NEAR(x(0, 1) + x(0, 3), 12.0, 1e-9);
  EXPECT_NEAR(x(0, 2), 6.0, 1e-9);
  EXPECT_NEAR(x(1, 1), x(1, 3), 1e-9);
  EXPECT_LT(x(1, 1), 0.0);
  EXPECT_LT(x(1, 2), x(1, 1));
}

class LabRope : public ::testing::Test {
 protected:
  LabRope() : run_("lab_rope") {}
  void SetUp() override { ASSERT_EQ(run_.exit_code(), 0) << run_.messages(); }

  double energy(int frame) const {
    double sum = 0.0;
    for (const char* part : {"kinetic_energy", "elastic_energy", "gravity_energy"}) sum += run_.column(part)[frame - 1];
    return sum;
  }

  ExampleRun run_;
};

TEST_F(LabRope, BeginsAtThePointThatMoves) {
  // Keyframes at 0, 1.5 and 3 s: out by (2, 0.5, 0) and back, smoothly (3 s^2 - 2 s^3), then at rest.
  for (const int frame : {1, 20, 38, 57, 76, 151}) {
    const double time = (frame - 1) / 25.0;
    const double s = std::max(0.0, 1.0 - std::abs(time / 1.5 - 1.0));
    const Vector3 expected = (3 * s * s - 2 * s * s * s) * Vector3(2, 0.5, 0);
    EXPECT_LT((run_.positions("rope", frame).col(0) - expected).norm(), 1e-12) << "at " << time << " s";
  }
}

TEST_F(LabRope, NoParticleIsFartherThanTheSpringsAreLong) {
  for (int frame = 1; frame <= run_.frames(); ++frame) {
    const Points x = run_.positions("rope", frame);
    // The elastic energy E bounds how much n springs are longer than at rest: sum of e <= sqrt(n sum of e^2) = sqrt(n 2 E / k).
    const double elongation = std::sqrt(79 * 2 * run_.column("elastic_energy")[frame - 1] / 10000);
    const double farthest = (x.colwise() - Vector3(x.col(0))).colwise().norm().maxCoeff();
    ASSERT_LE(farthest, 3.95 + elongation + 1e-12) << "frame " << frame;
    ASSERT_EQ(x.row(2).cwiseAbs().maxCoeff(), 0.0) << "nothing pushes it out of its plane";
  }
}

TEST_F(LabRope, LosesEnergyOnceThePointRests) {
  // From 3 s on friction in the springs and the air only take energy; what the scheme's energy swings by within a second is less.
  for (int second = 3; second < 6; ++second) EXPECT_LT(energy(1 + 25 * (second + 1)), energy(1 + 25 * second)) << second << " s";
}

TEST(HangingCloth, HangsBelowItsHeldCornersWithinItsStretchLimit) {
  const ExampleRun run("hanging_cloth");
  ASSERT_EQ(run.exit_code(), 0) << run.messages();
  const Points x = run.positions("cloth", run.frames());
  const Points start = run.positions("cloth", 1);
  const Index corners[] = {31 * 32, 31 * 32 + 31};
  for (const Index corner : corners) EXPECT_EQ(x.col(corner), start.col(corner)) << "held";
  EXPECT_LT(x.row(1).maxCoeff(), 1.2 + 1e-9) << "nothing ends above the corners";
  // Straight down its sides reach 1 m below the corners; wind and what is left of the swing may turn it by acos(0.8) = 37 degrees.
  // Measured: 1.05 m, as its middle sags.
  EXPECT_LE(x.row(1).minCoeff(), 1.2 - 0.8) << "it has swung down";
  for (int frame = 1; frame <= run.frames(); ++frame) {
    const double excess = run.column("stretch_excess")[frame - 1];
    ASSERT_LE(run.column("max_stretch")[frame - 1], 0.02 + excess + 1e-12) << "frame " << frame << " stretches as reported";
    // 64 passes do not always reach the tolerance. Measured: 0.0054 at most; half the limit leaves nearly a factor of two.
    ASSERT_LT(excess, 0.01) << "frame " << frame << " keeps the limit but for half of it";
  }
}

// Drag of the area A at the angle a from the wind u balances the weight: normal (u sin a)^2 A = m g cos a, where u = 9.2 m/s gives
// an angle of 8 degrees below the wind for silk of 0.104 kg/m^2. Gusts of 2 m/s (root mean square) turn it further.
TEST(FlagInGusts, HangsInCalmAirAndFliesInTheWind) {
  const ExampleRun run("flag_in_gusts");
  ASSERT_EQ(run.exit_code(), 0) << run.messages();
  const int columns = 31;
  const int rows = 21;
  const Points start = run.positions("flag", 1);
  std::vector<double> reach;
  std::vector<double> swing;
  for (int frame = 1; frame <= run.frames(); ++frame) {
    const Points x = run.positions("flag", frame);
    Vector3 free_border = Vector3::Zero();
    for (int row = 0; row < rows; ++row) {
      ASSERT_EQ(Vector3(x.col(row * columns)), Vector3(start.col(row * columns))) << "frame " << frame << ": held at the pole";
      free_border += Vector3(x.col(row * columns + columns - 1) - x.col(row * columns)) / rows;
    }
    ASSERT_GT(x.row(1).minCoeff(), 0.0) << "frame " << frame << ", above the floor";
    reach.push_back(free_border.x());
    swing.push_back(free_border.z());
  }
  EXPECT_LT(*std::min_element(reach.begin() + 15, reach.begin() + 60), 0.75) << "half of its length: it hangs";
  double flying = 0.0;
  for (int frame = 121; frame <= run.frames(); ++frame) flying += reach[frame - 1] / (run.frames() - 120);
  EXPECT_GT(flying, 1.2) << "it flies";
  const auto [least, most] = std::minmax_element(swing.begin() + 120, swing.end());
  EXPECT_GT(*most - *least, 0.1) << "it flutters";
  // The fastest wind and three times the gusts: no part of the flag gets faster on the whole.
  const double speed = std::hypot(9.0, 2.0) + 3.0 * 2.0;
  const double mass = 0.1043 * 1.5 * 1.0;
  for (const double energy : run.column("kinetic_energy")) EXPECT_LT(energy, 0.5 * mass * speed * speed);
}

TEST(RopeOverTorus, LiesOverTheTorusAndOutsideIt) {
  const ExampleRun run("rope_over_torus");
  ASSERT_EQ(run.exit_code(), 0) << run.messages();
  // The mesh has its vertices on a torus (ring 0.5, tube 0.15) of 48 by 20: it lies within it, by no more than the sagittas of its
  // sides, 0.65 (1 - cos(pi / 48)) + 0.15 (1 - cos(pi / 20)) < 0.0033. Nearer than 0.1467 to the ring is inside.
  for (int frame = 1; frame <= run.frames(); ++frame) {
    const Points positions = run.positions("rope", frame);
    for (const auto& x : positions.colwise()) {
      ASSERT_GT(std::hypot(std::hypot(x[0], x[2]) - 0.5, x[1]), 0.1467) << "frame " << frame;
      ASSERT_GT(x[1], -0.15) << "frame " << frame << ", above the floor";
    }
  }
  const Points x = run.positions("rope", run.frames());
  EXPECT_GT(x.row(1).maxCoeff(), 0.15) << "it lies on the ring";
  EXPECT_LT(x(1, 0), 0.0) << "an end hangs down outside";
  EXPECT_LT(x(1, 120), 0.0) << "the other end too";
  EXPECT_GT(run.column("contacts").back(), 0);
}

}  // namespace
}  // namespace sprung
