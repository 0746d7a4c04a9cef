#include "geometry/tetrahedra/tetrahedra_mesh.h"

#include "base/error.h"
#include "geometry/fixtures.h"
#include "geometry/mesh/topology.h"
#include "geometry/tetrahedra/box_meshes.h"
#include "geometry/tetrahedra/tetrahedra_texts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace sprung {
namespace {

using test::ele_text;
using test::gmsh2;
using test::gmsh4;
using test::node_text;
using test::vtk4;
using test::vtk5;
using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;

TetrahedraMesh box() {
  TetrahedraMesh mesh = test::make_box({2, 1, 3}, 0.1, test::Cut::five);
  test::jitter(mesh, 0.02, 3);
  return mesh;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

class TetrahedraFile : public test::FileTest {
 protected:
  /// The problems of a file, a line each.
  [[nodiscard]] std::string problems_of(const std::string& name, const std::string& text) const {
    try {
      (void)read_tetrahedra(write(name, text));
    } catch (const InputError& error) {
      std::string all;
      for (const Problem& problem : error.problems()) {
        EXPECT_THAT(problem.file, ::testing::StartsWith(folder().string()));
        all += problem.key + " = " + problem.value + ": " + problem.rule + "; " + problem.remedy + "\n";
      }
      return all;
    }
    return "accepted";
  }

  /// The problems of `good` with a piece replaced, as a function of the piece and its replacement.
  [[nodiscard]] auto damaged(const std::string& name, const std::string& good) const {
    return
        [this, name, good](const std::string& from, const std::string& to) { return problems_of(name, replaced(good, from, to)); };
  }

  void expect_same(const TetrahedraMesh& expected, const std::filesystem::path& file) const {
    const TetrahedraMesh mesh = read_tetrahedra(file);
    EXPECT_EQ(mesh.vertices, expected.vertices) << file;
    EXPECT_EQ(mesh.tetrahedra, expected.tetrahedra) << file;
  }
};

std::size_t lines_of(const std::string& text) { return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')); }

TEST_F(TetrahedraFile, AllFormatsGiveTheSameMesh) {
  const TetrahedraMesh mesh = box();
  expect_same(mesh, write("a.msh", gmsh2(mesh)));
  expect_same(mesh, write("b.MSH", gmsh4(mesh)));
  expect_same(mesh, write("c.vtk", vtk4(mesh)));
  expect_same(mesh, write("d.vtk", vtk5(mesh)));
  for (const Index first : {0, 1}) {
    const std::filesystem::path node = write("e.1.node", node_text(mesh, first));
    const std::filesystem::path ele = write("e.1.ele", ele_text(mesh, first));
    expect_same(mesh, node);
    expect_same(mesh, ele);
  }
}

TEST_F(TetrahedraFile, LinesMayEndAsAnySystemEndsThem) {
  const TetrahedraMesh mesh = box();
  for (const std::string end : {"\r\n", "\r"}) {
    std::string text;
    for (const char c : gmsh4(mesh)) text += c == '\n' ? end : std::string(1, c);
    expect_same(mesh, write("a.msh", text));
  }
}

TEST_F(TetrahedraFile, TetrahedraOfNegativeVolumeAreTurned) {
  const TetrahedraMesh mesh = box();
  TetrahedraMesh left_handed = mesh;
  for (auto& t : left_handed.tetrahedra) std::swap(t[2], t[3]);
  expect_same(mesh, write("a.msh", gmsh2(left_handed)));
}

TEST_F(TetrahedraFile, UnusedNodesAreLeftOut) {
  const TetrahedraMesh mesh = box();
  TetrahedraMesh more = mesh;
  more.vertices.resize(3, mesh.vertices.cols() + 2);
  more.vertices << Vector3(9, 9, 9), mesh.vertices, Vector3(8, 8, 8);
  for (auto& t : more.tetrahedra) {
    for (Index& corner : t) ++corner;
  }
  expect_same(mesh, write("a.vtk", vtk5(more)));
}

TEST_F(TetrahedraFile, DamagedGmshFilesAreRefusedByLine) {
  const std::string good = gmsh2(box());
  const auto problems = damaged("a.msh", good);
  EXPECT_EQ(problems("\n2.2 0 8\n", "\n2.2 1 8\n"),
            "line 2 = : is a binary file, of which only text is read; save it as text with `gmsh -save -format msh22 -setnumber "
            "Mesh.Binary 0 FILE`\n");
  EXPECT_THAT(problems("\n2.2 0 8\n", "\n4.0 0 8\n"), AllOf(HasSubstr("line 2 = 4.0: must be version 2.2 or 4.1"), EndsWith("\n")));
  EXPECT_EQ(problems("\n13 ", "\n10 "),
            "line 11 = 10: is the number of another node too, on line 10; \n"
            "line 40 = 13: must be the number of one of the 24 nodes; \n"
            "line 45 = 13: must be the number of one of the 24 nodes; \n");
  EXPECT_THAT(problems("\n24\n", "\n25\n"), HasSubstr("line 34 = $EndNodes: comes too early: $Nodes declares more lines"));
  EXPECT_THAT(problems("\n24\n", "\n23\n"), HasSubstr("line 33 = 79: must be $EndNodes"));
  EXPECT_THAT(problems("$EndElements\n", ""), HasSubstr("is truncated: the section $Elements has no end"));
  EXPECT_THAT(problems_of("a.msh", good.substr(0, good.find("$Elements"))), HasSubstr("has no section $Elements"));
  EXPECT_THAT(problems("\n9 4 3 ", "\n9 5 3 "), HasSubstr("a cell of type 5: must be 4"));
  EXPECT_THAT(problems("\n9 4 3 7 1 0 ", "\n9 4 3 7 1 0 10 "), HasSubstr("line 39 = : a tetrahedron must have four nodes"));
  EXPECT_THAT(problems("$Nodes\n24", "$Nodes\n-1"), HasSubstr("line 9 = -1: must be the number of nodes"));
  EXPECT_THAT(problems_of("a.msh", "hello\n"), HasSubstr("must be $MeshFormat"));
}

TEST_F(TetrahedraFile, DamagedGmsh4BlocksAreRefused) {
  const auto problems = damaged("a.msh", gmsh4(box()));
  EXPECT_THAT(problems("$Nodes\n2 24 ", "$Nodes\n2 25 "), HasSubstr("24 nodes: must be 25, as the section declares"));
  EXPECT_THAT(problems("$Nodes\n2 24 ", "$Nodes\n1 24 "), HasSubstr("must be $EndNodes"));
  EXPECT_THAT(problems("3 1 4 30", "3 1 11 30"), HasSubstr("a cell of type 11 (and 29 more): must be 4"));
}

TEST_F(TetrahedraFile, AllProblemsAreNamedInOneGo) {
  std::string text = gmsh2(box());
  text = replaced(text, "\n10 0 ", "\n10 nan ");
  text = replaced(text, "\n13 0.", "\n13 0,");
  text = replaced(text, "\n9 4 3 7 1 0 ", "\n9 4 3 7 1 0 99");
  const std::string problems = problems_of("a.msh", text);
  EXPECT_EQ(lines_of(problems), 3U) << problems;
  EXPECT_THAT(problems,
              AllOf(HasSubstr("line 10 = nan: must be a finite number"), HasSubstr("line 11 = 0,"), HasSubstr("line 39 = 99")));
}

TEST_F(TetrahedraFile, DamagedTetgenFilesAreRefused) {
  const TetrahedraMesh mesh = box();
  (void)write("nodes.ele", ele_text(mesh, 1));
  (void)write("elements.node", node_text(mesh, 1));
  const auto of_nodes = damaged("nodes.node", node_text(mesh, 1));
  const auto of_elements = damaged("elements.ele", ele_text(mesh, 1));
  EXPECT_THAT(problems_of("alone.ele", ele_text(mesh, 1)), HasSubstr("does not exist, but belongs to alone.ele"));
  EXPECT_THAT(of_nodes("24  3", "25  3"), HasSubstr("is truncated: it declares 25 nodes but contains 24"));
  EXPECT_THAT(of_nodes("24  3", "23  3"), HasSubstr("line 26 = 24: must not follow: the file declares 23 nodes"));
  EXPECT_THAT(of_nodes("24  3", "24  2"), HasSubstr("line 2 = 2: must be 3"));
  EXPECT_THAT(of_elements("30  4", "30  10"), HasSubstr("line 1 = 10: must be 4"));
  EXPECT_THAT(of_elements("30  4", "x  4"), HasSubstr("line 1 = x: must be the number of tetrahedra"));
  EXPECT_THAT(of_elements("\n1 ", "\n1 25 "), HasSubstr("line 2 = 25: must be the number of one of the 24 nodes"));
  EXPECT_THAT(of_elements(" 7\n", "\n1 2 3\n"), HasSubstr("line 3 = : a tetrahedron must have four nodes"));
}

TEST_F(TetrahedraFile, DamagedVtkFilesAreRefused) {
  const std::string good = vtk4(box());
  const auto problems = damaged("a.vtk", good);
  EXPECT_THAT(problems("ASCII", "BINARY"),
              HasSubstr("line 3 = : is a binary file, of which only text is read; save it with the file type ASCII"));
  EXPECT_THAT(problems("UNSTRUCTURED_GRID", "POLYDATA"), HasSubstr("line 4 = POLYDATA: must be DATASET UNSTRUCTURED_GRID"));
  EXPECT_THAT(problems("POINTS 24", "POINTS 25"), HasSubstr("METADATA: comes too early: POINTS declares more numbers"));
  EXPECT_THAT(problems("POINTS 24", "POINTS 23"), HasSubstr("is one number more than"));
  EXPECT_THAT(problems("CELLS 31 154", "CELLS 31 155"), HasSubstr("154 numbers: must be 155, as CELLS declares"));
  EXPECT_THAT(problems("CELL_TYPES 31\n5\n", "CELL_TYPES 31\n12\n"), HasSubstr("a cell of type 12: must be 10"));
  EXPECT_THAT(problems("CELL_TYPES 31\n5\n", "CELL_TYPES 30\n"), HasSubstr("has 31 CELLS but 30 CELL_TYPES"));
  EXPECT_THAT(problems("CELL_TYPES 31\n5\n", "CELL_TYPES 31\n10\n"), HasSubstr("3 points: a tetrahedron must have four nodes"));
  EXPECT_THAT(problems_of("a.vtk", good.substr(0, good.size() / 2)), HasSubstr("is truncated"));
  EXPECT_THAT(problems_of("a.vtk", replaced(vtk5(box()), "vtktypeint64\n0 4", "vtktypeint64\n0 400")),
              HasSubstr("OFFSETS must rise from 0 to 120"));
  EXPECT_THAT(problems_of("a.vtk", "<?xml version=\"1.0\"?>\n"), HasSubstr("XML files are not read"));
}

TEST_F(TetrahedraFile, FlatTetrahedraAreCounted) {
  TetrahedraMesh mesh = box();
  mesh.vertices.col(mesh.tetrahedra[4][0]) = mesh.vertices.col(mesh.tetrahedra[4][1]);
  std::size_t flat = 0;
  for (const auto& t : mesh.tetrahedra) flat += tetrahedron_volume(mesh.vertices, t) == 0.0 ? 1 : 0;
  ASSERT_GT(flat, 1U);
  EXPECT_THAT(problems_of("a.vtk", vtk5(mesh)),
              HasSubstr("= a tetrahedron (and " + std::to_string(flat - 1) + " more): must have a volume"));
}

TEST_F(TetrahedraFile, TetrahedraThatOverlapAreRefused) {
  TetrahedraMesh twice = box();
  twice.tetrahedra.push_back(twice.tetrahedra[0]);
  EXPECT_THAT(problems_of("a.vtk", vtk5(twice)), HasSubstr("must belong to at most two tetrahedra, on its two sides"));
  const TetrahedraMesh same_side{test::make_points({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.1, 0.1, 2}}),
                                 {{0, 1, 2, 3}, {0, 1, 2, 4}}};
  EXPECT_THAT(problems_of("a.vtk", vtk5(same_side)), HasSubstr("= a side: must belong to at most two tetrahedra"));
}

TEST_F(TetrahedraFile, OtherFilesAreRefused) {
  EXPECT_THAT(problems_of("a.vtu", "<VTKFile>"), HasSubstr("tetrahedra are read from .msh (Gmsh)"));
  EXPECT_THAT(problems_of("a.msh", gmsh2({Points::Zero(3, 3), {}})), HasSubstr("has no tetrahedra"));
}

TEST(TetrahedraBoundary, IsClosedAndEnclosesTheVolume) {
  for (const test::Cut cut : {test::Cut::five, test::Cut::six, test::Cut::mirrored}) {
    TetrahedraMesh mesh = test::make_box({3, 2, 4}, 0.5, cut);
    test::jitter(mesh, 0.1, 1);
    const Triangles boundary = boundary_triangles(mesh.tetrahedra);
    EXPECT_TRUE(is_closed(boundary));
    EXPECT_EQ(boundary.cols(), 4 * (3 * 2 + 2 * 4 + 4 * 3));
    // The boundary stays the box: its volume is a sum of 104 products of numbers below 2, each rounded by 2^-53.
    EXPECT_NEAR(signed_volume(mesh.vertices, boundary), 3.0, 1e-13);
  }
}

}  // namespace
}  // namespace sprung
