// Random scenes hold their laws. A seed and a scheme make a scene; see random_scene.h.
//
// SPRUNG_RANDOM_SCENES=137 or SPRUNG_RANDOM_SCENES=1-500 chooses the seeds. The blocks of a scheme share them evenly, so that they
// run side by side with ctest --parallel. A failure prints how to repeat its scene alone.
//
// known_failures.txt lists scenes that do not hold. One that holds again must leave the list.
#include "scenarios/random_scene.h"

#include "base/error.h"
#include "base/parallel.h"
#include "simulation/step/step_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <map>
#include <ostream>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace sprung::testing {
namespace {

struct Seeds {
  std::uint64_t first = 1;
  std::uint64_t last = 50;
};

constexpr std::uint64_t kBlocks = 10;  // of each scheme: blocks of 50 of the seeds 1 to 500

Seeds chosen_seeds() {
  const char* text = std::getenv("SPRUNG_RANDOM_SCENES");
  if (text == nullptr) return {};
  char* end = nullptr;
  const std::uint64_t first = std::strtoull(text, &end, 10);
  const std::uint64_t last = *end == '-' ? std::strtoull(end + 1, &end, 10) : first;
  if (*end != '\0' || end == text || last < first) throw std::invalid_argument("SPRUNG_RANDOM_SCENES must be N or FIRST-LAST");
  return {first, last};
}

struct Block {
  std::string scheme;
  IntegratorSettings integrator;
  std::uint64_t number = 0;

  [[nodiscard]] std::string name() const { return scheme + "_" + std::to_string(number); }
};

std::ostream& operator<<(std::ostream& stream, const Block& block) { return stream << block.name(); }

std::vector<Block> all_blocks() {
  std::vector<Block> blocks;
  for (std::uint64_t number = 0; number < kBlocks; ++number) {
    blocks.push_back({"explicit_euler", ExplicitEulerSettings{}, number});
    blocks.push_back({"symplectic_euler", SymplecticEulerSettings{}, number});
    blocks.push_back({"verlet", VerletSettings{}, number});
    blocks.push_back({"velocity_verlet", VelocityVerletSettings{}, number});
    blocks.push_back({"rk4", RungeKutta4Settings{}, number});
    blocks.push_back({"implicit_euler", ImplicitEulerSettings{}, number});
  }
  return blocks;
}

using SchemeAndSeed = std::pair<std::string, std::uint64_t>;

/// What is known of scenes that do not hold.
std::map<SchemeAndSeed, std::string> known_failures() {
  std::map<SchemeAndSeed, std::string> known;
  std::ifstream file(std::filesystem::path(SPRUNG_SOURCE_DIR) / "tests" / "scenarios" / "known_failures.txt");
  EXPECT_TRUE(file);
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line.front() == '#') continue;
    std::istringstream words(line);
    SchemeAndSeed scene;
    std::string what;
    words >> scene.first >> scene.second;
    EXPECT_TRUE(words) << line;
    std::getline(words >> std::ws, what);
    known[scene] = what;
  }
  return known;
}

/// What breaks the law of the scene; empty if it holds.
std::string broken_law(const RandomScene& made) {
  // A limit for what hangs. The slowest scenes take seconds.
  constexpr double kLongest = 120.0;  // [s] of processor time
  const std::clock_t begin = std::clock();
  const auto stops = [&] { return static_cast<double>(std::clock() - begin) > kLongest * CLOCKS_PER_SEC; };
  std::ostringstream wrong;
  try {
    const ScenarioReport report = run_until_divergence(made.scene, {}, made.judge, stops);
    const bool excused =
        made.law == Law::reported && report.first_infeasible_frame > 0 && report.first_infeasible_frame <= report.first_wrong_frame;
    if (!report.is_free() && !excused) wrong << "crosses: ";
    if (made.law == Law::feasible && report.infeasible > 0) wrong << "infeasible: ";
    if (report.divergence && must_not_diverge(made.scene)) wrong << "diverges: " << StepError(*report.divergence).what() << ": ";
    if (made.keeps_cells && !report.divergence && report.inverted > 0) wrong << "inverts cells: ";
    if (!wrong.str().empty()) wrong << report;
  } catch (const StoppedError&) {
    wrong << "takes longer than " << kLongest << " s";
  }
  return wrong.str();
}

class RandomScenes : public ::testing::TestWithParam<Block> {};

TEST_P(RandomScenes, HoldTheirLaws) {
  const Block& block = GetParam();
  const ThreadLimit one_thread(1);  // the blocks run side by side
  const std::map<SchemeAndSeed, std::string> known = known_failures();
  const Seeds seeds = chosen_seeds();
  const std::uint64_t count = seeds.last - seeds.first + 1;
  const std::uint64_t begin = seeds.first + count * block.number / kBlocks;
  const std::uint64_t end = seeds.first + count * (block.number + 1) / kBlocks;
  for (std::uint64_t seed = begin; seed < end; ++seed) {
    const RandomScene made = random_scene(seed, block.integrator);
    const auto listed = known.find({block.scheme, seed});
    const std::string wrong = broken_law(made);
    EXPECT_TRUE(wrong.empty() || listed != known.end())
        << block.scheme << " " << seed << " " << wrong << "\nof " << made.kind << ". To repeat: SPRUNG_RANDOM_SCENES=" << seed
        << " build/release/bin/scenarios_tests --gtest_filter='*RandomScenes.HoldTheirLaws/" << block.scheme << "_*'";
    EXPECT_FALSE(wrong.empty() && listed != known.end())
        << block.scheme << " " << seed << " holds again: remove it from tests/scenarios/known_failures.txt";
  }
}

// What is not drawn is not tested.
TEST(RandomSceneTest, SeedsDrawEverything) {
  std::set<std::string> kinds;
  std::set<std::string> seen;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const RandomScene made = random_scene(seed, RungeKutta4Settings{});
    const BuiltScene& scene = made.scene;
    kinds.insert(made.kind.substr(0, made.kind.find(" and a pin")));
    seen.insert(scene.settings.sleep ? "sleep" : "no sleep");
    if (is_unstable(scene.settings.step, scene.largest_stable_step)) seen.insert("unstable step");
    for (Index s = 0; s < scene.network.springs.count(); ++s) {
      const SpringLaw law = scene.network.springs.law(s);
      if (law.yields()) seen.insert("yield");
      if (law.breaks()) seen.insert("break");
    }
    for (const Pin& pin : scene.network.pins) {
      if (pin.from > 0.0) seen.insert("pin that begins");
      if (std::isfinite(pin.until)) seen.insert("pin that ends");
      if (pin.holds_always()) seen.insert("pin that stays");
      if (pin.obstacle != kNone) seen.insert("pin that follows");
      if (pin.motion.moves()) seen.insert("pin that moves");
    }
    for (const Attachment& attachment : scene.network.attachments) seen.insert(attachment.is_rigid() ? "rod" : "spring");
  }
  EXPECT_EQ(kinds.size(), 10U);
  EXPECT_THAT(seen, ::testing::UnorderedElementsAre("sleep", "no sleep", "unstable step", "yield", "break", "pin that begins",
                                                    "pin that ends", "pin that stays", "pin that follows", "pin that moves", "rod",
                                                    "spring"));
}

INSTANTIATE_TEST_SUITE_P(Blocks, RandomScenes, ::testing::ValuesIn(all_blocks()),
                         [](const ::testing::TestParamInfo<Block>& block) { return block.param.name(); });

}  // namespace
}  // namespace sprung::testing
