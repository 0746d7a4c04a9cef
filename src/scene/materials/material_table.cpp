// The data of the presets. A source says "as quoted by" where the original was not seen.
#include "scene/materials/materials.h"

#include "base/format.h"

#include <cmath>
#include <numbers>
#include <optional>

namespace sprung {
namespace {

// Springs in which waves travel faster than this need more than 100 steps a frame of 1/60 s in a cloth of 1 cm cells.
constexpr double kFastestWave = 50.0;  // [m/s]
// Instead, springs keep this speed: the weight of a metre of cloth compresses them by g L / c^2 = 1.6 %.
constexpr double kKeptWaveOfCloth = 25.0;  // [m/s]
// Angle bends of a rope shorten its springs, which must be stiffer for it: see weak_springs in simulation/settings.
constexpr double kKeptWaveOfRope = 60.0;  // [m/s]
// Damping times of structural and shear springs [s]. The fastest wave of a grid of cells h, at 2 c / h, has the damping ratio
// c / h times this: 0.25 in a cloth of 1 cm cells at 25 m/s, 0.3 in a rope of 1 cm springs at 60 m/s.
constexpr double kClothDampingTime = 1e-4;
constexpr double kRopeDampingTime = 5e-5;
// A hem of 0.1 m swings at this frequency: sqrt(3 g / (2 l)) / (2 pi). Kelvin-Voigt dampers have the loss factor of a material at
// this frequency only. It is higher at higher frequencies and lower at lower ones.
constexpr double kSwing = 2.0;  // [Hz]

/// A number and where it comes from.
struct Sourced {
  double value;
  std::string source;
};

struct Friction {
  double kinetic;
  double at_rest;
  std::string source;
};

/// A cloth as measured: the constants of a sheet.
struct Sheet {
  std::string name;
  std::string what;
  Sourced density;    // [kg/m^2]
  Sourced tensile;    // of structural springs [N/m]
  Sourced shear;      // stiffness G [N/m]
  Sourced bending;    // flexural rigidity [N m]
  Sourced loss;       // loss factor of bending
  Sourced thickness;  // [m]
  Friction friction;
};

/// A rope of diameter d [m].
struct Rope {
  std::string name;
  std::string what;
  Sourced diameter;  // [m]
  Sourced density;   // / d^2 [kg/m^3]
  Sourced tensile;   // EA / d^2 [Pa]
  Sourced bending;   // EI / (EA d^2) [1]
  Sourced loss;      // loss factor of bending
  Friction friction;
};

struct Block {
  std::string name;
  std::string what;
  Sourced density;  // [kg/m^3]
  Sourced young;    // [Pa]
  Sourced damping;  // ratio of the breathing motion
  Friction friction;
  bool preserves_volume = false;
};

std::string number(double value) { return format_number(value, 4); }

double rounded(double value, int digits = 4) { return std::stod(format_number(value, digits)); }

MaterialValue bend_damping(const Sourced& loss) {
  return {"springs.bend.damping_time", rounded(loss.value / (2.0 * std::numbers::pi * kSwing), 2), "s",
          loss.source + "; a loss factor of " + number(loss.value) + " at " + number(kSwing) + " Hz, the swing of a hem of 0.1 m"};
}

MaterialValue stretch_damping(const std::string& kind, double time) {
  return {"springs." + kind + ".damping_time", time, "s",
          "chosen: damps motion that is fast for the grid; " + number(kTearingDampingTime) +
              " s if a spring may break, a loss factor of 0.1 at 15 Hz, near handbook values of fabrics and ropes"};
}

void add_friction(const Friction& friction, std::vector<MaterialValue>& values) {
  values.push_back({"static_friction", friction.at_rest, "1", friction.source});
  values.push_back({"friction", friction.kinetic, "1", friction.source});
}

/// The modulus of springs that keep a wave speed [m/s]; none if the measured ones are slow enough.
std::optional<MaterialValue> replaced(const std::string& key, const std::string& unit, double measured, double density, double kept,
                                      const std::string& source, const std::string& limit) {
  if (measured <= density * kFastestWave * kFastestWave) return std::nullopt;
  return MaterialValue{key, rounded(density * kept * kept), unit,
                       "chosen: replaces " + format_number(measured, 6) + " " + unit + " (" + source +
                           "), which would need too small steps" + limit};
}

Material cloth(const Sheet& sheet) {
  Material material{sheet.name, MaterialKind::cloth, sheet.what, {}, false};
  std::vector<MaterialValue>& values = material.values;
  values.push_back({"density", sheet.density.value, "kg/m^2", sheet.density.source});
  const auto structural = replaced("springs.structural.modulus", "N/m", sheet.tensile.value, sheet.density.value, kKeptWaveOfCloth,
                                   sheet.tensile.source, ", with a stretch limit of 2 %");
  material.stretch_limited = structural.has_value();
  values.push_back(
      structural.value_or(MaterialValue{"springs.structural.modulus", sheet.tensile.value, "N/m", sheet.tensile.source}));
  values.push_back(stretch_damping("structural", kClothDampingTime));
  // Two diagonals of modulus M resist shear with G = M / 2.
  const double shear = 2.0 * sheet.shear.value;
  values.push_back(replaced("springs.shear.modulus", "N/m", shear, sheet.density.value, kKeptWaveOfCloth, sheet.shear.source, "")
                       .value_or(MaterialValue{"springs.shear.modulus", shear, "N/m", sheet.shear.source}));
  values.push_back(stretch_damping("shear", kClothDampingTime));
  values.push_back({"springs.bend.modulus", sheet.bending.value, "N m", sheet.bending.source});
  values.push_back(bend_damping(sheet.loss));
  values.push_back({"thickness", sheet.thickness.value, "m", sheet.thickness.source});
  add_friction(sheet.friction, values);
  return material;
}

Material rope(const Rope& rope) {
  Material material{rope.name, MaterialKind::rope, rope.what, {}, false};
  std::vector<MaterialValue>& values = material.values;
  const double d = rope.diameter.value;
  const double density = rope.density.value * d * d;
  const double tensile = rope.tensile.value * d * d;
  values.push_back({"diameter", d, "m", rope.diameter.source});
  values.push_back({"density", rounded(density), "kg/m", rope.density.source, 2});
  MaterialValue structural = replaced("springs.structural.modulus", "N", tensile, density, kKeptWaveOfRope, rope.tensile.source,
                                      ", with a stretch limit of 2 %")
                                 .value_or(MaterialValue{"springs.structural.modulus", tensile, "N", rope.tensile.source});
  material.stretch_limited = structural.value != tensile;
  structural.power = 2;
  values.push_back(structural);
  values.push_back(stretch_damping("structural", kRopeDampingTime));
  values.push_back({"springs.bend.modulus", rounded(rope.bending.value * tensile * d * d), "N m^2", rope.bending.source, 4});
  values.push_back(bend_damping(rope.loss));
  values.push_back({"thickness", d / 2.0, "m", "chosen: half the diameter, so that the surface touches", 1});
  add_friction(rope.friction, values);
  return material;
}

// Springs along the edges of a cube with modulus 10/17 E, and along its face and space diagonals with 36/85 E, make an isotropic
// body with Young's modulus E and Poisson's ratio 1/4, the only one that springs between pairs of particles can have (Cauchy). Its
// shear modulus is 2/5 E. Kept volume leaves that as it is, and Young's modulus becomes three times as much, as of everything
// incompressible: 6/5 E, so that the springs have 5/6.
constexpr double kSpringsOfKeptVolume = 5.0 / 6.0;

Material solid(const Block& block) {
  Material material{block.name, MaterialKind::solid, block.what, {}, false};
  std::vector<MaterialValue>& values = material.values;
  values.push_back({"density", block.density.value, "kg/m^3", block.density.source});
  const double young = block.young.value * (block.preserves_volume ? kSpringsOfKeptVolume : 1.0);
  values.push_back({"springs.structural.modulus", rounded(young * 10.0 / 17.0), "Pa", block.young.source});
  values.push_back({"springs.structural.damping_ratio", block.damping.value, "1", block.damping.source});
  values.push_back({"springs.shear.modulus", rounded(young * 36.0 / 85.0), "Pa", block.young.source});
  values.push_back({"springs.shear.damping_ratio", block.damping.value, "1", block.damping.source});
  values.push_back({"thickness", 2e-3, "m", "chosen: a gap that a fall of a second crosses in several steps"});
  add_friction(block.friction, values);
  material.preserves_volume = block.preserves_volume;
  return material;
}

std::vector<Material> make_materials() {
  const std::string quoted = ", as quoted by the project 3fold-motion-engine";
  const std::string matsudaira = "Matsudaira et al. 2015, J. Textile Eng. 61(6), 69-73, tables 1 and 2" + quoted;
  const std::string hysteresis =
      "; B + (2HB / 2) / (50 1/m), the secant of the measured curve with hysteresis at a curvature of 50 1/m";
  const auto published = [](const std::string& where) { return "published: " + where; };
  const auto chosen = [](const std::string& why) { return "chosen: " + why; };
  const auto gap = [&](const std::string& measured) {
    return chosen("the gap of contact; " + measured + "; a smaller gap needs smaller steps");
  };
  const auto rubbing = [&](const std::string& of) { return chosen("no coefficient was found; " + of); };
  const std::string common = "common for cloth on a smooth surface";
  const std::string yarns =
      "the dry friction of yarns, 2HB of Kawabata's test, is about 0.4 B / cm: a loss factor of 2 where a swing bends the cloth by "
      "13 1/m, less where it bends it more";
  const auto strands = [&](const std::string& how) {
    return chosen("the friction of strands, " + how + "; no measurement was found");
  };
  const std::string impact = "; a ball meets the floor six to nine times slower than it breathes, with a loss factor of ";

  std::vector<Material> all;
  all.push_back(cloth({
      "cotton",
      "plain-woven cotton broadcloth",
      {0.1238, published(matsudaira)},
      {21400.0, published("490 N/m at 2.29 % of extension, a cotton of 158 g/m^2, Tadesse et al. 2018, Materials 11(12), 2466, as "
                          "quoted by the notes of an open-source garment project")},
      {56.0, chosen("twice the shear stiffness G = 56 N/m (1 gf/(cm deg)), usual for shirting")},
      {2.37e-5, published(matsudaira + hysteresis)},
      {2.0, chosen(yarns)},
      {2e-3, gap("0.497 mm are measured (Matsudaira et al. 2015" + quoted + ")")},
      {0.30, 0.35, rubbing(common)},
  }));
  all.push_back(cloth({
      "silk",
      "a filament faille of polyester; no silk with a measured bending rigidity was found",
      {0.1043, published(matsudaira)},
      {8000.0, chosen("6 % of extension under 490 N/m")},
      {12.0, chosen("twice the shear stiffness G = 12 N/m (0.2 gf/(cm deg)), usual for filament weaves")},
      {2.55e-6, published(matsudaira + hysteresis)},
      {2.0, chosen("filaments slide more easily than staple fibre; " + yarns)},
      {2e-3, gap("0.226 mm are measured (Matsudaira et al. 2015" + quoted + ")")},
      {0.25, 0.28, rubbing("lower than cotton")},
  }));
  all.push_back(cloth({
      "wool",
      "wool tropical, a suiting",
      {0.1629, published(matsudaira)},
      {7100.0, published("mean of warp and weft of suitings, Fan, Yu and Hunter 2004, table 1.12, as quoted by the notes of an "
                         "open-source garment project")},
      {32.0,
       published("twice the shear stiffness G = 32 N/m (0.575 gf/(cm deg)), suitings, Fan, Yu and Hunter 2004, table 1.12, as "
                 "quoted by the notes of an open-source garment project")},
      {9.81e-6, published(matsudaira + hysteresis)},
      {1.8, chosen("wool recovers better than cotton; " + yarns)},
      {2e-3, gap("0.407 mm are measured (Matsudaira et al. 2015" + quoted + ")")},
      {0.30, 0.35, rubbing(common)},
  }));
  all.push_back(cloth({
      "denim",
      "a twill of 350 g/m^2",
      {0.35, chosen("within the 331 to 390 g/m^2 of jeans")},
      {8900.0, published("490 N/m at 5.515 % of extension, fabric A of Kumari and Khurana 2016, J. Textiles 4614168, table 5")},
      {122.0,
       published("twice the shear stiffness G = 122 N/m (2.18 gf/(cm deg)), fabric A of Kumari and Khurana 2016, J. Textiles "
                 "4614168, table 5")},
      {7e-5, chosen("drapes within the 70 to 90 % of denims; a lighter one has 3.05e-5 (Kumari and Khurana 2016, fabric A)")},
      {2.4, chosen("a dense twill; " + yarns)},
      {2e-3, gap("1.07 mm are measured (Kumari and Khurana 2016, fabric A)")},
      {0.40, 0.50, rubbing("rougher than cotton")},
  }));
  all.push_back(cloth({
      "jersey",
      "a single jersey, a knit",
      {0.147,
       published("single jersey of 146.7 g/m^2, Fibres and Textiles 1/2018, as quoted by the notes of an open-source character "
                 "project")},
      {200.0, chosen("a knit stretches by tens of percent under 50 N/m")},
      {10.0, chosen("twice the shear stiffness G = 10 N/m, low as of knits")},
      {1.4e-6, chosen("a bending length of 1 cm")},
      {2.0, chosen("loops slide on each other; " + yarns)},
      {2e-3, gap("a jersey is about 0.6 mm thick")},
      {0.35, 0.40, rubbing("softer and fuller than cotton")},
  }));
  all.push_back(cloth({
      "leather",
      "sheep leather for garments",
      {0.50, chosen("625 kg/m^3 at 0.8 mm")},
      {10000.0, chosen("below the 58 kN/m that tests to rupture give, which are the stiff end")},
      {3000.0, chosen("twice the shear stiffness G = 3000 N/m, a third of the tensile stiffness, as of an isotropic sheet")},
      {2.2e-5,
       published("upper end of 9.2 to 22 (read as uN m, because the bending lengths then fit), sheep leathers, Memon et al. "
                 "2021, Materials 14(16), 4553; chosen because softer shear springs make it drape more")},
      {1.5, chosen("a mat of fibres; no measurement was found")},
      {2e-3, gap("0.64 to 0.96 mm are measured (Memon et al. 2021)")},
      {0.45, 0.55, rubbing("it grips more than cotton")},
  }));
  all.push_back(cloth({
      "felt",
      "a wool felt of 1.5 mm",
      {0.38, chosen("1.5 mm of 256 kg/m^3, near handbook values of felt SAE 12R1")},
      {2000.0, chosen("no measurement was found")},
      {300.0, chosen("twice the shear stiffness G = 300 N/m; no measurement was found")},
      {1e-4, chosen("no measurement was found; a strip of 10 cm bends by 4 cm under its weight")},
      {2.0, chosen("a mat of fibres; no measurement was found")},
      {2e-3, gap("it is 1.5 mm thick")},
      {0.35, 0.40, rubbing("as wool")},
  }));
  all.push_back(cloth({
      "paper",
      "copy paper of 80 g/m^2",
      {0.08, chosen("near handbook values of copy paper")},
      {4e5, chosen("E h of 4 GPa and 0.1 mm, near handbook values")},
      {1.5e5, chosen("twice the shear stiffness G = 150 kN/m, as of an isotropic sheet")},
      {3.3e-4, chosen("E h^3 / 12 of 4 GPa and 0.1 mm, near handbook values")},
      {0.1, chosen("far below cloth; no measurement was found")},
      {1e-3, gap("paper is 0.1 mm thick")},
      {0.35, 0.45, rubbing("common for paper")},
  }));
  all.push_back(cloth({
      "rubber_sheet",
      "a sheet of 0.5 mm of rubber, Shore A 40",
      {0.475, chosen("950 kg/m^3, near handbook values, at 0.5 mm")},
      {634.0,
       chosen("3/4 of E h, which makes the sheet isotropic; E = 1.69 MPa from the hardness by Gent's formula of 1958, h = 0.5 mm")},
      {317.0,
       chosen("3/4 of E h, which makes the sheet isotropic; E = 1.69 MPa from the hardness by Gent's formula of 1958, h = 0.5 mm")},
      {2.3e-5, chosen("E h^3 / 9 of an incompressible plate of 1.69 MPa and 0.5 mm")},
      {0.15, chosen("near handbook values of filled rubber, 0.1 to 0.2")},
      {2e-3, gap("it is 0.5 mm thick")},
      {0.80, 0.90, rubbing("near handbook values of rubber on dry surfaces")},
  }));

  const std::string free_wires = "; between a bundle of free wires and a solid rod, EI = EA d^2 / 16";
  all.push_back(rope({
      "hemp",
      "laid hemp rope",
      {0.012, chosen("a common size")},
      {650.0, chosen("650 kg/m^3 d^2, near handbook values of manila rope")},
      {3.0e8, chosen("300 MPa d^2, below the secant at rupture of handbook values")},
      {0.03 / 16.0, chosen("3 % of EA d^2 / 16" + free_wires)},
      {0.5, strands("of rough fibre")},
      {0.40, 0.50, rubbing("rough fibre")},
  }));
  all.push_back(rope({
      "nylon",
      "laid or braided nylon rope",
      {0.010, chosen("a common size")},
      {676.0, published("676 kg/m^3 d^2, mooring rope, program moorwire of Mooring-Line-Properties")},
      {1.18e8, published("118 MPa d^2, mooring rope, program moorwire of Mooring-Line-Properties")},
      {0.02 / 16.0, chosen("2 % of EA d^2 / 16" + free_wires)},
      {0.4, strands("of smooth fibre")},
      {0.20, 0.25, rubbing("smooth fibre")},
  }));
  all.push_back(rope({
      "steel_cable",
      "wire rope 6x19 with a steel core",
      {0.006, chosen("a common size")},
      {3990.0, published("3990 kg/m^3 d^2, program moorwire of Mooring-Line-Properties; catalogues of ropes 7x19 have 3810")},
      {4.04e10, published("40.4 GPa d^2, program moorwire of Mooring-Line-Properties")},
      {0.01 / 16.0, chosen("1 % of EA d^2 / 16" + free_wires)},
      {0.2, strands("of greased wires")},
      {0.16, 0.20, rubbing("greased steel")},
  }));
  const double round = std::numbers::pi / 4.0;
  all.push_back(rope({
      "hair",
      "a human hair",
      {60e-6, published("57 +/- 11 um, Erik 2008, BioNumbers 106859")},
      {1320.0 * round, chosen("1320 kg/m^3, near handbook values")},
      {3.89e9 * round,
       published("E = 3.89 GPa, Robbins, Chemical and Physical Behavior of Human Hair, as quoted on the list biomch-l "
                 "in 1998")},
      {1.0 / 16.0, published("EI of a round rod of E = 3.89 GPa, Robbins, as quoted on the list biomch-l in 1998")},
      {0.05, chosen("a solid fibre; no measurement was found")},
      {0.20, 0.25, rubbing("along the scales")},
  }));

  const std::string isotropic =
      "; 10/17 E of structural and 36/85 E of shear springs make an isotropic solid of Poisson's ratio 1/4, the one of springs";
  const std::string kept = isotropic + "; 5/6 of both, because kept volume stiffens it by 6/5";
  all.push_back(solid({
      "soft_jelly",
      "a gelatin gel, 1 part of powder in 10 of water",
      {1040.0, chosen("water and 10 % of gelatin")},
      {15200.0, published("E = 15.2 kPa, from the power law between 4.34 kPa at 20:1 and 277 kPa at 2:1, Bonavia 2025, arXiv "
                          "2512.20502" +
                          kept)},
      {0.1, chosen("a cube of 0.3 m wobbles for about a second")},
      {0.25, 0.30, rubbing("wet gels slip")},
      true,
  }));
  all.push_back(solid({
      "firm_jelly",
      "a gelatin gel, 1 part of powder in 5 of water",
      {1060.0, chosen("water and 20 % of gelatin")},
      {53000.0, published("E = 53 kPa, from the power law between 4.34 kPa at 20:1 and 277 kPa at 2:1, Bonavia 2025, arXiv "
                          "2512.20502" +
                          kept)},
      {0.1, chosen("a cube of 0.3 m wobbles for about a second")},
      {0.25, 0.30, rubbing("wet gels slip")},
      true,
  }));
  all.push_back(solid({
      "foam",
      "a flexible polymer foam",
      {30.0, chosen("near handbook values of 16 to 35 kg/m^3")},
      {3.0e5, chosen("E = 0.3 MPa, near handbook values of 0.25 to 1 MPa" + isotropic)},
      {0.9, chosen("a ball rebounds to about half of its height, as in the test of foams, ASTM D3574" + impact + "0.2")},
      {0.50, 0.60, rubbing("rough open cells")},
  }));
  all.push_back(solid({
      "rubber_block",
      "rubber, Shore A 50",
      {1100.0, chosen("near handbook values of filled rubber")},
      {2.46e6, chosen("E = 2.46 MPa, from the hardness by Gent's formula of 1958" + isotropic)},
      {0.2, chosen("a ball rebounds to three quarters of its height, usual for filled rubber" + impact + "0.05")},
      {0.80, 0.90, rubbing("near handbook values of rubber on dry surfaces")},
  }));
  return all;
}

}  // namespace

const std::vector<Material>& materials() {
  static const std::vector<Material> kMaterials = make_materials();
  return kMaterials;
}

std::string stretch_limit_rule() {
  return "* The measured modulus would need steps beyond reason: waves in it are faster than " + number(kFastestWave) +
         " m/s.\n"
         "  These springs have waves of " +
         number(kKeptWaveOfCloth) + " m/s (ropes: " + number(kKeptWaveOfRope) +
         " m/s), and a stretch limit of 2 % holds the structural ones.\n"
         "  A stretch_limit of the scene replaces this limit; a structural stiffness of the body removes it.\n";
}

}  // namespace sprung
