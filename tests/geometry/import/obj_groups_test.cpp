// Groups, objects and materials of OBJ files.
#include "geometry/import/obj_groups.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <string>
#include <vector>

namespace sprung {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

ObjGroups groups_of(const std::string& text) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "sprung_obj_groups.obj";
  std::ofstream(file, std::ios::binary) << text;
  return read_obj_groups(file);
}

using Vertices = std::map<std::string, std::vector<Index>>;

Vertices vertices_of(const std::string& text) {
  Vertices vertices;
  for (const auto& [name, group] : groups_of(text)) vertices[name] = group.vertices;
  return vertices;
}

TEST(ObjGroups, EachPartHasTheVerticesOfItsFacesLinesAndPoints) {
  EXPECT_THAT(vertices_of("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n"
                          "o Left Sleeve\ng cuff seam\nusemtl wool red\nf 1/1/1 3//1 2\n"
                          "g\nv 5 5 5\nl -1 -2\ng cuff\np 1\nusemtl silk\nf 4 2 1\ng empty\n"),
              ElementsAre(Pair("Left Sleeve", ElementsAre(0, 1, 2, 3, 4)), Pair("cuff", ElementsAre(0, 1, 2, 3)),
                          Pair("seam", ElementsAre(0, 1, 2)), Pair("silk", ElementsAre(0, 1, 3)),
                          Pair("wool red", ElementsAre(0, 1, 2, 3, 4))));
}

TEST(ObjGroups, PartsOfOneNameAreOnePart) {
  EXPECT_THAT(vertices_of("v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nv 0 0 1\r\ng a \\\r\nb\r\nf 1 2 3\r\no a\r\ng c\r\nf 1 3 4\r\n"),
              ElementsAre(Pair("a", ElementsAre(0, 1, 2, 3)), Pair("b", ElementsAre(0, 1, 2)), Pair("c", ElementsAre(0, 2, 3))));
}

TEST(ObjGroups, FacesAndLinesAreNumberedAsTheMeshNumbersThem) {
  const std::string text =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nl 1 2\ng a\nl 1 2 3 4\nf 1 2 4\ng b\nf 2 3 4\ng a\nf 1 3 4\nl 4 1\n";
  const ObjGroups groups = groups_of(text);
  EXPECT_THAT(groups.at("a").faces, ElementsAre(1, 3));
  EXPECT_THAT(groups.at("a").lines, ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(groups.at("b").faces, ElementsAre(2));
  EXPECT_THAT(groups.at("b").lines, IsEmpty());
}

}  // namespace
}  // namespace sprung
