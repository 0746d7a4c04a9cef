// Texts of a mesh in the formats of tetrahedra. `first` is the number of the first node, where the format leaves it free.
#pragma once

#include "geometry/tetrahedra/tetrahedra_mesh.h"

#include <sstream>
#include <string>
#include <utility>

namespace sprung::test {

using Numbers = std::ostringstream;

inline Numbers numbers() {
  Numbers text;
  text.precision(17);
  return text;
}

inline std::string gmsh2(const TetrahedraMesh& mesh) {
  Numbers text = numbers();
  text << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 7 \"all of it\"\n$EndPhysicalNames\n$Nodes\n"
       << mesh.vertices.cols() << '\n';
  for (Index i = 0; i < mesh.vertices.cols(); ++i) text << 10 + 3 * i << ' ' << mesh.vertices.col(i).transpose() << '\n';
  text << "$EndNodes\n$Elements\n" << mesh.tetrahedra.size() + 2 << "\n1 15 2 0 1 10\n2 2 2 0 1 10 13 16\n";
  for (const auto& t : mesh.tetrahedra) {
    text << "9 4 3 7 1 0";
    for (const Index corner : t) text << ' ' << 10 + 3 * corner;
    text << '\n';
  }
  text << "$EndElements\n";
  return text.str();
}

// The nodes in two blocks, the second one of a surface with parameters.
inline std::string gmsh4(const TetrahedraMesh& mesh) {
  Numbers text = numbers();
  const Index n = static_cast<Index>(mesh.vertices.cols());
  text << "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 0 1\n1 0 0 0 1 1 1 0 0\n$EndEntities\n";
  text << "$Nodes\n2 " << n << " 1 " << n << '\n';
  for (const auto& [begin, end] : {std::pair<Index, Index>{0, n / 2}, {n / 2, n}}) {
    text << (begin == 0 ? "3 1 0 " : "2 1 1 ") << end - begin << '\n';
    for (Index i = begin; i < end; ++i) text << n - i << '\n';
    for (Index i = begin; i < end; ++i) text << mesh.vertices.col(i).transpose() << (begin == 0 ? "\n" : " 0.5 0.5\n");
  }
  text << "$EndNodes\n$Elements\n2 " << mesh.tetrahedra.size() + 1 << " 1 100\n2 1 2 1\n1 1 2 3\n3 1 4 " << mesh.tetrahedra.size()
       << '\n';
  for (const auto& t : mesh.tetrahedra) {
    text << 5;
    for (const Index corner : t) text << ' ' << n - corner;
    text << '\n';
  }
  text << "$EndElements\n";
  return text.str();
}

inline std::string node_text(const TetrahedraMesh& mesh, Index first) {
  Numbers text = numbers();
  text << "# nodes\n" << mesh.vertices.cols() << "  3  1  1\n";
  for (Index i = 0; i < mesh.vertices.cols(); ++i) {
    text << i + first << "  " << mesh.vertices.col(i).transpose() << "  0.5  1  # on the border\n";
  }
  return text.str();
}

inline std::string ele_text(const TetrahedraMesh& mesh, Index first) {
  Numbers text = numbers();
  text << mesh.tetrahedra.size() << "  4  1\n";
  for (const auto& t : mesh.tetrahedra)
    text << "1 " << t[0] + first << ' ' << t[1] + first << ' ' << t[2] + first << ' ' << t[3] + first << " 7\n";
  return text.str() + "# by TetGen\n";
}

// Three numbers a line, as ParaView writes them, and a triangle before the tetrahedra.
inline std::string vtk4(const TetrahedraMesh& mesh) {
  Numbers text = numbers();
  const std::size_t n = mesh.tetrahedra.size();
  text << "# vtk DataFile Version 3.0\n\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS " << mesh.vertices.cols() << " double\n";
  for (Index i = 0; i < mesh.vertices.size(); ++i) text << mesh.vertices.data()[i] << (i % 4 == 3 ? '\n' : ' ');
  text << "\nMETADATA\nINFORMATION 0\n\nCELLS " << n + 1 << ' ' << 5 * n + 4 << "\n3 0 1 2\n";
  for (const auto& t : mesh.tetrahedra) text << "4 " << t[0] << ' ' << t[1] << ' ' << t[2] << ' ' << t[3] << '\n';
  text << "CELL_TYPES " << n + 1 << "\n5\n";
  for (std::size_t t = 0; t < n; ++t) text << "10 ";
  text << "\nCELL_DATA " << n + 1 << "\nSCALARS CELLS int 1\nLOOKUP_TABLE default\n7 7\n";
  return text.str();
}

inline std::string vtk5(const TetrahedraMesh& mesh) {
  Numbers text = numbers();
  const std::size_t n = mesh.tetrahedra.size();
  text << "# vtk DataFile Version 5.1\na box\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS " << mesh.vertices.cols() << " double\n";
  for (Index i = 0; i < mesh.vertices.cols(); ++i) text << mesh.vertices.col(i).transpose() << '\n';
  text << "CELLS " << n + 1 << ' ' << 4 * n << "\nOFFSETS vtktypeint64\n";
  for (std::size_t t = 0; t <= n; ++t) text << 4 * t << (t % 9 == 8 ? '\n' : ' ');
  text << "\nCONNECTIVITY vtktypeint64\n";
  for (const auto& t : mesh.tetrahedra) text << t[0] << ' ' << t[1] << ' ' << t[2] << ' ' << t[3] << ' ';
  text << "\nCELL_TYPES " << n << '\n';
  for (std::size_t t = 0; t < n; ++t) text << "10\n";
  return text.str();
}

}  // namespace sprung::test
