#include "collision/mesh_bvh/mesh_bvh.h"

#include "base/parallel.h"
#include "collision/mesh_bvh/mesh_bvh_build.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sprung {

namespace {

constexpr Index kBlocksPerTask = 1024;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

float rounded_down(double value) {
  const auto nearest = static_cast<float>(value);
  return static_cast<double>(nearest) > value ? std::nextafter(nearest, -kInfinity) : nearest;
}

float rounded_up(double value) { return -rounded_down(-value); }

void fill_lanes(const Points& vertices, const Triangles& triangles, TrianglePacket& block) {
  for (int lane = 0; lane < kSimdWidth; ++lane) {
    const auto corner = triangles.col(block.triangle[lane]);
    for (int k = 0; k < 3; ++k) {
      for (int axis = 0; axis < 3; ++axis) block.corner[k][axis][lane] = vertices(axis, corner[k]);
    }
  }
}

/// The box around the triangles of a block while their vertices are between `from` and `to` [m].
Box3 swept_box(const TrianglePacket& block, const Triangles& triangles, const Points& from, const Points& to) {
  Box3 box;
  for (int lane = 0; lane < block.count; ++lane) {
    for (const Index vertex : triangles.col(block.triangle[lane])) {
      box.extend(Vector3(from.col(vertex)));
      box.extend(Vector3(to.col(vertex)));
    }
  }
  return box;
}

/// Sets the box of a lane, rounded outward.
void set_box(const Box3& box, int lane, MeshBvh::Node& node) {
  for (int axis = 0; axis < 3; ++axis) {
    node.min[axis][lane] = rounded_down(box.min()[axis]);
    node.max[axis][lane] = rounded_up(box.max()[axis]);
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

MeshBvh::MeshBvh(const TriangleMesh& mesh) {
  auto topology = std::make_shared<Topology>();
  topology->model = build_model(mesh);
  topology->slots.resize(static_cast<std::size_t>(mesh.triangles.cols()));
  std::vector<Node> nodes;
  add_node(WideBvhCollapse(*topology->model), 0, 1, *topology, nodes);
  topology->node_count = nodes.size();
  slots_ = topology->slots.data();
  topology_ = std::move(topology);
  fit_boxes(mesh.triangles, mesh.vertices, mesh.vertices, std::move(nodes));
  magnitude_ = mesh.vertices.cwiseAbs().maxCoeff();
  set_positions(mesh.vertices, mesh.triangles);
}

std::array<Vector3, 3> MeshBvh::corners(Index triangle) const {
  const Slot& slot = slots_[triangle];
  return block(slot.block).corners(slot.lane);
}

void MeshBvh::refit(const Triangles& triangles, const Points& from, const Points& to) {
  fit_boxes(triangles, from, to, std::vector<Node>(nodes_.get(), nodes_.get() + topology_->node_count));
  magnitude_ = bounds_.min().cwiseAbs().cwiseMax(bounds_.max().cwiseAbs()).maxCoeff();
}

void MeshBvh::set_positions(const Points& vertices, const Triangles& triangles) {
  parallel_chunks(static_cast<Index>(blocks_.size()), kBlocksPerTask, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) fill_lanes(vertices, triangles, blocks_[static_cast<std::size_t>(i)]);
  });
}

void MeshBvh::fit_boxes(const Triangles& triangles, const Points& from, const Points& to, std::vector<Node> nodes) {
  std::vector<Box3> of_blocks(blocks_.size());
  parallel_chunks(static_cast<Index>(blocks_.size()), kBlocksPerTask, [&](Index begin, Index end) {
    for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
      of_blocks[i] = swept_box(blocks_[i], triangles, from, to);
    }
  });
  std::vector<Box3> of_nodes(nodes.size());
  for (std::size_t i = nodes.size(); i-- > 0;) {  // children first
    for (int lane = 0; lane < kFloatSimdWidth; ++lane) {
      const std::int32_t child = nodes[i].child[lane];
      if (child == 0) continue;
      const Box3& box = child < 0 ? of_blocks[static_cast<std::size_t>(~child)] : of_nodes[static_cast<std::size_t>(child)];
      set_box(box, lane, nodes[i]);
      of_nodes[i].extend(box);
    }
  }
  bounds_ = of_nodes.front();
  const auto owner = std::make_shared<const std::vector<Node>>(std::move(nodes));
  nodes_ = {owner, owner->data()};
}

std::int32_t MeshBvh::add_node(const WideBvhCollapse& collapse, int volume, int depth, Topology& topology,
                               std::vector<Node>& nodes) {
  const auto number = nodes.size();
  const std::vector<int> children = collapse.is_block(volume) ? std::vector<int>{volume} : collapse.children(volume);
  Node& node = nodes.emplace_back();
  for (int axis = 0; axis < 3; ++axis) {
    node.min[axis] = Float8{} + kInfinity;
    node.max[axis] = Float8{} - kInfinity;
  }
  // A traversal leaves all lanes of a node but one on the stack, at each level. A push writes up to all lanes past the top.
  topology.stack_size = std::max(topology.stack_size, static_cast<std::size_t>((depth + 1) * kFloatSimdWidth));
  for (std::size_t lane = 0; lane < children.size(); ++lane) {
    const int below = children[lane];
    const std::int32_t child =
        collapse.is_block(below) ? ~add_block(below, topology) : add_node(collapse, below, depth + 1, topology, nodes);
    nodes[number].child[lane] = child;
  }
  return static_cast<std::int32_t>(number);
}

std::int32_t MeshBvh::add_block(int volume, Topology& topology) {
  const auto number = static_cast<std::int32_t>(blocks_.size());
  TrianglePacket& block = blocks_.emplace_back();
  for (std::vector<int> waiting{volume}; !waiting.empty();) {
    const int first_child = topology.model->getBV(waiting.back()).first_child;
    waiting.pop_back();
    if (first_child >= 0) {
      waiting.insert(waiting.end(), {first_child + 1, first_child});
      continue;
    }
    const Index triangle = -first_child - 1;
    topology.slots[static_cast<std::size_t>(triangle)] = {number, block.count};
    block.triangle[block.count++] = triangle;
  }
  // Lanes beyond `count` repeat the last triangle.
  for (int lane = block.count; lane < kSimdWidth; ++lane) block.triangle[lane] = block.triangle[block.count - 1];
  return number;
}

}  // namespace sprung
