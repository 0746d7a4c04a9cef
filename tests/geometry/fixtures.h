// Small meshes with known properties, and a temporary folder.
#pragma once

#include "geometry/mesh/triangle_mesh.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <string>

namespace sprung::test {

inline Points make_points(std::initializer_list<Vector3> list) {
  Points points(3, std::ssize(list));
  Index i = 0;
  for (const Vector3& p : list) points.col(i++) = p;
  return points;
}

inline Triangles make_triangles(std::initializer_list<Eigen::Matrix<Index, 3, 1>> list) {
  Triangles triangles(3, std::ssize(list));
  Index t = 0;
  for (const auto& triangle : list) triangles.col(t++) = triangle;
  return triangles;
}

/// The cube origin + [0, size]^3; its 12 faces point outward.
inline TriangleMesh make_cube(double size = 1.0, const Vector3& origin = Vector3::Zero()) {
  TriangleMesh mesh;
  mesh.vertices.resize(3, 8);
  for (Index i = 0; i < 8; ++i) mesh.vertices.col(i) = origin + size * Vector3(i & 1, (i >> 1) & 1, (i >> 2) & 1);
  mesh.triangles = make_triangles({{0, 2, 1},
                                   {1, 2, 3},
                                   {4, 5, 6},
                                   {5, 7, 6},
                                   {0, 1, 4},
                                   {1, 5, 4},
                                   {2, 6, 3},
                                   {3, 6, 7},
                                   {0, 4, 2},
                                   {2, 4, 6},
                                   {1, 3, 5},
                                   {3, 7, 5}});
  return mesh;
}

inline TriangleMesh merge(const TriangleMesh& a, const TriangleMesh& b) {
  TriangleMesh both;
  both.vertices.resize(3, a.vertices.cols() + b.vertices.cols());
  both.vertices << a.vertices, b.vertices;
  both.triangles.resize(3, a.triangles.cols() + b.triangles.cols());
  both.triangles << a.triangles, (b.triangles.array() + static_cast<Index>(a.vertices.cols())).matrix();
  return both;
}

inline TriangleMesh inside_out(TriangleMesh mesh) {
  mesh.triangles.row(1).swap(mesh.triangles.row(2));
  return mesh;
}

/// Gives each test its own folder, which is removed at the end.
class FileTest : public testing::Test {
 protected:
  FileTest() : folder_(std::filesystem::temp_directory_path() / unique_name()) { std::filesystem::create_directories(folder_); }
  ~FileTest() override {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }

  [[nodiscard]] std::filesystem::path write(const std::string& name, const std::string& bytes) const {
    const std::filesystem::path file = folder_ / name;
    std::ofstream(file, std::ios::binary) << bytes;
    return file;
  }

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

 private:
  static std::string unique_name() {
    const testing::TestInfo* info = testing::UnitTest::GetInstance()->current_test_info();
    return std::string("sprung_") + info->test_suite_name() + "_" + info->name() + "_" + std::to_string(getpid());
  }

  std::filesystem::path folder_;
};

}  // namespace sprung::test
