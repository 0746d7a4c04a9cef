// Contact search of particles near the bunny with 3,700 to 280,000 triangles, and fcl::collide per particle in the same run.
#include "base/parallel.h"
#include "benchmark/bunnies.h"
#include "collision/sample_meshes.h"
#include "collision/truncation/step_truncation.h"

#include <benchmark/benchmark.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>

#include <vector>

namespace sprung {
namespace {

constexpr Index kParticles = 64 * 64;
constexpr double kThickness = 0.005;
constexpr double kMargin = 0.0025;

/// Particles like those of a cloth that lies on the mesh: rows of neighbours that move little, at distances around the gap. A grid
/// of points is cast onto the mesh from above.
struct Cloth {
  Points before;
  Points after;
  Scalars thickness = Scalars::Constant(kParticles, kThickness);
};

Cloth cloth_on(const TriangleMesh& mesh) {
  const ObstacleSet obstacles(
      {Obstacle{.name = "bunny", .geometry = MeshGeometry{std::make_shared<const TriangleMesh>(mesh), true}}});
  const ObstacleFrame frame(obstacles, 0.0, 0.0);
  const Box3 box = bounds(mesh.vertices);
  test::Random random(1);
  Cloth cloth{Points(3, kParticles), Points(3, kParticles)};
  Points above(3, kParticles);
  for (Index i = 0; i < kParticles; ++i) {
    const double u = (i % 64 + 0.5) / 64.0;
    const double v = (i / 64 + 0.5) / 64.0;
    above.col(i) = box.min() + box.sizes().cwiseProduct(Vector3(0.25 + 0.5 * u, 2.0, 0.25 + 0.5 * v));
    cloth.before.col(i) = above.col(i) - Vector3(0.0, 3.0 * box.sizes().y(), 0.0);
  }
  for (const Contact& contact : frame.contacts({above, cloth.before, cloth.thickness, 0.0})) {
    cloth.before.col(contact.particles[0]) = contact.point + random.between(0.5, 1.5) * kThickness * contact.normal;
  }
  cloth.after = cloth.before;
  for (Index i = 0; i < kParticles; ++i) cloth.after.col(i) += 1e-5 * random.direction();
  return cloth;
}

void report(benchmark::State& state, std::size_t contacts) {
  state.SetItemsProcessed(state.iterations() * kParticles);
  state.counters["per_particle"] = benchmark::Counter(static_cast<double>(state.iterations()) * kParticles,
                                                      benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["contacts"] = static_cast<double>(contacts);
}

/// Arguments: triangles, threads.
void contact_search_near(benchmark::State& state) {
  const TriangleMesh& mesh = benchmarks::bunny(static_cast<Index>(state.range(0)));
  const ThreadLimit limit(static_cast<int>(state.range(1)));
  const ObstacleSet obstacles(
      {Obstacle{.name = "bunny", .geometry = MeshGeometry{std::make_shared<const TriangleMesh>(mesh), true}}});
  const ObstacleFrame frame(obstacles, 0.0, 0.0);
  const Cloth cloth = cloth_on(mesh);
  std::size_t contacts = 0;
  for (auto _ : state) contacts = frame.contacts({cloth.before, cloth.after, cloth.thickness, kMargin}).size();
  report(state, contacts);
}

void truncation_near(benchmark::State& state) {
  const TriangleMesh& mesh = benchmarks::bunny(static_cast<Index>(state.range(0)));
  const ThreadLimit limit(static_cast<int>(state.range(1)));
  const ObstacleSet obstacles(
      {Obstacle{.name = "bunny", .geometry = MeshGeometry{std::make_shared<const TriangleMesh>(mesh), true}}});
  const ObstacleFrame frame(obstacles, 0.0, 0.0);
  const Cloth cloth = cloth_on(mesh);
  StepTruncation space(obstacles,
                       make_collision_surface({}, cloth.before, std::vector<Index>(kParticles, 0), cloth.thickness,
                                              ParticleMotions(kParticles), {0}, {0}),
                       cloth.before, kMargin);
  TruncationResult truncation;
  for (auto _ : state) {
    Points after = cloth.after;
    truncation = space.truncate(frame, cloth.before, after);
  }
  report(state, static_cast<std::size_t>(truncation.truncated));
}

void contact_search_far(benchmark::State& state) {
  const TriangleMesh& mesh = benchmarks::bunny(static_cast<Index>(state.range(0)));
  const ThreadLimit limit(static_cast<int>(state.range(1)));
  const ObstacleSet obstacles(
      {Obstacle{.name = "bunny", .geometry = MeshGeometry{std::make_shared<const TriangleMesh>(mesh), true}}});
  const ObstacleFrame frame(obstacles, 0.0, 0.0);
  Cloth cloth = cloth_on(mesh);
  cloth.before.row(1).array() += 3.0;
  cloth.after.row(1).array() += 3.0;
  std::size_t contacts = 0;
  for (auto _ : state) contacts = frame.contacts({cloth.before, cloth.after, cloth.thickness, kMargin}).size();
  report(state, contacts);
}

/// The search that FCL offers: one sphere per particle against its tree of oriented boxes. Arguments: triangles, largest number of
/// contacts. A single contact is any one of them; the deepest is known only if all are found.
void fcl_collide_near(benchmark::State& state) {
  const TriangleMesh& mesh = benchmarks::bunny(static_cast<Index>(state.range(0)));
  const Cloth cloth = cloth_on(mesh);
  fcl::BVHModel<fcl::OBB<double>> model;
  std::vector<fcl::Vector3<double>> vertices;
  std::vector<fcl::Triangle> triangles;
  for (Index i = 0; i < mesh.vertices.cols(); ++i) vertices.emplace_back(mesh.vertices.col(i));
  for (Index t = 0; t < mesh.triangles.cols(); ++t) {
    triangles.emplace_back(mesh.triangles(0, t), mesh.triangles(1, t), mesh.triangles(2, t));
  }
  model.beginModel();
  model.addSubModel(vertices, triangles);
  model.endModel();
  const fcl::Sphere<double> sphere(kThickness + kMargin);
  const fcl::CollisionRequest<double> request(static_cast<std::size_t>(state.range(1)), true);
  std::size_t contacts = 0;
  for (auto _ : state) {
    contacts = 0;
    for (Index i = 0; i < kParticles; ++i) {
      RigidTransform pose = RigidTransform::Identity();
      pose.translation() = cloth.after.col(i);
      fcl::CollisionResult<double> result;
      contacts += fcl::collide(&sphere, pose, &model, RigidTransform(RigidTransform::Identity()), request, result) > 0;
    }
  }
  report(state, contacts);
}

const std::vector<std::int64_t> kTriangles{3700, 14700, 59000, 70000, 236000, 280000};

BENCHMARK(contact_search_near)->ArgNames({"triangles", "threads"})->ArgsProduct({kTriangles, {1, 2}})->UseRealTime();
BENCHMARK(contact_search_far)->ArgNames({"triangles", "threads"})->ArgsProduct({{59000}, {1, 2}})->UseRealTime();
BENCHMARK(truncation_near)->ArgNames({"triangles", "threads"})->ArgsProduct({{59000}, {1, 2}})->UseRealTime();
BENCHMARK(fcl_collide_near)->ArgNames({"triangles", "max_contacts"})->ArgsProduct({kTriangles, {1, 100}})->UseRealTime();

}  // namespace
}  // namespace sprung
