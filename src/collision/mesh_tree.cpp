#include "collision/mesh_tree.h"

#include "base/parallel.h"

#include <fcl/math/bv/utility.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sprung {

namespace {

constexpr Index kNodesPerTask = 512;
constexpr Index kLeavesPerTask = 4096;

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
  leaf_of_.resize(leaves_.capacity());
  add_node({0}, 1);
}

std::array<Vector3, 3> MeshTree::corners(Index triangle) const {
  const Leaf& at = leaf(leaf_of_[static_cast<std::size_t>(triangle)]);
  return {at.a, at.b, at.c};
}

Box3 MeshTree::bounds() const {
  const fcl::AABB<double>& root = model_->getBV(0).bv;
  return {root.min_, root.max_};
}

// FCL refits the model of a moving mesh around the vertices of two frames, the one before and the present one.
void MeshTree::refit(const Points& from, const Points& to) {
  model_->beginUpdateModel();
  for (Index i = 0; i < from.cols(); ++i) {
    model_->prev_vertices[i] = from.col(i);
    model_->updateVertex(to.col(i));
  }
  model_->endUpdateModel();
  const Box3 box = bounds();
  model_->aabb_local = model_->getBV(0).bv;
  model_->aabb_center = box.center();
  model_->aabb_radius = 0.5 * box.diagonal().norm();
  magnitude_ = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
  parallel_chunks(static_cast<Index>(nodes_.size()), kNodesPerTask, [&](Index begin, Index end) {
    for (Index node = begin; node < end; ++node) fit_boxes(static_cast<std::size_t>(node));
  });
}

void MeshTree::set_positions(const Points& positions) {
  parallel_chunks(static_cast<Index>(leaves_.size()), kLeavesPerTask, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      Leaf& at = leaves_[static_cast<std::size_t>(i)];
      const fcl::Triangle& corner = model_->tri_indices[at.triangle];
      at.a = positions.col(static_cast<Index>(corner[0]));
      at.b = positions.col(static_cast<Index>(corner[1]));
      at.c = positions.col(static_cast<Index>(corner[2]));
    }
  });
}

void MeshTree::fit_boxes(std::size_t node) {
  for (int lane = 0; lane < kTreeLanes; ++lane) {
    const Index volume = volumes_[node][static_cast<std::size_t>(lane)];
    for (int axis = 0; axis < 3; ++axis) {
      nodes_[node].min[axis][lane] = volume != kNone ? rounded_down(model_->getBV(volume).bv.min_[axis]) : kInfinity;
      nodes_[node].max[axis][lane] = volume != kNone ? rounded_up(model_->getBV(volume).bv.max_[axis]) : -kInfinity;
    }
  }
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
  volumes_.emplace_back().fill(kNone);
  std::copy(children.begin(), children.end(), volumes_.back().begin());
  fit_boxes(nodes_.size() - 1);
  // Each level leaves all but one lane behind; appending writes one past the last kept.
  stack_size_ = std::max(stack_size_, static_cast<std::size_t>((depth + 1) * kTreeLanes));
  for (int lane = 0; lane < kTreeLanes; ++lane) {
    const bool used = lane < static_cast<int>(children.size());
    std::int32_t child = 0;
    if (used && opens(children[lane])) {
      child = add_node({tree.getBV(children[lane]).first_child, tree.getBV(children[lane]).first_child + 1}, depth + 1);
    } else if (used) {
      const Index triangle = -tree.getBV(children[lane]).first_child - 1;
      const fcl::Triangle& corner = tree.tri_indices[triangle];
      leaf_of_[static_cast<std::size_t>(triangle)] = static_cast<std::int32_t>(leaves_.size());
      child = ~leaf_of_[static_cast<std::size_t>(triangle)];
      leaves_.push_back({tree.vertices[corner[0]], tree.vertices[corner[1]], tree.vertices[corner[2]], triangle});
    }
    nodes_[number].child[lane] = child;
  }
  return number;
}

}  // namespace sprung
