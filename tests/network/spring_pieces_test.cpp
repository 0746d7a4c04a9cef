// Which pieces of a body springs leave apart.
#include "network/spring_pieces.h"
#include "network/network_builder.h"

#include <gtest/gtest.h>

#include <array>

namespace sprung {
namespace {

SpringPieces pieces_of(const NetworkBuilder& builder) {
  const SpringNetwork network = builder.build();
  return spring_pieces(network, network.bodies.back());
}

/// Four particles on a line, 1 m apart.
NetworkBuilder four_particles() {
  NetworkBuilder builder;
  for (const double x : {0.0, 1.0, 2.0, 3.0}) builder.add_particle(Vector3(x, 0, 0), 1.0);
  return builder;
}

TEST(SpringPieces, AreSetsThatSpringsJoin) {
  NetworkBuilder builder = four_particles();
  EXPECT_EQ(pieces_of(builder).alone, 4);
  builder.add_spring(0, 1, 1.0, 1.0);
  EXPECT_EQ(pieces_of(builder).count, 1);
  EXPECT_EQ(pieces_of(builder).alone, 2);
  builder.add_spring(2, 3, 1.0, 1.0);
  EXPECT_EQ(pieces_of(builder).count, 2);
  builder.add_spring(1, 2, 1.0, 1.0);
  EXPECT_EQ(pieces_of(builder).count, 1);
  EXPECT_EQ(pieces_of(builder).alone, 0);
}

TEST(SpringPieces, AngleBendsJoinToo) {
  NetworkBuilder builder = four_particles();
  builder.add_angle_bend(0, 1, 2, 1.0);
  EXPECT_EQ(pieces_of(builder).count, 1);
  EXPECT_EQ(pieces_of(builder).alone, 1);
}

TEST(SpringPieces, BendsOfTrianglesJoinToo) {
  PolygonMesh mesh;
  mesh.vertices = (Points(3, 5) << 0, 1, 0, 1, 9, 0, 0, 1, 1, 9, 0, 0, 0, 0, 0).finished();
  mesh.faces = to_polygons((Triangles(3, 2) << 0, 1, 1, 3, 2, 2).finished());
  const SpringMaterial bend{.value = 1.0, .measure = SpringMaterial::Measure::modulus};
  BodyShape shape = make_mesh_body(mesh, {.bend = bend, .bend_model = SpringMaterials::BendModel::angle}, {});
  shape.masses.assign(5, 1.0);
  NetworkBuilder builder;
  builder.add_body("mesh", shape);
  EXPECT_EQ(pieces_of(builder).count, 1);
  EXPECT_EQ(pieces_of(builder).alone, 1);
}

TEST(SpringPieces, TouchOnlyWhereTheyAreDifferentPieces) {
  NetworkBuilder builder = four_particles();
  const Index same_place = builder.add_particle(Vector3(3, 0, 0), 1.0);
  builder.add_particle(Vector3(9, 0, 0), 1.0);  // a piece that touches nothing
  for (const auto& [first, second] : {std::array<Index, 2>{0, 1}, {1, 2}, {2, 3}}) builder.add_spring(first, second, 1.0, 1.0);
  EXPECT_TRUE(pieces_of(builder).touch);
  builder.add_spring(same_place, 0, 1.0, 3.0);
  EXPECT_FALSE(pieces_of(builder).touch) << "a rope may pass through a point twice";
}

TEST(SpringPieces, TouchWithinAMillionthOfTheExtent) {
  NetworkBuilder builder = four_particles();
  builder.add_particle(Vector3(3, 1e-6, 0), 1.0);
  builder.add_particle(Vector3(3, 5e-6, 0), 1.0);
  for (const auto& [first, second] : {std::array<Index, 2>{0, 1}, {1, 2}, {2, 3}}) builder.add_spring(first, second, 1.0, 1.0);
  const SpringPieces pieces = pieces_of(builder);
  EXPECT_TRUE(pieces.touch);
  EXPECT_DOUBLE_EQ(pieces.touch_distance, 1e-6) << "the power of ten next to 3e-6";
  EXPECT_EQ(pieces.count + pieces.alone, 3);
  EXPECT_EQ(pieces.count_welded, 2);
}

TEST(SpringPieces, TouchWithinLessThanTheShortestSpring) {
  NetworkBuilder builder = four_particles();
  const Index near = builder.add_particle(Vector3(0, 5e-7, 0), 1.0);
  builder.add_spring(0, near, 1.0, 5e-7);
  EXPECT_DOUBLE_EQ(pieces_of(builder).touch_distance, 1e-7);
  builder.add_spring(1, 2, 1.0, 0.0);
  EXPECT_EQ(pieces_of(builder).touch_distance, 0.0);
}

TEST(SpringPieces, OtherBodiesDoNotCount) {
  NetworkBuilder builder = four_particles();
  builder.begin_body("other");
  builder.add_particle(Vector3(0, 0, 0), 1.0);
  builder.add_particle(Vector3(0, 1, 0), 1.0);
  builder.add_spring(4, 5, 1.0, 1.0);
  EXPECT_EQ(pieces_of(builder).count, 1);
  EXPECT_EQ(pieces_of(builder).alone, 0);
  EXPECT_FALSE(pieces_of(builder).touch);
}

TEST(SpringPieces, CellsHoldTheSurfaceThatTheyCarry) {
  LatticeShape lattice;
  lattice.surface.vertices = (Points(3, 3) << 0.1, 0.9, 0.1, 0.1, 0.1, 0.9, 0.5, 0.5, 0.5).finished();
  lattice.surface.faces = to_polygons((Triangles(3, 1) << 0, 1, 2).finished());
  lattice.surface.lines.resize(2, 0);
  lattice.contact = {lattice.surface.vertices, triangulate(lattice.surface.faces)};
  lattice.cells.push_back({{0, 0, 0}, 1.0});
  SpringMaterials materials;
  materials.structural = SpringMaterial{.value = 1.0};
  BodyShape body = make_lattice_body(lattice, materials);
  set_total_mass(body, 1.0);
  NetworkBuilder builder;
  builder.add_body("lattice", body);
  EXPECT_EQ(pieces_of(builder).count, 1);
  EXPECT_EQ(pieces_of(builder).alone, 0);
}

}  // namespace
}  // namespace sprung
