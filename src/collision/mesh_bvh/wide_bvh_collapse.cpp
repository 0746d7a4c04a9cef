#include "collision/mesh_bvh/wide_bvh_collapse.h"

#include <limits>

namespace sprung {

namespace {

// Cost of a visit to a block, relative to a visit to a node.
constexpr double kBlockCost = 1.5;

double half_area(const fcl::AABB<double>& box) {
  const fcl::Vector3<double> size = box.max_ - box.min_;
  return size[0] * size[1] + size[1] * size[2] + size[2] * size[0];
}

}  // namespace

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
