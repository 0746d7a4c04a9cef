// Springs that break unload their surroundings first: ropes snap once, strips tear along a row, and a spike tears where it is.
#include "network/model/unloading.h"
#include "scene/load_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <ostream>
#include <set>
#include <string>
#include <vector>

namespace sprung::testing {
namespace {

/// A structural spring that broke.
struct Break {
  Index spring = kNone;         ///< in the network at the start
  double time = 0.0;            ///< begin of the step in which it was gone [s]
  std::vector<double> waves{};  ///< from it to each particle, through what was whole before it broke [s]
};

/// A scene that runs step by step to its end, and the structural springs that broke in it.
class TornScene {
 public:
  explicit TornScene(const std::string& text)
      : loaded_(start_scene(prepare_scene({.file = "scene.json", .text = text}))), whole_(simulator().network()) {}

  /// The rest of the scene, at most `steps`.
  void run(std::int64_t steps = std::numeric_limits<std::int64_t>::max()) {
    const std::int64_t last = static_cast<std::int64_t>(loaded_.frames - 1) * simulator().settings().steps_per_frame;
    while (steps-- > 0 && simulator().state().step < last) {
      const double time = simulator().time();
      const std::vector<char> before = simulator().state().springs.broken;
      const SpringNetwork network = simulator().network();
      simulator().step();
      const std::vector<char>& now = simulator().state().springs.broken;
      if (now == before) continue;
      Index number = 0;  // of the springs that were whole before
      for (Index s = 0; s < whole_.springs.count(); ++s) {
        if (before[s] != 0) continue;
        if (now[s] != 0 && whole_.springs.kind[s] == SpringKind::structural)
          breaks_.push_back({s, time, wave_times(network, number)});
        ++number;
      }
    }
  }

  Simulator& simulator() { return loaded_.simulator; }
  [[nodiscard]] const SpringNetwork& whole() const { return whole_; }
  [[nodiscard]] const std::vector<Break>& breaks() const { return breaks_; }
  [[nodiscard]] Vector3 middle(Index spring) const {
    return 0.5 * (whole_.positions.col(whole_.springs.first[spring]) + whole_.positions.col(whole_.springs.second[spring]));
  }

  /// The number of pieces that springs hold together.
  std::size_t pieces() {
    const SpringNetwork& network = simulator().network();
    std::vector<Index> root(static_cast<std::size_t>(network.particle_count()));
    for (std::size_t i = 0; i < root.size(); ++i) root[i] = static_cast<Index>(i);
    const auto root_of = [&](Index i) {
      while (root[i] != i) i = root[i];
      return i;
    };
    for (Index s = 0; s < network.springs.count(); ++s)
      root[root_of(network.springs.first[s])] = root_of(network.springs.second[s]);
    std::set<Index> roots;
    for (Index i = 0; i < network.particle_count(); ++i) roots.insert(root_of(i));
    return roots.size();
  }

 private:
  LoadedScene loaded_;
  SpringNetwork whole_;
  std::vector<Break> breaks_;
};

/// A rope with a weight, let go from rest at its full length: its load rises to twice the weight within half a period of the
/// weight.
std::string weight_on_rope(const std::string& rope, const std::string& structural, int particles, double length, double mass) {
  return R"({"duration": 1, "bodies": {"rope": {"shape": {"type": "rope", "from": [0, 3, 0], "to": [0, )" +
         std::to_string(3.0 - length) + R"(, 0], "particles": )" + std::to_string(particles) + "}, " + rope +
         R"(, "springs": {"structural": {)" + structural +
         R"(}}, "pins": [{"at": "corner", "which": ["from"]}], "point_masses": [{"indices": [)" + std::to_string(particles - 1) +
         R"(], "mass": )" + std::to_string(mass) + "}]}}}";
}

// The break strains lie between the strain at which the weight hangs and 1.8 times that.
TEST(Tearing, ARopeWithAWeightSnapsOnceNearItsTop) {
  // Hysteresis as of fibres: a loss factor of 0.1 in the recoil of a rope of 1 m, a quarter of whose period is length / c = 1/60 s.
  const std::string damped = R"("damping_time": 1e-3, )";
  const std::vector<std::string> scenes{
      weight_on_rope(R"("material": "hemp")", damped + R"("break": 0.05)", 21, 1.0, 2.0),
      weight_on_rope(R"("material": "hemp")", damped + R"("break": 0.05)", 61, 1.0, 1.5),
      weight_on_rope(R"("material": "nylon")", damped + R"("break": 0.08)", 31, 2.0, 2.0),
      weight_on_rope(R"("material": "steel_cable")", damped + R"("break": 0.03)", 21, 1.0, 1.2),
      weight_on_rope(R"("mass": 0.1)", damped + R"("modulus": 300, "break": 0.1)", 41, 1.0, 3.0),
      weight_on_rope(R"("mass": 0.02)", damped + R"("modulus": 200, "break": 0.2)", 11, 0.5, 3.0)};
  for (const std::string& text : scenes) {
    TornScene scene(text);
    scene.run();
    ASSERT_EQ(scene.breaks().size(), 1U) << text;
    EXPECT_EQ(scene.pieces(), 2U) << text;
    // The rope's own weight is at most an eighth of the load, that of the steel cable of 0.14 kg under 1.2 kg. From the top to the
    // middle the load falls by half of that, less than waves and scatter of a few percent: any spring of the upper half may be the
    // first to reach its strength.
    const double top = scene.whole().positions.row(1).maxCoeff();
    const double length = top - scene.whole().positions.row(1).minCoeff();
    EXPECT_GT(scene.middle(scene.breaks().front().spring).y(), top - 0.5 * length) << text;
  }
}

TEST(Tearing, AJerkAtAPinSnapsARopeOnce) {
  TornScene scene(R"({"duration": 0.5, "gravity": [0, 0, 0], "bodies": {"rope": {
      "shape": {"type": "rope", "from": [0, 0, 0], "to": [1, 0, 0], "particles": 41}, "mass": 0.1,
      "springs": {"structural": {"modulus": 300, "damping_time": 1e-3, "break": 0.1}},
      "pins": [{"at": "corner", "which": ["from"]}, {"at": "corner", "which": ["to"],
                "motion": {"keyframes": [{"time": 0}, {"time": 0.5, "position": [0.5, 0, 0]}]}}]}}})");
  scene.run();
  EXPECT_EQ(scene.breaks().size(), 1U);
  EXPECT_EQ(scene.pieces(), 2U);
}

struct Strip {
  double width = 0.3;   ///< [m]
  double length = 1.0;  ///< [m]
  Index columns = 13;
  Index rows = 41;
  std::string material{};  ///< empty: none
  double modulus = 200.0;  ///< [N/m]
  double density = 0.2;    ///< [kg/m^2]
  double speed = 0.1;      ///< of the pull, in units of wave speed times break strain

  static constexpr double kBreak = 0.1;
  [[nodiscard]] double wave_speed() const { return std::sqrt(modulus / density); }

  /// One end is held, and the other one pulled. A strip that is stretched evenly has torn after kBreak length / v; 30 % more, and
  /// eight times a wave through the strip, are for the tear to run and for what might follow.
  [[nodiscard]] std::string text() const {
    const double v = speed * wave_speed() * kBreak;
    const double duration = 1.3 * kBreak * length / v + 8.0 * length / wave_speed();
    const auto number = [](double value) { return std::to_string(value); };
    const auto ends = [&](double y) {
      return R"({"box": [[-9, )" + number(y - 0.001) + ", -1], [9, " + number(y + 0.001) + ", 1]]";
    };
    const std::string law = R"("damping_time": 1e-3, "break": 0.1)";
    const std::string body =
        material.empty()
            ? R"("density": )" + number(density) + R"(, "springs": {"structural": {"modulus": )" + number(modulus) + ", " + law +
                  R"(}, "shear": {"modulus": )" + number(modulus / 3.0) + ", " + law + "}}"
            : R"("material": ")" + material + R"(", "springs": {"structural": {)" + law + R"(}, "shear": {)" + law + "}}";
    return R"({"duration": )" + number(duration) +
           R"(, "gravity": [0, 0, 0], "bodies": {"strip": {"shape": {"type": "cloth", "size": [)" + number(width) + ", " +
           number(length) + R"(], "resolution": [)" + std::to_string(columns) + ", " + std::to_string(rows) + "]}, " + body +
           R"(, "pins": [)" + ends(-0.5 * length) + "}, " + ends(0.5 * length) +
           R"(, "motion": {"keyframes": [{"time": 0}, {"time": )" + number(duration) + R"(, "position": [0, )" +
           number(v * duration) + ", 0]}]}}]}}}";
  }
};

std::ostream& operator<<(std::ostream& stream, const Strip& strip) {
  return stream << strip.material << " " << strip.columns << " x " << strip.rows << " at " << strip.speed;
}

/// Long, square and wide ones, each without a material and with one.
std::vector<Strip> strips(const std::vector<double>& speeds) {
  std::vector<Strip> all;
  for (const double speed : speeds) {
    all.insert(all.end(), {{.speed = speed}, {.material = "cotton", .modulus = 77.38, .density = 0.1238, .speed = speed}});
    for (Strip strip : {Strip{.speed = speed}, {.material = "denim", .modulus = 218.8, .density = 0.35, .speed = speed}}) {
      strip.width = strip.length = 0.8;
      strip.columns = strip.rows = 21;
      all.push_back(strip);
    }
    for (Strip strip : {Strip{.speed = speed}, {.material = "rubber_sheet", .modulus = 634.0, .density = 0.475, .speed = speed}}) {
      strip.width = 1.0;
      strip.length = 0.5;
      strip.columns = 33;
      strip.rows = 17;
      all.push_back(strip);
    }
  }
  return all;
}

TEST(Tearing, AStripTearsAlongOneRow) {
  for (const Strip& strip : strips({0.05, 0.1, 0.25})) {
    TornScene scene(strip.text());
    scene.run();
    std::set<Index> rows;
    for (const Break& each : scene.breaks()) rows.insert(scene.whole().springs.first[each.spring] / strip.columns);
    EXPECT_EQ(static_cast<Index>(scene.breaks().size()), strip.columns) << strip;
    EXPECT_EQ(rows.size(), 1U) << strip;
    EXPECT_EQ(scene.pieces(), 2U) << strip;
  }
}

// A front has unloaded a spring once it has been at both ends for as long as it took to come. Breaks that are farther apart than a
// few springs may be two tears: they need not wait for each other.
TEST(Tearing, HoweverFastAPullTheNeighboursOfABreakAreUnloadedFirst) {
  for (const Strip& strip : strips({0.5, 1.0, 2.0})) {
    TornScene scene(strip.text());
    scene.run();
    ASSERT_GE(static_cast<Index>(scene.breaks().size()), strip.columns) << strip;
    const double across = strip.length / static_cast<double>(strip.rows - 1) / strip.wave_speed();  // a spring [s]
    const Springs& springs = scene.whole().springs;
    int beside = 0;
    for (std::size_t later = 1; later < scene.breaks().size(); ++later) {
      const Break& second = scene.breaks()[later];
      for (std::size_t earlier = 0; earlier < later; ++earlier) {
        const Break& first = scene.breaks()[earlier];
        const double way = std::max(first.waves[springs.first[second.spring]], first.waves[springs.second[second.spring]]);
        if (way > 3.0 * across) continue;
        ++beside;
        ASSERT_GE(second.time - first.time, 2.0 * way) << strip << ": " << first.spring << ", " << second.spring;
      }
    }
    EXPECT_GT(beside, strip.columns / 2) << strip << ": a tear goes from spring to spring";
  }
}

/// A cloth over a cone that stands off its middle, with the keys that bring it down on the cone.
std::string cloth_on_spike(const std::string& keys) {
  return R"({"duration": 0.7, "frame_rate": 60, "bodies": {"cloth": {
      "shape": {"type": "cloth", "size": [0.8, 0.8], "resolution": [25, 25]}, "material": "cotton",
      "springs": {"structural": {"break": 0.1}, "shear": {"break": 0.1}},
      "place": {"position": [0, 0.31, 0], "rotation": [-90, 0, 0]}, )" +
         keys + R"(}},
    "obstacles": {"spike": {"shape": {"type": "cone", "radius": 0.08, "height": 0.3}, "place": {"position": [0.05, 0.15, 0.03]}}}})";
}

TEST(Tearing, AClothTearsFromTheSpike) {
  std::string frame;
  for (const char* side : {"[[-0.41, 0.3, -0.41], [-0.39, 0.32, 0.41]]", "[[0.39, 0.3, -0.41], [0.41, 0.32, 0.41]]",
                           "[[-0.38, 0.3, -0.41], [0.38, 0.32, -0.39]]", "[[-0.38, 0.3, 0.39], [0.38, 0.32, 0.41]]"}) {
    frame += std::string(frame.empty() ? "" : ", ") + R"({"box": )" + side +
             R"(, "motion": {"keyframes": [{"time": 0}, {"time": 0.7, "position": [0, -0.21, 0]}]}})";
  }
  const std::string heavy_sides = R"("velocity": [0, -4, 0], "point_masses": [
      {"box": [[-0.41, 0.3, -0.41], [-0.37, 0.32, 0.41]], "mass": 0.05}, {"box": [[0.37, 0.3, -0.41], [0.41, 0.32, 0.41]], "mass": 0.05}])";
  for (const std::string& keys : {R"("pins": [)" + frame + "]", heavy_sides}) {
    TornScene scene(cloth_on_spike(keys));
    scene.run();
    ASSERT_GT(scene.breaks().size(), 4U) << keys;
    const double cell = 0.8 / 24.0;
    const Vector3 tip(0.05, 0.31, 0.03);
    EXPECT_LT((scene.middle(scene.breaks().front().spring) - tip).norm(), 2.0 * cell) << keys;
    // The next spring of a tear is at a cell beside the two that a break tore: its middle is at most two cells along and one
    // across.
    for (std::size_t later = 1; later < scene.breaks().size(); ++later) {
      double nearest = 1.0;
      for (std::size_t earlier = 0; earlier < later; ++earlier) {
        nearest =
            std::min(nearest, (scene.middle(scene.breaks()[later].spring) - scene.middle(scene.breaks()[earlier].spring)).norm());
      }
      EXPECT_LT(nearest, std::sqrt(5.0) * cell * 1.001) << keys << later;
    }
  }
}

}  // namespace
}  // namespace sprung::testing
