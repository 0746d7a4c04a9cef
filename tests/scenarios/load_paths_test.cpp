// Rods, stretch limits, heavy and light bodies together: what pins carry, and that nothing gains energy.
#include "base/format.h"
#include "base/test_seed.h"
#include "collision/sample_meshes.h"
#include "scenarios/scenario.h"
#include "scene/reading/scene_reader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace sprung::testing {
namespace {

using test::Random;

// Of the weight, and of the largest kinetic plus elastic energy: what users may rely on.
constexpr double kOfWeight = 0.02;
constexpr double kOfEnergy = 0.01;

std::string vector_text(double x, double y, double z) { return json_text({x, y, z}); }

std::string rope(const std::string& name, const std::string& from, const std::string& to, Index particles,
                 const std::string& pins) {
  return "\"" + name + R"(": { "shape": { "type": "rope", "from": )" + from + R"(, "to": )" + to + R"(, "particles": )" +
         std::to_string(particles) + R"( }, "material": "nylon", "pins": [)" + pins + "] }";
}

std::string crate(const std::string& name, const std::string& at, double size, double density) {
  const std::string side = format_number(size);
  const std::string material = density < 200.0 ? "foam" : "rubber_block";  // light rubber would need small steps
  return "\"" + name + R"(": { "shape": { "type": "solid", "size": [)" + side + "," + side + "," + side +
         R"(], "resolution": [3, 3, 3] }, "material": ")" + material + R"(", "body_contact": false, "density": )" +
         format_number(density) + R"(, "place": { "position": )" + at + " } }";
}

std::string attachment(const std::string& first, const std::string& second, const std::string& more = "") {
  return R"({ "first": { )" + first + R"( }, "second": { "body": ")" + second + "\" }" + more + " }";
}

std::string corner(const std::string& body, const std::string& which) {
  return R"("body": ")" + body + R"(", "at": "corner", "which": [)" + which + "]";
}

const std::string kFrom = R"({ "at": "corner", "which": ["from"] })";
const std::string kTo = R"({ "at": "corner", "which": ["to"] })";
const std::string kTop = R"("min_max_min", "max_max_min", "min_max_max", "max_max_max")";

std::string scene_text(const std::string& bodies, const std::string& attachments) {
  return R"({ "duration": 1, "air": false, "integrator": { "type": "verlet" }, "output": { "forces": true }, "bodies": {)" +
         bodies + R"(}, "attachments": [)" + attachments + "] }";
}

std::string joined(const std::vector<std::string>& parts) {
  return std::accumulate(parts.begin(), parts.end(), std::string(),
                         [](const std::string& all, const std::string& part) { return all.empty() ? part : all + ",\n" + part; });
}

/// 29.7 kg on 68 g of rope.
std::string crate_on_rope() {
  return scene_text(joined({rope("rope", "[0,2,0]", "[0,1,0]", 41, kFrom), crate("crate", "[0,0.84,0]", 0.3, 1100)}),
                    attachment(corner("rope", "\"to\""), "crate"));
}

/// A load in the middle of a cloth between two ropes.
std::string hammock() {
  const std::string cloth = R"("cloth": { "shape": { "type": "cloth", "size": [1.2, 0.6], "resolution": [9, 5] },
      "material": "denim", "place": { "position": [0, 1, 0], "rotation": [90, 0, 0] } })";
  const std::string ends = R"("body": "cloth", "box": [[)";
  return scene_text(joined({cloth, rope("left", "[-1,1,0]", "[-0.62,1,0]", 7, kFrom),
                            rope("right", "[1,1,0]", "[0.62,1,0]", 7, kFrom), crate("load", "[0,0.89,0]", 0.2, 1100)}),
                    joined({attachment(ends + "-0.61,0,-1],[-0.59,2,1]]", "left"),
                            attachment(ends + "0.59,0,-1],[0.61,2,1]]", "right"), attachment(corner("load", kTop), "cloth")}));
}

/// Five crates on one rope.
std::string chandelier() {
  std::vector<std::string> bodies = {rope("rope", "[-1.5,2,0]", "[1.5,2,0]", 61, kFrom + ", " + kTo)};
  std::vector<std::string> attachments;
  for (int i = 0; i < 5; ++i) {
    const std::string name = std::string("crate_") + static_cast<char>('a' + i);
    bodies.push_back(crate(name, vector_text(-1.0 + 0.5 * i, 1.84, 0.0), 0.3, 1100));
    attachments.push_back(attachment(corner(name, kTop), "rope"));
  }
  return scene_text(joined(bodies), joined(attachments));
}

/// Two crates pull the ends of a rope that is pinned in its middle.
std::string tug_of_war() {
  const std::string bent = R"("rope": { "shape": { "type": "rope", "points": [[-0.3,1.1,0],[0,2,0],[0.3,1.1,0]], "particles": 61 },
      "material": "nylon", "pins": [{ "indices": [30] }] })";
  return scene_text(joined({bent, crate("left", "[-0.3,0.94,0]", 0.3, 1100), crate("right", "[0.3,0.94,0]", 0.2, 1100)}),
                    joined({attachment(corner("rope", "\"from\""), "left"), attachment(corner("rope", "\"to\""), "right")}));
}

/// One to three crates of 1 to 1,000 times the mass of a light rope or cloth hang on it: below it, by lines, by rods or springs.
std::string random_loads(Random& random) {
  const auto any_of = [&](const auto& values) {
    return values[static_cast<std::size_t>(random.below(static_cast<Index>(values.size())))];
  };
  const auto kind = random.below(3);
  const double length = any_of(std::array{0.5, 1.0, 2.0});
  std::vector<std::string> bodies;
  std::vector<std::string> attachments;
  if (kind == 0) bodies.push_back(rope("support", "[0,3,0]", vector_text(0, 3 - length, 0), 8 + random.below(34), kFrom));
  if (kind == 1) {
    bodies.push_back(rope("support", vector_text(-0.5 * length, 3, 0), vector_text(0.5 * length, 3, 0), 11 + random.below(31),
                          kFrom + ", " + kTo));
  }
  if (kind == 2) {
    bodies.push_back(R"("support": { "shape": { "type": "cloth", "size": [1.2, 0.8], "resolution": [13, 9] }, "material": ")" +
                     any_of(std::array<std::string, 2>{"denim", "cotton"}) +
                     R"(", "place": { "position": [0, 3, 0], "rotation": [90, 0, 0] }, "pins":
                     [{ "box": [[-0.61, 2, -1], [-0.59, 4, 1]] }, { "box": [[0.59, 2, -1], [0.61, 4, 1]] }] })");
  }
  const double light = kind == 2 ? 0.2 : 0.0676 * length;
  const Index count = 1 + random.below(3);
  const auto join = [&](const std::string& first, const std::string& second, bool may_be_spring) {
    const bool spring = may_be_spring && random.below(3) == 0;
    attachments.push_back(attachment(first, second, spring ? R"(, "stiffness": 5000, "damping": 2)" : ""));
  };
  for (Index i = 0; i < count; ++i) {
    const std::string name = std::string("crate_") + static_cast<char>('a' + i);
    const double size = any_of(std::array{0.1, 0.2, 0.3});
    const double mass = light * std::pow(10.0, random.between(0.0, 3.0)) / static_cast<double>(count);
    const double gap = any_of(std::array{0.005, 0.02, 0.05});
    const double density = mass / (size * size * size);
    const double at = static_cast<double>(i + 1) / static_cast<double>(count + 1) - 0.5;
    if (kind == 0 && i + 1 < count) {
      const double y = 3.0 - length * static_cast<double>(i + 1) / static_cast<double>(count);
      bodies.push_back(crate(name, vector_text(0.5 * size + gap, y, 0), size, density));
      join(corner(name, "\"min_max_max\""), "support", true);
    } else if (kind == 0) {
      bodies.push_back(crate(name, vector_text(0, 3 - length - gap - 0.5 * size, 0), size, density));
      join(corner("support", "\"to\""), name, true);
    } else if (random.below(2) == 0) {
      bodies.push_back(crate(name, vector_text((kind == 2 ? 1.0 : length) * at, 3 - gap - 0.5 * size, 0), size, density));
      join(corner(name, kTop), "support", true);
    } else {
      const double x = (kind == 2 ? 1.0 : length) * at;
      const std::string line = std::string("line_") + static_cast<char>('a' + i);
      bodies.push_back(rope(line, vector_text(x, 2.99, 0), vector_text(x, 2.6, 0), 5 + random.below(17), ""));
      bodies.push_back(crate(name, vector_text(x, 2.6 - gap - 0.5 * size, 0), size, density));
      join(corner(line, "\"from\""), "support", false);
      join(corner(line, "\"to\""), name, true);
    }
  }
  return scene_text(joined(bodies), joined(attachments));
}

/// Frame by frame, from time 0.
struct Record {
  double weight = 0.0;          ///< of all bodies [N]
  std::vector<double> carried;  ///< by pins, upwards [N]; the mean of the frame
  std::vector<double> total;    ///< energy [J]
  double moved = 0.0;           ///< largest kinetic plus elastic energy [J]

  /// The largest error of what pins carry from a frame on, relative to the weight.
  [[nodiscard]] double largest_error_from(std::size_t frame) const {
    double largest = 0.0;
    for (std::size_t f = frame; f < carried.size(); ++f) largest = std::max(largest, std::abs(carried[f] / weight - 1.0));
    return largest;
  }
  /// The error of the mean from a frame on.
  [[nodiscard]] double mean_error_from(std::size_t frame) const {
    const auto begin = carried.begin() + static_cast<std::ptrdiff_t>(frame);
    const double sum = std::accumulate(begin, carried.end(), 0.0);
    return std::abs(sum / static_cast<double>(carried.end() - begin) / weight - 1.0);
  }
  [[nodiscard]] double gain() const { return (*std::ranges::max_element(total) - total.front()) / moved; }
};

Record run(const std::string& text, double damping_rate, double duration) {
  TextProblems problems;
  const Scene scene =
      read_scene_text(text, "loads.json",
                      {"integrator.damping_rate=" + format_number(damping_rate), "duration=" + format_number(duration)}, problems);
  Record record;
  const Watch watch = [&](const Simulator& simulator, const FrameDiagnostics& frame) {
    const SpringNetwork& network = simulator.network();
    record.weight = network.masses.sum() * simulator.settings().gravity.norm();
    double carried = 0.0;
    for (const Reaction& reaction : simulator.reactions()) {
      if (std::ranges::find(network.pins, reaction.name, &Pin::name) != network.pins.end()) carried += reaction.force.y();
    }
    record.carried.push_back(carried);
    record.total.push_back(frame.kinetic_energy + frame.elastic_energy + frame.gravity_energy);
    record.moved = std::max(record.moved, frame.kinetic_energy + frame.elastic_energy);
  };
  run_scenario(build_scene(scene, {}, problems), watch, Judge::nothing);
  return record;
}

struct Case {
  std::string name;
  std::string (*text)();
};

class LoadPaths : public ::testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Scenes, LoadPaths,
                         ::testing::Values(Case{"crate", crate_on_rope}, Case{"hammock", hammock}, Case{"chandelier", chandelier},
                                           Case{"tug_of_war", tug_of_war}),
                         [](const auto& scene) { return scene.param.name; });

TEST_P(LoadPaths, PinsCarryTheWeightOnceTheSwingHasDied) {
  const Record of_scene = run(GetParam().text(), 2.0, 4.5);
  EXPECT_LT(of_scene.largest_error_from(121), kOfWeight) << "from 4 s on";
}

TEST_P(LoadPaths, NothingGainsEnergy) { EXPECT_LT(run(GetParam().text(), 0.5, 3.0).gain(), kOfEnergy); }

TEST_P(LoadPaths, PinsCarryTheWeightInTheMeanWithoutDamping) {
  EXPECT_LT(run(GetParam().text(), 0.0, 5.0).mean_error_from(1), kOfWeight);
}

using RandomLoads = test::SeededTest;

TEST_F(RandomLoads, PinsCarryTheWeightAndNothingGainsEnergy) {
  for (const std::uint64_t number : {1, 2, 3}) {
    Random random(test::seeded(number));
    const std::string text = random_loads(random);
    EXPECT_LT(run(text, 0.5, 1.5).gain(), kOfEnergy) << text;
    EXPECT_LT(run(text, 2.0, 4.5).mean_error_from(121), kOfWeight) << text;
  }
}

}  // namespace
}  // namespace sprung::testing
