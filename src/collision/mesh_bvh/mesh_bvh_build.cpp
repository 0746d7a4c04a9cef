#include "collision/mesh_bvh/mesh_bvh_build.h"

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

// Cost of a visit to a block, relative to a visit to a node.
constexpr double kBlockCost = 1.5;

double half_area(const fcl::AABB<double>& box) {
  const fcl::Vector3<double> size = box.max_ - box.min_;
  return size[0] * size[1] + size[1] * size[2] + size[2] * size[0];
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

WideBvhCollapse::WideBvhCollapse(const Tree& tree) : tree_(tree), costs_(static_cast<std::size_t>(tree.getNumBVs())) {
  const double whole = half_area(tree.getBV(0).bv);
  for (int bv = tree.getNumBVs() - 1; bv >= 0; --bv) {  // FCL numbers children after their parents
    Costs& costs = costs_[static_cast<std::size_t>(bv)];
    const double area = whole > 0.0 ? half_area(tree.getBV(bv).bv) / whole : 1.0;
    if (is_block(bv)) {
      costs.fill(static_cast<float>(kBlockCost * area));
      continue;
    }
    const int first_child = tree.getBV(bv).first_child;
    costs[0] = static_cast<float>(area) + best_share(first_child, kFloatSimdWidth).cost;
    for (int lanes = 2; lanes < kFloatSimdWidth; ++lanes) {
      costs[lanes - 1] = std::min(costs[lanes - 2], best_share(first_child, lanes).cost);
    }
  }
}

std::vector<int> WideBvhCollapse::children(int bv) const {
  std::vector<int> found;
  const int first_child = tree_.getBV(bv).first_child;
  const int first_lanes = best_share(first_child, kFloatSimdWidth).first_lanes;
  gather(first_child, first_lanes, found);
  gather(first_child + 1, kFloatSimdWidth - first_lanes, found);
  return found;
}

WideBvhCollapse::Share WideBvhCollapse::best_share(int first_child, int lanes) const {
  const Costs& first = costs_[static_cast<std::size_t>(first_child)];
  const Costs& second = costs_[static_cast<std::size_t>(first_child) + 1];
  Share best{1, std::numeric_limits<float>::infinity()};
  for (int first_lanes = 1; first_lanes < lanes; ++first_lanes) {
    const float cost = first[first_lanes - 1] + second[lanes - first_lanes - 1];
    if (cost < best.cost) best = {first_lanes, cost};
  }
  return best;
}

void WideBvhCollapse::gather(int bv, int lanes, std::vector<int>& children) const {
  const Costs& costs = costs_[static_cast<std::size_t>(bv)];
  if (is_block(bv) || costs[lanes - 1] == costs[0]) {
    children.push_back(bv);
    return;
  }
  const int first_child = tree_.getBV(bv).first_child;
  const int first_lanes = best_share(first_child, lanes).first_lanes;
  gather(first_child, first_lanes, children);
  gather(first_child + 1, lanes - first_lanes, children);
}

}  // namespace sprung
