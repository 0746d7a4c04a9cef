// Contact search against the bunny at 4 k, 70 k and 280 k triangles, beside fcl::collide per particle in the same run.
#include "base/parallel.h"
#include "collision/environment.h"
#include "collision/sample_meshes.h"
#include "geometry/topology.h"

#include <benchmark/benchmark.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>

#include <array>
#include <cmath>
#include <map>

namespace sprung {
namespace {

constexpr Index kParticles = 64 * 64;
constexpr double kThickness = 0.005;
constexpr double kMargin = 0.0025;

/// Vertices merged in cubes of `cell` [m], at their mean; triangles that lose a corner are dropped.
TriangleMesh clustered(const TriangleMesh& mesh, double cell) {
  std::map<std::array<Index, 3>, Index> numbers;
  std::vector<Index> number_of(static_cast<std::size_t>(mesh.vertices.cols()));
  std::vector<Vector3> sums;
  std::vector<double> counts;
  for (Index i = 0; i < mesh.vertices.cols(); ++i) {
    std::array<Index, 3> cube;
    for (int axis = 0; axis < 3; ++axis) cube[axis] = static_cast<Index>(std::floor(mesh.vertices(axis, i) / cell));
    const auto [found, added] = numbers.try_emplace(cube, static_cast<Index>(sums.size()));
    if (added) {
      sums.emplace_back(Vector3::Zero());
      counts.push_back(0.0);
    }
    number_of[i] = found->second;
    sums[found->second] += mesh.vertices.col(i);
    counts[found->second] += 1.0;
  }
  TriangleMesh result{Points(3, std::ssize(sums)), Triangles(3, mesh.triangles.cols())};
  for (std::size_t i = 0; i < sums.size(); ++i) result.vertices.col(i) = sums[i] / counts[i];
  Index kept = 0;
  for (Index t = 0; t < mesh.triangles.cols(); ++t) {
    const Index a = number_of[mesh.triangles(0, t)];
    const Index b = number_of[mesh.triangles(1, t)];
    const Index c = number_of[mesh.triangles(2, t)];
    if (a != b && b != c && c != a) result.triangles.col(kept++) << a, b, c;
  }
  result.triangles.conservativeResize(3, kept);
  return result;
}

/// Each triangle cut into four at the middles of its edges.
TriangleMesh subdivided(const TriangleMesh& mesh) {
  const Edges edges = unique_edges(mesh.triangles);
  const auto vertex_count = static_cast<Index>(mesh.vertices.cols());
  TriangleMesh result{Points(3, vertex_count + edges.cols()), Triangles(3, 4 * mesh.triangles.cols())};
  result.vertices.leftCols(vertex_count) = mesh.vertices;
  std::map<std::pair<Index, Index>, Index> middles;
  for (Index e = 0; e < edges.cols(); ++e) {
    middles[{edges(0, e), edges(1, e)}] = vertex_count + e;
    result.vertices.col(vertex_count + e) = 0.5 * (mesh.vertices.col(edges(0, e)) + mesh.vertices.col(edges(1, e)));
  }
  const auto middle = [&](Index a, Index b) { return middles.at({std::min(a, b), std::max(a, b)}); };
  for (Index t = 0; t < mesh.triangles.cols(); ++t) {
    const Index a = mesh.triangles(0, t);
    const Index b = mesh.triangles(1, t);
    const Index c = mesh.triangles(2, t);
    const Index ab = middle(a, b);
    const Index bc = middle(b, c);
    const Index ca = middle(c, a);
    result.triangles.col(4 * t) << a, ab, ca;
    result.triangles.col(4 * t + 1) << ab, b, bc;
    result.triangles.col(4 * t + 2) << ca, bc, c;
    result.triangles.col(4 * t + 3) << ab, bc, ca;
  }
  return result;
}

/// The bunny, 1 m in size, with about so many thousand triangles.
const TriangleMesh& bunny(int thousands) {
  static const auto meshes = [] {
    TriangleMesh whole = test::bunny();
    whole.vertices /= bounds(whole.vertices).sizes().maxCoeff();
    return std::map<int, TriangleMesh>{{4, clustered(whole, 0.026)}, {70, whole}, {280, subdivided(whole)}};
  }();
  return meshes.at(thousands);
}

/// Particles as a cloth has them when it lies on the mesh: rows of neighbours, at distances around the gap, moving little. A
/// cloth's rows are drawn by casting a grid of points onto the mesh from above.
struct Cloth {
  Points before;
  Points after;
  Scalars thickness = Scalars::Constant(kParticles, kThickness);
};

Cloth cloth_on(const TriangleMesh& mesh) {
  const Environment environment(
      {Obstacle{.name = "bunny", .geometry = MeshGeometry{std::make_shared<const TriangleMesh>(mesh), true}}});
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
  for (const Contact& contact : environment.contacts({above, cloth.before, cloth.thickness, 0.0})) {
    cloth.before.col(contact.particle) = contact.point + random.between(0.5, 1.5) * kThickness * contact.normal;
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

/// Arguments: thousands of triangles, threads.
void contact_search_near(benchmark::State& state) {
  const TriangleMesh& mesh = bunny(static_cast<int>(state.range(0)));
  const ThreadLimit limit(static_cast<int>(state.range(1)));
  const Environment environment(
      {Obstacle{.name = "bunny", .geometry = MeshGeometry{std::make_shared<const TriangleMesh>(mesh), true}}});
  const Cloth cloth = cloth_on(mesh);
  std::size_t contacts = 0;
  for (auto _ : state) contacts = environment.contacts({cloth.before, cloth.after, cloth.thickness, kMargin}).size();
  report(state, contacts);
}

void truncation_near(benchmark::State& state) {
  const TriangleMesh& mesh = bunny(static_cast<int>(state.range(0)));
  const ThreadLimit limit(static_cast<int>(state.range(1)));
  const Environment environment(
      {Obstacle{.name = "bunny", .geometry = MeshGeometry{std::make_shared<const TriangleMesh>(mesh), true}}});
  const Cloth cloth = cloth_on(mesh);
  const std::vector<char> held(kParticles, 0);
  std::size_t moved = 0;
  for (auto _ : state) {
    Points after = cloth.after;
    Index squeezed = 0;
    moved = environment.truncate(cloth.before, after, held, squeezed).size();
  }
  report(state, moved);
}

void contact_search_far(benchmark::State& state) {
  const TriangleMesh& mesh = bunny(static_cast<int>(state.range(0)));
  const ThreadLimit limit(static_cast<int>(state.range(1)));
  const Environment environment(
      {Obstacle{.name = "bunny", .geometry = MeshGeometry{std::make_shared<const TriangleMesh>(mesh), true}}});
  Cloth cloth = cloth_on(mesh);
  cloth.before.row(1).array() += 3.0;
  cloth.after.row(1).array() += 3.0;
  std::size_t contacts = 0;
  for (auto _ : state) contacts = environment.contacts({cloth.before, cloth.after, cloth.thickness, kMargin}).size();
  report(state, contacts);
}

/// What one writes without a search of one's own: a sphere a particle against FCL's tree of oriented boxes. Arguments: thousands of
/// triangles, contacts asked for. One contact is any of them; only all of them hold the deepest.
void fcl_collide_near(benchmark::State& state) {
  const TriangleMesh& mesh = bunny(static_cast<int>(state.range(0)));
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
      RigidTransform place = RigidTransform::Identity();
      place.translation() = cloth.after.col(i);
      fcl::CollisionResult<double> result;
      contacts += fcl::collide(&sphere, place, &model, RigidTransform(RigidTransform::Identity()), request, result) > 0;
    }
  }
  report(state, contacts);
}

BENCHMARK(contact_search_near)->ArgNames({"k_triangles", "threads"})->ArgsProduct({{4, 70, 280}, {1, 2}})->UseRealTime();
BENCHMARK(contact_search_far)->ArgNames({"k_triangles", "threads"})->ArgsProduct({{70}, {1, 2}})->UseRealTime();
BENCHMARK(truncation_near)->ArgNames({"k_triangles", "threads"})->ArgsProduct({{70}, {1, 2}})->UseRealTime();
BENCHMARK(fcl_collide_near)->ArgNames({"k_triangles", "max_contacts"})->ArgsProduct({{4, 70, 280}, {1, 100}})->UseRealTime();

}  // namespace
}  // namespace sprung
