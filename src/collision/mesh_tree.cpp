#include "collision/mesh_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sprung {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

float rounded_down(double value) {
  const auto nearest = static_cast<float>(value);
  return static_cast<double>(nearest) > value ? std::nextafter(nearest, -kInfinity) : nearest;
}

float rounded_up(double value) { return -rounded_down(-value); }

double half_area(const fcl::AABB<double>& box) {
  const Vector3 size = box.max_ - box.min_;
  return size[0] * size[1] + size[1] * size[2] + size[2] * size[0];
}

std::shared_ptr<fcl::BVHModel<fcl::AABB<double>>> build_model(const TriangleMesh& mesh) {
  std::vector<fcl::Vector3<double>> vertices(static_cast<std::size_t>(mesh.vertices.cols()));
  for (std::size_t i = 0; i < vertices.size(); ++i) vertices[i] = mesh.vertices.col(static_cast<Index>(i));
  std::vector<fcl::Triangle> triangles;
  triangles.reserve(static_cast<std::size_t>(mesh.triangles.cols()));
  for (Index t = 0; t < mesh.triangles.cols(); ++t) {
    const auto corner = mesh.triangles.col(t).cast<std::size_t>();
    triangles.emplace_back(corner[0], corner[1], corner[2]);
  }
  auto model = std::make_shared<fcl::BVHModel<fcl::AABB<double>>>();
  model->beginModel(static_cast<int>(triangles.size()), static_cast<int>(vertices.size()));
  model->addSubModel(vertices, triangles);
  model->endModel();
  return model;
}

}  // namespace

MeshTree::MeshTree(const TriangleMesh& mesh) : model_(build_model(mesh)), magnitude_(mesh.vertices.cwiseAbs().maxCoeff()) {
  leaves_.reserve(static_cast<std::size_t>(mesh.triangles.cols()));
  add_node({0}, 1);
}

std::array<Vector3, 3> MeshTree::corners(Index triangle) const {
  const fcl::Triangle& corner = model_->tri_indices[triangle];
  return {model_->vertices[corner[0]], model_->vertices[corner[1]], model_->vertices[corner[2]]};
}

std::int32_t MeshTree::add_node(const std::vector<int>& roots, int depth) {
  const auto& tree = *model_;
  const auto opens = [&](int bv) { return tree.getBV(bv).first_child >= 0; };
  std::vector<int> children = roots;
  while (children.size() < kTreeLanes) {
    const auto largest = std::max_element(children.begin(), children.end(), [&](int x, int y) {
      const auto rank = [&](int bv) { return opens(bv) ? half_area(tree.getBV(bv).bv) : -1.0; };
      return rank(x) < rank(y);
    });
    if (!opens(*largest)) break;
    const int first = tree.getBV(*largest).first_child;
    *largest = first;
    children.insert(largest + 1, first + 1);
  }

  const auto number = static_cast<std::int32_t>(nodes_.size());
  nodes_.emplace_back();
  // Each level leaves all but one lane behind; appending writes one past the last kept.
  stack_size_ = std::max(stack_size_, static_cast<std::size_t>((depth + 1) * kTreeLanes));
  for (int lane = 0; lane < kTreeLanes; ++lane) {
    const bool used = lane < static_cast<int>(children.size());
    for (int axis = 0; axis < 3; ++axis) {
      nodes_[number].min[axis][lane] = used ? rounded_down(tree.getBV(children[lane]).bv.min_[axis]) : kInfinity;
      nodes_[number].max[axis][lane] = used ? rounded_up(tree.getBV(children[lane]).bv.max_[axis]) : -kInfinity;
    }
    std::int32_t child = 0;
    if (used && opens(children[lane])) {
      child = add_node({tree.getBV(children[lane]).first_child, tree.getBV(children[lane]).first_child + 1}, depth + 1);
    } else if (used) {
      const Index triangle = -tree.getBV(children[lane]).first_child - 1;
      const fcl::Triangle& corner = tree.tri_indices[triangle];
      child = ~static_cast<std::int32_t>(leaves_.size());
      leaves_.push_back({tree.vertices[corner[0]], tree.vertices[corner[1]], tree.vertices[corner[2]], triangle});
    }
    nodes_[number].child[lane] = child;
  }
  return number;
}

}  // namespace sprung
