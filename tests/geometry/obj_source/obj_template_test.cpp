// OBJ text in which only positions change.
#include "geometry/obj_source/obj_template.h"

#include "base/error.h"
#include "base/test_seed.h"
#include "geometry/fixtures.h"
#include "geometry/mesh/polygon_mesh.h"
#include "geometry/obj_source/obj_source.h"

#include <gmock/gmock.h>

#include <random>

namespace sprung {
namespace {

using Normals = ObjTemplate::Normals;

std::string rewritten(const std::string& text, const Points& positions) {
  return ObjTemplate(text, Normals::as_given).text(positions, {});
}

TEST(ObjTemplate, ReplacesTheThreeNumbersAndNothingElse) {
  const Points positions = test::make_points({{0.5, 1, 1e-9}, {-2, 3, 4}});
  EXPECT_EQ(rewritten("# v 1 2 3\r\nv 1 2 3 0.1 0.2 0.3\r\n\tv  7 8\\\n9 # end\nvt 1 2\rp 1", positions),
            "# v 1 2 3\r\nv 0.5 1 1e-09 0.1 0.2 0.3\r\n\tv -2 3 4 # end\nvt 1 2\rp 1");
}

TEST(ObjTemplate, NormalsFollowTheirVerticesAndCornersNameThem) {
  const ObjTemplate file("v 0 0 0\r\nvn 1 2 3\r\nv 1 0 0 # b\r\nv 0 1 0\r\nf 1/2/3 2//9 \\\r\n 3 # f 1\r\nl 1 2\r\nv 2 2 2",
                         Normals::per_vertex);
  EXPECT_TRUE(file.has_given_normals());
  const Points positions = test::make_points({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 2, 2}});
  const Points normals = test::make_points({{0, 0, 1}, {0, 1, 0}, {1, 0, 0}, {0, 0, -1}});
  EXPECT_EQ(file.text(positions, normals),
            "v 0 0 0\r\nvn 0 0 1\r\nv 1 0 0 # b\r\nvn 0 1 0\r\nv 0 1 0\r\nvn 1 0 0\r\nf 1/2/1 2//2 \\\r\n 3//3 # f 1\r\nl 1 2\r\n"
            "v 2 2 2\nvn 0 0 -1\n");
}

TEST(ObjTemplate, FacesThatAreRemovedLeaveNoTrace) {
  const std::string text = "v 0 0 0\r\nf 1 1 1\r\nv 1 0 0 # b\nf 1 2 3 # one\nv 0 1 0\nf 1/2 2 \\\n 3\n# end\nv 2 2 2\nf 2 3 4";
  const Points positions = test::make_points({{0, 0, 9}, {1, 0, 9}, {0, 1, 9}, {2, 2, 9}});
  const Points normals = test::make_points({{0, 0, 1}, {0, 1, 0}, {1, 0, 0}, {0, 0, -1}});
  for (const Normals kind : {Normals::as_given, Normals::per_vertex}) {
    const ObjTemplate whole(text, kind);
    EXPECT_EQ(whole.without_faces({}).text(positions, normals), whole.text(positions, normals));
    // The same as without their lines in the text.
    const ObjTemplate second("v 0 0 0\r\nf 1 1 1\r\nv 1 0 0 # b\nv 0 1 0\nf 1/2 2 \\\n 3\n# end\nv 2 2 2\nf 2 3 4", kind);
    EXPECT_EQ(whole.without_faces({1}).text(positions, normals), second.text(positions, normals));
    const ObjTemplate none("v 0 0 0\r\nv 1 0 0 # b\nv 0 1 0\n# end\nv 2 2 2\n", kind);
    EXPECT_EQ(whole.without_faces({0, 1, 2, 3}).text(positions, normals), none.text(positions, normals));
    EXPECT_EQ(whole.without_faces({1}).without_faces({0, 1, 2}).text(positions, normals), none.text(positions, normals))
        << "what is left is numbered anew";
  }
}

TEST(ObjTemplate, ManyVerticesAreWrittenInOrder) {
  std::string text;
  std::string expected;
  Points positions(3, 10'000);  // more than two chunks of the parallel loop
  for (Index i = 0; i < positions.cols(); ++i) {
    positions.col(i) = Vector3(i, 2 * i, -i);
    const std::string tag = i % 3 == 0 ? "\ng " + std::to_string(i) : "";
    text += "v 0 0 0" + tag + "\n";
    expected +=
        "v " + std::to_string(i) + " " + std::to_string(2 * i) + " " + (i == 0 ? "0" : "-" + std::to_string(i)) + tag + "\n";
  }
  EXPECT_EQ(rewritten(text, positions), expected);
}

using RandomObj = test::FileTest;

// Whatever text read_obj accepts, its template has the same vertices, and its frames read back as the same mesh.
TEST_F(RandomObj, FramesReadBackAsTheMesh) {
  const std::vector<std::string> pieces{"v 1 2 3",
                                        "v 4 5 6 1",
                                        "v -1 0.5 2e1 0 0 1",
                                        "f 1 2 3",
                                        "f -1 -2 -3",
                                        "f 1/1 2/1 3/1",
                                        "vt 0 1",
                                        "vn 0 1 0",
                                        "l 1 2",
                                        "p 1",
                                        "g a b",
                                        "o c",
                                        "usemtl v",
                                        "s 1",
                                        "#",
                                        "# v 1 2 3 \\",
                                        " ",
                                        "\t",
                                        "\\\n",
                                        "\\\r\n",
                                        "\n",
                                        "\n",
                                        "\n",
                                        "\r\n",
                                        "\r",
                                        "v",
                                        "1",
                                        "mtllib x.mtl",
                                        std::string(1, '\0')};
  std::mt19937 random(test::seeded(11));
  std::uniform_int_distribution<std::size_t> piece(0, pieces.size() - 1);
  int accepted = 0;
  for (int round = 0; round < 3000; ++round) {
    std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 1 1\n";
    for (int i = 0; i < 12; ++i) text += pieces[piece(random)] + (i % 2 == 0 ? "\n" : "");
    PolygonMesh mesh;
    try {
      mesh = read_obj(write("random.obj", text));
    } catch (const InputError&) {
      continue;
    }
    ++accepted;
    for (const Normals normals : {Normals::as_given, Normals::per_vertex}) {
      const ObjSource source = read_obj_source(folder() / "random.obj", normals);
      ASSERT_EQ(source.file.vertex_count(), mesh.vertices.cols()) << text;
      const Points moved = mesh.vertices.array() / 3.0 + 7.0;
      const std::string frame = source.text(moved, triangulate(mesh.faces));
      const PolygonMesh again = read_obj(write("frame.obj", frame));
      EXPECT_EQ(again.vertices, moved) << text;
      EXPECT_EQ(again.faces.vertex, mesh.faces.vertex) << text;
      EXPECT_EQ(again.faces.corner_begin, mesh.faces.corner_begin) << text;
      EXPECT_EQ(again.faces.texcoord, mesh.faces.texcoord) << text;
      EXPECT_EQ(again.faces.groups, mesh.faces.groups) << text;
      EXPECT_EQ(again.lines, mesh.lines) << text;
    }
  }
  EXPECT_GT(accepted, 100);
}

}  // namespace
}  // namespace sprung
