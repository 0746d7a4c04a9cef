#include "collision/mesh_bvh/mesh_bvh.h"

#include "base/parallel.h"
#include "collision/mesh_bvh/sah_splitter.h"
#include "collision/mesh_bvh/wide_bvh_collapse.h"

#include <fcl/math/bv/utility.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sprung {

namespace {

constexpr Index kNodesPerTask = 512;
constexpr Index kBlocksPerTask = 1024;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

float rounded_down(double value) {
  const auto nearest = static_cast<float>(value);
  return static_cast<double>(nearest) > value ? std::nextafter(nearest, -kInfinity) : nearest;
}

float rounded_up(double value) { return -rounded_down(-value); }

void fill_lanes(const TriangleMesh& mesh, TrianglePacket& block) {
  for (int lane = 0; lane < kSimdWidth; ++lane) {
    const auto corner = mesh.triangles.col(block.triangle[lane]);
    for (int k = 0; k < 3; ++k) {
      for (int axis = 0; axis < 3; ++axis) block.corner[k][axis][lane] = mesh.vertices(axis, corner[k]);
    }
  }
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
  model->bv_splitter = std::make_shared<SahSplitter>();
  model->beginModel(static_cast<int>(triangles.size()), static_cast<int>(vertices.size()));
  model->addSubModel(vertices, triangles);
  model->endModel();
  return model;
}

}  // namespace

MeshBvh::MeshBvh(const TriangleMesh& mesh) : model_(build_model(mesh)), magnitude_(mesh.vertices.cwiseAbs().maxCoeff()) {
  slots_.resize(static_cast<std::size_t>(mesh.triangles.cols()));
  add_node(WideBvhCollapse(*model_), 0, 1);
  set_positions(mesh);
}

std::array<Vector3, 3> MeshBvh::corners(Index triangle) const {
  const Slot& slot = slots_[static_cast<std::size_t>(triangle)];
  return block(slot.block).corners(slot.lane);
}

Box3 MeshBvh::bounds() const {
  const fcl::AABB<double>& root = model_->getBV(0).bv;
  return {root.min_, root.max_};
}

// FCL refits the model of a moving mesh to the vertices of two frames, the previous and the present one.
void MeshBvh::refit(const Points& from, const Points& to) {
  model_->beginUpdateModel();
  for (Index i = 0; i < from.cols(); ++i) {
    model_->prev_vertices[i] = from.col(i);
    model_->updateVertex(to.col(i));
  }
  model_->endUpdateModel();
  const Box3 box = bounds();
  magnitude_ = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
  parallel_chunks(static_cast<Index>(nodes_.size()), kNodesPerTask, [&](Index begin, Index end) {
    for (Index node = begin; node < end; ++node) fit_boxes(static_cast<std::size_t>(node));
  });
}

void MeshBvh::take_boxes(const MeshBvh& refitted) {
  nodes_ = refitted.nodes_;
  magnitude_ = refitted.magnitude_;
}

void MeshBvh::set_positions(const TriangleMesh& mesh) {
  parallel_chunks(static_cast<Index>(blocks_.size()), kBlocksPerTask, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) fill_lanes(mesh, blocks_[static_cast<std::size_t>(i)]);
  });
}

void MeshBvh::fit_boxes(std::size_t node) {
  for (int lane = 0; lane < kFloatSimdWidth; ++lane) {
    const Index volume = volumes_[node][static_cast<std::size_t>(lane)];
    for (int axis = 0; axis < 3; ++axis) {
      nodes_[node].min[axis][lane] = volume != kNone ? rounded_down(model_->getBV(volume).bv.min_[axis]) : kInfinity;
      nodes_[node].max[axis][lane] = volume != kNone ? rounded_up(model_->getBV(volume).bv.max_[axis]) : -kInfinity;
    }
  }
}

std::int32_t MeshBvh::add_node(const WideBvhCollapse& collapse, int volume, int depth) {
  const auto number = nodes_.size();
  const std::vector<int> children = collapse.is_block(volume) ? std::vector<int>{volume} : collapse.children(volume);
  nodes_.emplace_back();
  volumes_.emplace_back().fill(kNone);
  std::copy(children.begin(), children.end(), volumes_.back().begin());
  fit_boxes(number);
  // A traversal leaves all lanes of a node but one on the stack, at each level. A push writes up to all lanes past the top.
  stack_size_ = std::max(stack_size_, static_cast<std::size_t>((depth + 1) * kFloatSimdWidth));
  for (std::size_t lane = 0; lane < children.size(); ++lane) {
    const int below = children[lane];
    const std::int32_t child = collapse.is_block(below) ? ~add_block(below) : add_node(collapse, below, depth + 1);
    nodes_[number].child[lane] = child;
  }
  return static_cast<std::int32_t>(number);
}

std::int32_t MeshBvh::add_block(int volume) {
  const auto number = static_cast<std::int32_t>(blocks_.size());
  TrianglePacket& block = blocks_.emplace_back();
  for (std::vector<int> waiting{volume}; !waiting.empty();) {
    const int first_child = model_->getBV(waiting.back()).first_child;
    waiting.pop_back();
    if (first_child >= 0) {
      waiting.insert(waiting.end(), {first_child + 1, first_child});
      continue;
    }
    const Index triangle = -first_child - 1;
    slots_[static_cast<std::size_t>(triangle)] = {number, block.count};
    block.triangle[block.count++] = triangle;
  }
  // Lanes beyond `count` repeat the last triangle.
  for (int lane = block.count; lane < kSimdWidth; ++lane) block.triangle[lane] = block.triangle[block.count - 1];
  return number;
}

}  // namespace sprung
