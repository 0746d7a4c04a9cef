// The rules by which steps are divided and repeated, as a table, and the planner's memory over many steps.
#include "simulation/step/step_planner.h"

#include "simulation/scenes.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace sprung {
namespace {

using Solver = StretchLimitSettings::Solver;

/// A limp cloth of 4 x 4 particles that hangs from two corners.
SpringNetwork limp_cloth() {
  SpringNetwork network = testing::cloth(4, 0.0);
  network.springs.stiffness.assign(network.springs.stiffness.size(), 0.0);
  network.springs.damping.assign(network.springs.damping.size(), 0.0);
  network.pins.push_back({.particles = {12, 15}, .origin = Vector3::Zero(), .motion = {}});
  for (const Index i : network.pins[0].particles) network.inverse_masses[i] = 0.0;
  return network;
}

/// A wanted excess of 0.01 by any solver: with passes alone and with Newton's method alone neither awaits the other.
StretchLimitSettings limit_of(Solver solver) {
  StretchLimitSettings limit{.max_stretch = 0.0, .iterations = 1, .tolerance = 0.01, .solver = solver};
  if (solver == Solver::gauss_seidel) limit.max_compression = 0.0;
  return limit;
}

/// A planner of steps with at most eight substeps, and its state.
class Planned {
 public:
  explicit Planned(std::optional<Solver> solver, int max_substeps = 8, int inner_substeps = 1, bool forces_need_inner = false)
      : network_(limp_cloth()), state_(initial_state(network_)) {
    SimulatorSettings settings{.max_substeps = max_substeps, .inner_substeps = inner_substeps};
    if (solver) limit_.emplace(network_, limit_of(*solver), LimitUse{.may_collide = true});
    planner_.emplace(network_, settings, limit_ ? &*limit_ : nullptr, forces_need_inner);
    planner_->start(false, state_);
  }

  /// Makes a step in which attempt k has the report `reports[k]`, the last of them for all others; returns the attempts.
  std::vector<StepTrial> step(const std::vector<StepReport>& reports, double rotation = 0.0, double gain_of_trial = 0.0) {
    std::vector<StepTrial> tried;
    for (std::optional<StepPlan> plan = planner_->first(state_, rotation); plan; plan = planner_->next(tried, state_)) {
      StepTrial& trial =
          tried.emplace_back(StepTrial{.plan = *plan, .report = reports[std::min(tried.size(), reports.size() - 1)]});
      trial.is_complete = trial.report.max_infeasible < plan->abandon_at;
      trial.body_excess = plan->trial ? 1.0 - gain_of_trial : 1.0;
    }
    best_ = planner_->best(tried);
    ++state_.step;
    planner_->learn(tried, state_);
    return tried;
  }

  /// The number of attempts at a step that leaves these infeasible particles at first and when it is repeated.
  std::size_t attempts(Index infeasible, Index when_repeated) {
    return step({infeasible_report(infeasible), infeasible_report(when_repeated)}).size();
  }

  static StepReport infeasible_report(Index count) { return {.infeasible = count, .max_infeasible = count}; }

  [[nodiscard]] SimulationState& state() { return state_; }
  [[nodiscard]] std::size_t best() const { return best_; }

 private:
  SpringNetwork network_;
  SimulationState state_;
  std::optional<StretchLimit> limit_;
  std::optional<StepPlanner> planner_;
  std::size_t best_ = 0;
};

struct Row {
  std::string name;
  std::optional<Solver> solver;
  int substeps = 1;  ///< at the begin of the step
  double rotation = 0.0;
  double excess = 0.0;
  double deformation = 0.0;  ///< of a substep
  std::vector<Index> infeasible{0};
  std::vector<int> plans;  ///< substeps of the attempts
  std::vector<PlanReason> reasons;
  int next_substeps = 1;
};

TEST(StepPlanner, FollowsItsTable) {
  using enum PlanReason;
  const std::optional<Solver> none;
  const auto passes = Solver::gauss_seidel;
  const auto newton = Solver::newton;
  const std::vector<Row> rows{
      {.name = "no limit", .solver = none, .plans = {1}, .reasons = {first}, .next_substeps = 1},
      // Rotation: 45 degrees a substep, at most 64 times the substeps.
      {.name = "45 degrees", .solver = none, .rotation = 45.0, .plans = {1}, .reasons = {first}, .next_substeps = 1},
      {.name = "46 degrees", .solver = none, .rotation = 46.0, .plans = {2}, .reasons = {rotation}, .next_substeps = 1},
      {.name = "many rotations", .solver = none, .rotation = 1e9, .plans = {64}, .reasons = {rotation}, .next_substeps = 1},
      // Excess: three times the wanted 0.01 halves the substeps, each factor of two once more.
      {.name = "excess below", .solver = passes, .excess = 0.029, .plans = {1}, .reasons = {first}, .next_substeps = 1},
      {.name = "excess above", .solver = passes, .excess = 0.031, .plans = {1}, .reasons = {first}, .next_substeps = 2},
      {.name = "twice the bound", .solver = passes, .excess = 0.061, .plans = {1}, .reasons = {first}, .next_substeps = 4},
      {.name = "far above", .solver = passes, .excess = 1.0, .plans = {1}, .reasons = {first}, .next_substeps = 8},
      {.name = "again", .solver = passes, .substeps = 2, .excess = 0.031, .plans = {2}, .reasons = {excess}, .next_substeps = 4},
      // Deformation: a seventieth a substep, of the whole step.
      {.name = "below 1/70", .solver = newton, .deformation = 1.0 / 71, .plans = {1}, .reasons = {first}, .next_substeps = 1},
      {.name = "above 1/70", .solver = newton, .deformation = 1.0 / 69, .plans = {1}, .reasons = {first}, .next_substeps = 2},
      {.name = "two of 1/69",
       .solver = newton,
       .substeps = 2,
       .deformation = 1.0 / 69,
       .plans = {2},
       .reasons = {excess},
       .next_substeps = 3},
      {.name = "three of 1/106",
       .solver = newton,
       .substeps = 3,
       .deformation = 1.0 / 106,
       .plans = {3},
       .reasons = {excess},
       .next_substeps = 2},
      {.name = "still", .solver = newton, .substeps = 8, .plans = {8}, .reasons = {excess}, .next_substeps = 1},
      {.name = "far", .solver = newton, .deformation = 10.0, .plans = {1}, .reasons = {first}, .next_substeps = 8},
      {.name = "not a number", .solver = newton, .deformation = std::nan(""), .plans = {1}, .reasons = {first}, .next_substeps = 1},
      // Infeasible particles: 4, 16 and 64 times the substeps while each attempt halves them.
      {.name = "repeated once",
       .solver = none,
       .infeasible = {4, 0},
       .plans = {1, 4},
       .reasons = {first, infeasible},
       .next_substeps = 1},
      {.name = "halved twice",
       .solver = none,
       .infeasible = {4, 1, 0},
       .plans = {1, 4, 16},
       .reasons = {first, infeasible, infeasible},
       .next_substeps = 1},
      {.name = "never",
       .solver = none,
       .infeasible = {4},
       .plans = {1, 4, 16, 64},
       .reasons = {first, infeasible, infeasible, infeasible},
       .next_substeps = 1},
      {.name = "after rotation",
       .solver = none,
       .rotation = 200.0,
       .infeasible = {4, 0},
       .plans = {5, 16},
       .reasons = {rotation, infeasible},
       .next_substeps = 1},
  };
  for (const Row& row : rows) {
    SCOPED_TRACE(row.name);
    Planned planned(row.solver);
    planned.state().substeps = row.substeps;
    planned.state().planner.reason = excess;
    std::vector<StepReport> reports;
    for (const Index count : row.infeasible) {
      reports.push_back(
          {.stretch_excess = row.excess, .infeasible = count, .max_infeasible = count, .deformation = row.deformation});
    }
    std::vector<int> plans;
    std::vector<PlanReason> reasons;
    for (const StepTrial& trial : planned.step(reports, row.rotation)) {
      plans.push_back(trial.plan.substeps());
      reasons.push_back(trial.plan.reason);
      EXPECT_EQ(trial.plan.global_limit, trial.plan.reason != infeasible);
    }
    EXPECT_EQ(plans, row.plans);
    EXPECT_EQ(reasons, row.reasons);
    EXPECT_EQ(planned.state().substeps, row.next_substeps);
  }
}

TEST(StepPlanner, AsksForNoMoreSubstepsThanTheSettingsPermit) {
  Planned planned(Solver::gauss_seidel, 4);
  planned.step({{.stretch_excess = 1.0}});
  EXPECT_EQ(planned.state().substeps, 4);
}

TEST(StepPlanner, DoublesSubstepsAfterEightCalmStepsInARow) {
  const auto after = [](const std::vector<double>& excesses) {
    Planned planned(Solver::gauss_seidel);
    planned.state().substeps = 4;
    for (const double excess : excesses) planned.step({{.stretch_excess = excess}});
    return planned.state().substeps;
  };
  std::vector<double> calm(7, 0.007);  // below a quarter of the bound of 0.03
  EXPECT_EQ(after(calm), 4);
  calm.push_back(0.007);
  EXPECT_EQ(after(calm), 2);
  calm[3] = 0.008;
  EXPECT_EQ(after(calm), 4) << "a step in between was not calm enough";
  EXPECT_EQ(after(std::vector<double>(30, 0.0)), 1);
}

// Repetitions.

TEST(StepPlanner, KeepsTheAttemptWithTheFewestInfeasibleParticles) {
  Planned planned(std::nullopt);
  EXPECT_EQ(planned
                .step({Planned::infeasible_report(5), Planned::infeasible_report(3), Planned::infeasible_report(2),
                       Planned::infeasible_report(1)})
                .size(),
            4U);
  EXPECT_EQ(planned.best(), 2U) << "3 is not half of 5, 1 is not less than half of 2";
}

// Up to one contact step for each inner substep.
TEST(StepPlanner, RepeatsAStepInWhichTruncationStrainsASpringByATenth) {
  const auto contact_steps = [](int inner, const std::vector<double>& strains) {
    Planned planned(std::nullopt, 1, inner);
    std::vector<StepReport> reports;
    for (const double strain : strains) reports.push_back({.truncated = 1, .truncation_strain = strain});
    std::vector<int> steps;
    for (const StepTrial& trial : planned.step(reports)) {
      steps.push_back(trial.plan.contact_steps);
      EXPECT_GE(trial.plan.substeps(), inner);
    }
    EXPECT_EQ(planned.best() + 1, steps.size());
    return steps;
  };
  using ::testing::ElementsAre;
  EXPECT_THAT(contact_steps(20, {0.09}), ElementsAre(1));
  EXPECT_THAT(contact_steps(20, {0.11, 0.09}), ElementsAre(1, 4));
  EXPECT_THAT(contact_steps(20, {0.11}), ElementsAre(1, 4, 16));
  EXPECT_THAT(contact_steps(15, {0.11}), ElementsAre(1, 4));
  EXPECT_THAT(contact_steps(2, {0.11}), ElementsAre(1, 4));
  EXPECT_THAT(contact_steps(1, {0.11}), ElementsAre(1));
}

// A global solve needs no inner substeps. Forces keep theirs, also where a repeated step has more contact steps.
TEST(StepPlanner, LetsNoSubstepBeLongerThanForcesBear) {
  const auto inner = [](bool forces_need_inner) {
    Planned planned(Solver::newton, 8, 6, forces_need_inner);
    return planned.step({Planned::infeasible_report(2), Planned::infeasible_report(0)});
  };
  EXPECT_EQ(inner(false).front().plan.inner, 1);
  const std::vector<StepTrial> tried = inner(true);
  ASSERT_EQ(tried.size(), 2u);
  EXPECT_EQ(tried[0].plan.inner, 6);
  EXPECT_GE(tried[1].plan.substeps(), 6);
}

TEST(StepPlanner, RepeatsMoreRarelyWhileItDoesNotHelp) {
  const auto repeated_in = [](int steps) {
    Planned planned(std::nullopt);
    int repeated = 0;
    for (int step = 0; step < steps; ++step) repeated += planned.attempts(2, 2) > 1 ? 1 : 0;
    return repeated;
  };
  for (int steps = 64; steps <= 1024; steps *= 2) {
    EXPECT_EQ(repeated_in(2 * steps), repeated_in(steps) + 1) << "each pause is as long as all previous steps, " << steps;
  }
}

TEST(StepPlanner, RepeatsAllStepsWhileItHelps) {
  Planned planned(std::nullopt);
  for (int step = 0; step < 100; ++step) ASSERT_GT(planned.attempts(4, 1), 1U) << step;
}

TEST(StepPlanner, RepeatsStepsWithMoreInfeasibleParticlesThanBefore) {
  Planned planned(std::nullopt);
  for (int step = 0; step < 100; ++step) planned.attempts(2, 2);
  EXPECT_EQ(planned.attempts(2, 2), 1U);
  EXPECT_GT(planned.attempts(3, 3), 1U);
}

TEST(StepPlanner, ForgetsFormerFailures) {
  Planned planned(std::nullopt);
  for (int step = 0; step < 5000; ++step) planned.attempts(2, 2);
  ASSERT_EQ(planned.attempts(2, 2), 1U);
  for (int step = 0; step < 80; ++step) planned.attempts(0, 0);  // more than 4 and a 16th of the longest wait of 1,024
  EXPECT_GT(planned.attempts(2, 2), 1U);
}

// The wait doubles up to 1,024 steps, and ends only after more than 4 feasible steps in a row: log2(2,000) = 11 repetitions.
TEST(StepPlanner, RepeatsRarelyIfEveryOtherStepIsInfeasible) {
  Planned planned(std::nullopt);
  int repeated = 0;
  for (int pair = 0; pair < 1000; ++pair) {
    repeated += planned.attempts(2, 2) > 1 ? 1 : 0;
    planned.attempts(0, 0);
  }
  EXPECT_LE(repeated, 12);
}

// Trials of solvers. The cloth may be handed over, and its positions miss the limit by 0.02.

class SolverTrials : public ::testing::Test {
 protected:
  SolverTrials() { planned_.state().x *= 1.02; }

  /// The number of steps until a solver is tried. The trial removes `gain` of the excess, and leaves `infeasible` particles.
  int steps_to_trial(double gain, Index infeasible = 0) {
    for (int step = 1; step < 1000; ++step) {
      const std::vector<StepReport> reports{{.stretch_excess = 0.02}, {.stretch_excess = 0.02, .max_infeasible = infeasible}};
      const std::vector<StepTrial> tried = planned_.step(reports, 0.0, gain);
      const auto& trial = tried.back().plan.trial;
      if (!trial) continue;
      last_ = tried.back();
      if (planned_.best() + 1 == tried.size()) {
        planned_.state().limit.handovers[0].solved_since = trial->newton ? std::optional(planned_.state().step) : std::nullopt;
      }
      return step;
    }
    return 0;
  }

  Planned planned_{Solver::automatic, 1};
  StepTrial last_;
};

TEST_F(SolverTrials, AreDueAfterMissedStepsInARowAndWaitTwiceAsLongIfTheyDoNotHelp) {
  EXPECT_EQ(steps_to_trial(0.0), kFirstPatience + 1);
  EXPECT_EQ(steps_to_trial(0.0), 2 * kFirstPatience) << "the step of the trial counts";
  planned_.state().x /= 1.02;
  planned_.step({{.stretch_excess = 0.02}});
  planned_.state().x *= 1.02;
  EXPECT_EQ(steps_to_trial(0.0), 4 * kFirstPatience + 1) << "the step without excess counts from the start";
}

TEST_F(SolverTrials, ChangeTheSolverIfNewtonLeavesFourFifthsOrPassesAsMuch) {
  steps_to_trial(0.19);
  EXPECT_TRUE(last_.plan.trial->newton);
  EXPECT_EQ(planned_.best(), 0U) << "0.81 of the excess";
  steps_to_trial(0.21);
  EXPECT_EQ(planned_.best(), 1U);
  EXPECT_EQ(planned_.state().limit.handovers[0].patience, kFirstPatience);
  steps_to_trial(-0.01);
  EXPECT_FALSE(last_.plan.trial->newton);
  EXPECT_EQ(planned_.best(), 0U) << "1.01 of the excess";
  steps_to_trial(0.0);
  EXPECT_EQ(planned_.best(), 1U);
}

TEST_F(SolverTrials, AreAbandonedWhereTheyLeaveMoreParticlesInfeasible) {
  steps_to_trial(0.5, 1);
  EXPECT_FALSE(last_.is_complete);
  EXPECT_EQ(planned_.best(), 0U);
}

// Passes alone made the step that is kept, so that there is nothing to compare. The trial is due until a step is not repeated.
TEST_F(SolverTrials, MakeTheSameStepAsTheAttemptThatTheyAreComparedWith) {
  for (int step = 0; step < kFirstPatience; ++step) planned_.step({{.stretch_excess = 0.02}});
  const auto with = [](Index infeasible) { return StepReport{.stretch_excess = 0.02, .max_infeasible = infeasible}; };
  for (const StepTrial& trial : planned_.step({with(4), with(1), with(0)})) EXPECT_FALSE(trial.plan.trial);
  const std::vector<StepTrial> tried = planned_.step({with(0)}, 100.0);
  ASSERT_EQ(tried.size(), 2U);
  EXPECT_TRUE(tried[1].plan.trial);
  EXPECT_EQ(tried[1].plan.substeps(), tried[0].plan.substeps());
  EXPECT_EQ(tried[1].plan.substeps(), 3);
}

TEST(StepPlanner, CountsMissedStepsPerBody) {
  NetworkBuilder builder;
  const SpringMaterials materials{.structural = SpringMaterial{}, .shear = {}, .bend = {}};
  for (const char* name : {"first", "second"}) {
    BodyShape shape = make_cloth({.size = {1.0, 1.0}, .resolution = {3, 3}}, materials);
    set_total_mass(shape, 0.2);
    builder.add_body(name, shape);
  }
  const SpringNetwork network = builder.build();
  const StretchLimit limit(network, limit_of(Solver::automatic), {.may_collide = true});
  const StepPlanner planner(network, {}, &limit, false);
  SimulationState state = initial_state(network);
  state.x.rightCols(9) *= 1.5;
  const StepTrial trial{.plan = {}, .report = {.stretch_excess = limit.excess(state.x)}};
  for (int step = 0; step < kFirstPatience; ++step) planner.learn({&trial, 1}, state);
  EXPECT_EQ(planner.body_to_compare(state), 1);
}

}  // namespace
}  // namespace sprung
