#include "collision/element_bvh/element_bvh.h"

#include "base/parallel.h"
#include "collision/core/block_bounds.h"
#include "geometry/mesh/triangle_mesh.h"

#include <algorithm>

namespace sprung {
namespace {

constexpr Index kLeavesPerTask = 64;

// Approximate number of tasks that the traversal is divided into.
constexpr std::size_t kTasks = 128;

}  // namespace

ElementBvh::ElementBvh(const CollisionSurface& surface, const Points& rest)
    : surface_(surface), origin_(bounds(rest).center()), slots_(surface.elements.size()) {
  const std::vector<Element>& elements = surface.elements;
  const Points middles = element_middles(elements, rest);
  std::vector<Index> order(elements.size());
  for (std::size_t e = 0; e < order.size(); ++e) order[e] = static_cast<Index>(e);
  first_leaf_.push_back(0);
  for (std::size_t begin = 0; begin < elements.size();) {
    std::size_t end = begin;
    while (end < elements.size() && elements[end].body == elements[begin].body) ++end;
    std::vector<std::size_t> starts;
    bisect(middles, kFloatSimdWidth, order, begin, end, starts);
    starts.push_back(end);
    for (std::size_t k = 0; k + 1 < starts.size(); ++k) add_leaf(order, starts[k], starts[k + 1]);
    first_leaf_.push_back(static_cast<Index>(leaves_.size()));
    begin = end;
  }
  node_of_leaf_.resize(leaves_.size());
  if (!leaves_.empty()) add_bodies(0, first_leaf_.size() - 1);
}

void ElementBvh::add_leaf(const std::vector<Index>& order, std::size_t begin, std::size_t end) {
  ElementBvhLeaf leaf;
  std::copy(order.begin() + static_cast<std::ptrdiff_t>(begin), order.begin() + static_cast<std::ptrdiff_t>(end),
            leaf.element.begin());
  leaf.count = static_cast<int>(end - begin);
  for (int lane = 0; lane < leaf.count; ++lane) {
    const Index number = leaf.element[static_cast<std::size_t>(lane)];
    slots_[static_cast<std::size_t>(number)] = {static_cast<Index>(leaves_.size()), lane};
  }
  leaves_.push_back(leaf);
}

Index ElementBvh::add_bodies(std::size_t begin, std::size_t end) {
  const Index first = first_leaf_[begin];
  if (end - begin == 1) {
    const Index element = leaves_[static_cast<std::size_t>(first)].element[0];
    return add_node(first, first_leaf_[end], surface_.elements[static_cast<std::size_t>(element)].body);
  }
  const auto number = static_cast<std::size_t>(nodes_.size());
  nodes_.emplace_back();
  const std::size_t middle = begin + (end - begin) / 2;
  const Index left = add_bodies(begin, middle);
  const Index right = add_bodies(middle, end);
  nodes_[number].left = left;
  nodes_[number].right = right;
  nodes_[number].leaves = first_leaf_[end] - first;
  return static_cast<Index>(number);
}

Index ElementBvh::add_node(Index begin, Index end, Index body) {
  const auto number = static_cast<std::size_t>(nodes_.size());
  nodes_.emplace_back();
  nodes_[number].leaves = end - begin;
  nodes_[number].body = body;
  if (end - begin == 1) {
    nodes_[number].leaf = begin;
    node_of_leaf_[static_cast<std::size_t>(begin)] = static_cast<Index>(number);
  } else {
    const Index middle = begin + (end - begin) / 2;
    const Index left = add_node(begin, middle, body);
    const Index right = add_node(middle, end, body);
    nodes_[number].left = left;
    nodes_[number].right = right;
  }
  return static_cast<Index>(number);
}

void ElementBvh::mark(const std::vector<Index>& elements) {
  mark_lanes(elements);
  bound_marked();
}

void ElementBvh::mark_lanes(const std::vector<Index>& elements) {
  for (const Index number : marked_) own_leaf(number).marked = ElementBvhLeaf::IntLanes{};
  marked_.clear();
  for (const Index element : elements) {
    const Slot slot = slots_[static_cast<std::size_t>(element)];
    if (!leaf(slot.leaf).any_marked()) marked_.push_back(slot.leaf);
    own_leaf(slot.leaf).marked[slot.lane] = -1;
  }
  for (Node& node : nodes_) node.marked = false;
  for (const Index number : marked_)
    nodes_[static_cast<std::size_t>(node_of_leaf_[static_cast<std::size_t>(number)])].marked = true;
  for (std::size_t k = nodes_.size(); k-- > 0;) {
    Node& node = nodes_[k];
    if (node.leaf == kNone) node.marked = this->node(node.left).marked || this->node(node.right).marked;
  }
}

void ElementBvh::bound(const VertexBounds& spheres, const std::vector<char>& flat, const std::vector<Index>& elements,
                       HorizonTimes times) {
  mark_lanes(elements);
  parallel_chunks(static_cast<Index>(marked_.size()), kLeavesPerTask, [&](Index begin, Index end) {
    for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k) {
      ElementBvhLeaf& leaf = own_leaf(marked_[k]);
      for (int lane = 0; lane < leaf.count; ++lane) {
        if (leaf.marked[lane] == 0) continue;
        const Index number = leaf.element[static_cast<std::size_t>(lane)];
        leaf.set(lane, number, surface_.elements[static_cast<std::size_t>(number)], spheres, origin_, flat, times);
      }
      leaf.bound();
    }
  });
  for (std::size_t k = nodes_.size(); k-- > 0;) {
    if (nodes_[k].marked) bound_node(nodes_[k]);
  }
  bound_marked();
}

void ElementBvh::bound_marked() {
  for (const Index number : marked_) own_leaf(number).bound_marked();
  for (std::size_t k = nodes_.size(); k-- > 0;) {
    Node& node = nodes_[k];
    if (!node.marked) continue;
    if (node.leaf != kNone) {
      node.marked_bounds = leaf(node.leaf).marked_bounds;
      continue;
    }
    const Node& left = this->node(node.left);
    const Node& right = this->node(node.right);
    node.marked_bounds = left.marked ? left.marked_bounds : right.marked_bounds;
    if (left.marked && right.marked) extend(node.marked_bounds, right.marked_bounds);
  }
}

void ElementBvh::bound_node(Node& node) const {
  if (node.leaf != kNone) {
    node.bounds = leaf(node.leaf).bounds;
    return;
  }
  node.bounds = this->node(node.left).bounds;
  extend(node.bounds, this->node(node.right).bounds);
}

std::vector<ElementBvh::LeafPair> ElementBvh::find_pairs(HorizonTimes times, double margin) const {
  const Search search{static_cast<float>(times.now), static_cast<float>(times.end), static_cast<float>(margin)};
  const std::vector<NodePair> tasks = find_tasks(search);
  return collect_from_chunks<LeafPair>(static_cast<Index>(tasks.size()), 1, [&](Index task, Index, std::vector<LeafPair>& found) {
    traverse(tasks[static_cast<std::size_t>(task)], search, found);
  });
}

std::vector<ElementBvh::NodePair> ElementBvh::find_tasks(const Search& search) const {
  std::vector<NodePair> tasks;
  if (!nodes_.empty()) tasks.push_back({0, 0});
  for (std::size_t last = 0; tasks.size() > last && tasks.size() < kTasks;) {
    last = tasks.size();
    std::vector<NodePair> opened;
    for (const NodePair& pair : tasks) {
      if (may_touch(pair, search)) open(pair, opened);
    }
    tasks = std::move(opened);
  }
  return tasks;
}

bool ElementBvh::may_touch(NodePair pair, const Search& search) const {
  const Node& a = node(pair.a);
  const Node& b = node(pair.b);
  if (!a.marked && !b.marked) return false;
  if (!bodies_may_collide(a.body, b.body)) return false;
  if (pair.a == pair.b) return true;
  const auto near = [&](const KineticAabb& own, const KineticAabb& other) {
    return !are_apart(own, other, search.now, search.end, search.margin);
  };
  return (a.marked && near(a.marked_bounds, b.bounds)) || (b.marked && near(a.bounds, b.marked_bounds));
}

bool ElementBvh::bodies_may_collide(Index a, Index b) const {
  if (a == kNone || b == kNone) return true;
  if (a == b) return surface_.self[static_cast<std::size_t>(a)] != 0;
  return surface_.others[static_cast<std::size_t>(a)] != 0 && surface_.others[static_cast<std::size_t>(b)] != 0;
}

/// Appends the pairs of children. A pair of leaves is appended itself.
void ElementBvh::open(NodePair pair, std::vector<NodePair>& pairs) const {
  const Node& a = node(pair.a);
  const Node& b = node(pair.b);
  if (a.leaf != kNone && b.leaf != kNone) {
    pairs.push_back(pair);
  } else if (pair.a == pair.b) {
    pairs.insert(pairs.end(), {{a.left, a.left}, {a.right, a.right}, {a.left, a.right}});
  } else if (a.leaves >= b.leaves) {
    pairs.insert(pairs.end(), {{a.left, pair.b}, {a.right, pair.b}});
  } else {
    pairs.insert(pairs.end(), {{pair.a, b.left}, {pair.a, b.right}});
  }
}

void ElementBvh::traverse(NodePair pair, const Search& search, std::vector<LeafPair>& found) const {
  std::vector<NodePair> stack{pair};
  while (!stack.empty()) {
    const NodePair top = stack.back();
    stack.pop_back();
    if (!may_touch(top, search)) continue;
    if (node(top.a).leaf != kNone && node(top.b).leaf != kNone) {
      found.push_back({node(top.a).leaf, node(top.b).leaf});
    } else {
      open(top, stack);
    }
  }
}

}  // namespace sprung
