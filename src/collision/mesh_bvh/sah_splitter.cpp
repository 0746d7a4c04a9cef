#include "collision/mesh_bvh/sah_splitter.h"

#include <algorithm>
#include <array>
#include <limits>

namespace sprung {

namespace {

constexpr int kBins = 16;

struct Bin {
  Box3 box;
  int count = 0;

  void add(const Bin& other) {
    box.extend(other.box);
    count += other.count;
  }

  [[nodiscard]] double cost() const {
    if (count == 0) return 0.0;
    const Vector3 size = box.sizes();
    return count * (size[0] * size[1] + size[1] * size[2] + size[2] * size[0]);
  }
};

using Bins = std::array<Bin, kBins>;

struct Cut {
  int bins_before = 0;
  double cost = std::numeric_limits<double>::infinity();
};

Cut cheapest_cut(const Bins& bins) {
  std::array<double, kBins> cost_after{};
  Bin after;
  for (std::size_t i = kBins - 1; i > 0; --i) {
    after.add(bins[i]);
    cost_after[i] = after.cost();
  }
  Cut cheapest;
  Bin before;
  for (std::size_t i = 1; i < kBins; ++i) {
    before.add(bins[i - 1]);
    const double cost = before.cost() + cost_after[i];
    if (cost < cheapest.cost) cheapest = {static_cast<int>(i), cost};
  }
  return cheapest;
}

}  // namespace

void SahSplitter::set(fcl::Vector3<double>* vertices, fcl::Triangle* triangles, fcl::BVHModelType /*type*/) {
  vertices_ = vertices;
  triangles_ = triangles;
}

void SahSplitter::clear() {
  vertices_ = nullptr;
  triangles_ = nullptr;
}

void SahSplitter::computeRule(const fcl::AABB<double>& /*box*/, unsigned int* triangles, int count) {
  Box3 middles;
  for (int i = 0; i < count; ++i) middles.extend(middle(triangles[i]));
  const Vector3 size = middles.sizes();

  const double length = size.maxCoeff(&axis_);
  if (!(length > 0.0)) return;  // FCL then halves the set by number

  Bins bins;
  for (int i = 0; i < count; ++i) {
    const double fraction = (middle(triangles[i])[axis_] - middles.min()[axis_]) / length;
    bins[std::min<std::size_t>(static_cast<std::size_t>(kBins * fraction), kBins - 1)].add({box(triangles[i]), 1});
  }
  cut_ = middles.min()[axis_] + length * cheapest_cut(bins).bins_before / kBins;
}

Vector3 SahSplitter::middle(unsigned int triangle) const {
  const fcl::Triangle& corner = triangles_[triangle];
  return (vertices_[corner[0]] + vertices_[corner[1]] + vertices_[corner[2]]) / 3.0;
}

Box3 SahSplitter::box(unsigned int triangle) const {
  const fcl::Triangle& corner = triangles_[triangle];
  Box3 box(vertices_[corner[0]]);
  return box.extend(vertices_[corner[1]]).extend(vertices_[corner[2]]);
}

}  // namespace sprung
