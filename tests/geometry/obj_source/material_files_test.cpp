// Which files an OBJ mesh takes with it, and where they go.
#include "geometry/obj_source/material_files.h"

#include "geometry/fixtures.h"

#include <gmock/gmock.h>

namespace sprung {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

class MaterialFilesOf : public test::FileTest {
 protected:
  [[nodiscard]] MaterialFiles find(const std::string& obj_text) const {
    return find_material_files(folder() / "mesh.obj", obj_text);
  }
  [[nodiscard]] static std::vector<std::string> places(const MaterialFiles& found) {
    std::vector<std::string> names;
    for (const MaterialFile& file : found.files) names.push_back(file.place);
    return names;
  }
};

TEST_F(MaterialFilesOf, ALineAreSeveralNamesOrOneWithBlanks) {
  for (const char* name : {"a.mtl", "b.mtl", "c d.mtl"}) (void)write(name, "newmtl x\n");
  EXPECT_THAT(places(find("mtllib a.mtl b.mtl\r\nmtllib c d.mtl\nmtllib a.mtl\n")), ElementsAre("a.mtl", "b.mtl", "c d.mtl"));
  EXPECT_THAT(find("mtllib e f.mtl\n").missing, ElementsAre("e f.mtl"));
  EXPECT_THAT(find("mtllib a.mtl g.mtl\n").missing, ElementsAre("g.mtl"));
  std::filesystem::create_directories(folder() / "up");
  (void)write("up/a.mtl", "newmtl x\n");
  EXPECT_THAT(places(find("mtllib up/a.mtl b.mtl\n")), ElementsAre("up/a.mtl", "b.mtl"));
  EXPECT_THAT(find("# mtllib a.mtl\nmtllib\n").files, IsEmpty());
}

TEST_F(MaterialFilesOf, OptionsOfTexturesAreNoNames) {
  for (const char* name : {"1.png", "2.png", "3.png", "4.png"}) (void)write(name, "");
  (void)write("a.mtl",
              "map_Kd -o 1 2 -s 1 1 1 -blendu on 1.png\nMAP_KS -mm 0 1 2.png\nnorm -imfchan r 3.png\nmap_aat on\nKd 1 1 1\n"
              "refl -type sphere 4.png # shiny\nmap_Ka -clamp on\n");
  const MaterialFiles found = find("mtllib a.mtl");
  EXPECT_THAT(places(found), ElementsAre("a.mtl", "1.png", "2.png", "3.png", "4.png"));
  EXPECT_THAT(found.missing, IsEmpty());
  EXPECT_FALSE(found.files[0].text) << "no name changed";
}

TEST_F(MaterialFilesOf, NamesOfOtherComputersFindTheirFileByItsBaseName) {
  (void)write("1.png", "");
  (void)write("a.mtl", "map_Kd C:\\art\\1.png\r\nmap_Ks /nowhere/1.png\n");
  const MaterialFiles found = find("mtllib a.mtl");
  EXPECT_THAT(places(found), ElementsAre("a.mtl", "1.png"));
  EXPECT_EQ(found.files[0].text, "map_Kd 1.png\r\nmap_Ks 1.png\n");
}

TEST_F(MaterialFilesOf, NamesThatFramesOrTheirPatternsNeedAreNotTaken) {
  (void)write("look.obj", "");
  (void)write("a#1.png", "");
  (void)write("a.mtl", "map_Kd a#1.png\nmap_Ks .\n");
  const MaterialFiles found = find("mtllib look.obj\nmtllib a.mtl\n");
  EXPECT_THAT(places(found), ElementsAre("a.mtl"));
  EXPECT_THAT(found.unusual, ElementsAre("look.obj", "a#1.png"));
  EXPECT_THAT(found.missing, ElementsAre("."));
}

TEST_F(MaterialFilesOf, TwoFilesDoNotShareAPlace) {
  std::filesystem::create_directories(folder() / "one/two");
  (void)write("one/1.png", "outer");
  (void)write("one/two/1.png", "inner");
  (void)write("one/two/a.mtl", "map_Kd 1.png\nmap_Ks ../1.png\n");
  const MaterialFiles found = find("mtllib one/two/a.mtl");
  EXPECT_THAT(places(found), ElementsAre("one/two/a.mtl", "one/two/1.png"));
  EXPECT_THAT(found.unusual, ElementsAre("../1.png"));
}

TEST(DiffuseColours, AreThoseOfTheLibraries) {
  const MaterialFiles materials{
      .files = {{.place = "a.mtl",
                 .text = "# Kd 9 9 9\nKd 1 1 1\nnewmtl red paint\nKa 0 0 0\nKd 1 0.25 0\nnewmtl odd\nKd spectral x\n"},
                {.place = "b.mtl", .text = "newmtl blue\r\nKd 0 0 .5\r\nnewmtl red paint\nKd 0 0 0\n"},
                {.place = "red.png", .text = "newmtl no\nKd 0 0 0\n", .is_texture = true}},
      .missing = {},
      .unusual = {},
      .outside = {}};
  const auto colours = diffuse_colours(materials);
  EXPECT_EQ(colours.at("red paint"), (std::array{1.0, 0.25, 0.0}));
  EXPECT_EQ(colours.at("blue"), (std::array{0.0, 0.0, 0.5}));
  EXPECT_FALSE(colours.contains("odd"));
  EXPECT_FALSE(colours.contains("no"));
}

}  // namespace
}  // namespace sprung
