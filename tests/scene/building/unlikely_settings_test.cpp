// Warnings of what is probably not meant. Each goes when its remedy is followed, and brings no other one.
#include "scene/building/scene_builder.h"
#include "scene/scene_text.h"

#include <gmock/gmock.h>

namespace sprung {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A scene of one body, named `body`, with these keys and an OBJ file of this text.
class UnlikelySettings : public testing::Test {
 protected:
  [[nodiscard]] std::vector<std::string> warnings(const std::string& body, const std::vector<std::string>& changes = {},
                                                  const std::string& mesh = "") const {
    folder_.write("mesh.obj", mesh);
    return build_scene(folder_.read(R"({"duration": 1, "bodies": {"body": {)" + body + "}}}", changes)).warnings;
  }

 private:
  SceneFolder folder_;
};

const std::string kCloth = R"("shape": {"type": "cloth", "size": [1, 1], "resolution": [5, 5]}, "material": "cotton")";
const std::string kMesh = R"("shape": {"type": "mesh", "file": "mesh.obj"}, "material": "silk")";
const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";

TEST_F(UnlikelySettings, FacesThatLieTwiceAreCounted) {
  const auto twice = ElementsAre(HasSubstr("body \"body\": 1 face lies twice in its mesh"));
  EXPECT_THAT(warnings(kMesh, {}, kSquare + "f 4 3 2 1\n"), twice);
  EXPECT_THAT(warnings(kMesh, {R"(bodies.body.shape.weld=1e-6)"}, kSquare + "v 0 0 0\nf 5 2 3 4\n"), twice) << "after the weld";
  EXPECT_THAT(warnings(kMesh, {}, kSquare), IsEmpty());
}

// The side of the square from vertex 2 to vertex 3 meets two sides of the faces beside it, with vertex 8 between them.
TEST_F(UnlikelySettings, SeamWithVerticesOnOneSideAloneStaysOpen) {
  const std::string beside = "v 1 0 0\nv 2 0 0\nv 2 1 0\nv 1 0.5 0\nv 1 1 0\nf 5 6 8\nf 8 6 7 9\n";
  const std::vector<std::string> weld{"bodies.body.shape.weld=1e-6", "bodies.body.place.position=[0, 0, 3]"};
  EXPECT_THAT(warnings(kMesh, weld, kSquare + beside),
              ElementsAre(AllOf(HasSubstr("1 vertex lies on an edge of another face"), HasSubstr("first at [1, 0.5, 3]"))));
  const std::string with_vertex = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 8 3 4\n";
  EXPECT_THAT(warnings(kMesh, weld, with_vertex + beside), IsEmpty());
}

// The mean edge of the triangles of a grid is (2 + sqrt(2)) / 3 = 1.138 times a side of a cell, here 0.25 m.
TEST_F(UnlikelySettings, ThicknessBeyondTheEdgesNeedsNoSelfContact) {
  EXPECT_THAT(warnings(kCloth, {"bodies.body.self_contact=true", "bodies.body.thickness=0.285"}),
              ElementsAre(HasSubstr("thickness 0.285 m is larger than its edges, which are 0.285 m long on average")));
  EXPECT_THAT(warnings(kCloth, {"bodies.body.self_contact=true", "bodies.body.thickness=0.284"}), IsEmpty());
  EXPECT_THAT(warnings(kCloth, {"bodies.body.self_contact=false", "bodies.body.thickness=0.285"}), IsEmpty());
}

// The materials for cloths have 0.08 to 0.5 kg/m^2.
TEST_F(UnlikelySettings, DensityIsWithinAHundredTimesThoseOfMaterials) {
  const auto unusual = ElementsAre(AllOf(HasSubstr("its density is "), HasSubstr("materials for cloths is 0.08 to 0.5 kg/m^2")));
  EXPECT_THAT(warnings(kCloth, {"bodies.body.density=51"}), unusual);
  EXPECT_THAT(warnings(kCloth, {"bodies.body.mass=51"}), unusual);
  EXPECT_THAT(warnings(kCloth, {"bodies.body.particle_mass=2.1"}), unusual);
  EXPECT_THAT(warnings(kCloth, {"bodies.body.mass=0.00079"}), unusual);
  EXPECT_THAT(warnings(kCloth, {"bodies.body.mass=0.00081"}), IsEmpty());
  EXPECT_THAT(warnings(kCloth, {"bodies.body.mass=49", R"(bodies.body.point_masses=[{"indices": [0], "mass": 1000}])"}), IsEmpty());
}

TEST_F(UnlikelySettings, SizesOfShapesAreInMetres) {
  EXPECT_THAT(warnings(kCloth, {"bodies.body.shape.size=[1000, 1000]"}),
              ElementsAre(AllOf(HasSubstr("body \"body\": its largest extent is 1000 m"), HasSubstr("Sizes are in metres"))));
  EXPECT_THAT(warnings(kCloth, {"bodies.body.shape.size=[1000, 1000]", "bodies.body.place.scale=0.001"}), IsEmpty());
  const std::string ball = R"(obstacles={"ball": {"shape": {"type": "sphere", "radius": 60}, "place": {"position": [0, -70, 0]}}})";
  EXPECT_THAT(warnings(kCloth, {ball}), ElementsAre(HasSubstr("obstacle \"ball\": its largest extent is 120 m")));
  EXPECT_THAT(warnings(kCloth, {ball, "obstacles.ball.shape.radius=0.6"}), IsEmpty());
  const std::string floor =
      R"(obstacles={"floor": {"shape": {"type": "box", "size": [500, 1, 500]}, "place": {"position": [0, -9, 0]}}})";
  EXPECT_THAT(warnings(kCloth, {floor}), IsEmpty()) << "a floor may be wide";
  EXPECT_THAT(warnings(kCloth, {floor, "obstacles.floor.shape.size=[1, 0.0005, 1]"}), IsEmpty()) << "a plate may be thin";
  EXPECT_THAT(
      warnings(kCloth, {floor, "obstacles.floor.shape.size=[500, 200, 150]", "obstacles.floor.place.position=[0, -200, 0]"}),
      ElementsAre(HasSubstr("obstacle \"floor\": its largest extent is 500 m")));
}

TEST_F(UnlikelySettings, SizesFarBelowThoseOfOtherThingsAreAskedAbout) {
  const std::string ball =
      R"(obstacles={"ball": {"shape": {"type": "sphere", "radius": 0.0025}, "place": {"position": [0, -1, 0]}}})";
  EXPECT_THAT(warnings(kCloth, {ball}), ElementsAre(AllOf(HasSubstr("obstacle \"ball\": its largest extent is 0.005 m"),
                                                          HasSubstr("anything else in the scene is at least 200 times as large"))));
  EXPECT_THAT(warnings(kCloth, {ball, "obstacles.ball.shape.radius=0.005"}), IsEmpty());
  const std::string floor =
      R"(obstacles={"floor": {"shape": {"type": "box", "size": [9, 0.1, 9]}, "place": {"position": [0, -9, 0]}}})";
  EXPECT_THAT(warnings(kCloth, {floor, "bodies.body.shape.size=[0.02, 0.02]"}), IsEmpty()) << "a floor may be wide";
}

TEST_F(UnlikelySettings, FlagNeverFluttersInASteadyWindAlongIt) {
  const auto flag = [&](const std::vector<std::string>& changes) {
    std::vector<std::string> all{R"(air={"surface": {"normal": 0.6, "quadratic": true}, "wind": [4, 0, 0]})"};
    all.insert(all.end(), changes.begin(), changes.end());
    return warnings(kCloth + R"(, "pins": [{"at": "corner", "which": ["min_min", "min_max"]}])", all);
  };
  EXPECT_THAT(flag({}), ElementsAre(HasSubstr("body \"body\": the wind blows exactly along its plane and has no gusts")));
  EXPECT_THAT(flag({"bodies.body.place.rotation=[0, 1, 0]"}), IsEmpty());
  EXPECT_THAT(flag({"air.wind=[4, 0, 0.07]"}), IsEmpty());
  EXPECT_THAT(flag({R"(air.gusts={"speed": 1, "length": 1})"}), IsEmpty());
  EXPECT_THAT(flag({"bodies.body.place.rotation=[90, 0, 0]"}), IsEmpty()) << "gravity pulls it out of its plane";
  EXPECT_THAT(flag({"bodies.body.velocity=[0, 0, 1]"}), IsEmpty());
  EXPECT_THAT(flag({"air={\"wind\": [4, 0, 0]}", "bodies.body.material=cotton"}),
              ElementsAre(HasSubstr("body \"body\": the wind blows exactly along its plane")))
      << "by the drag of its material";
}

}  // namespace
}  // namespace sprung
