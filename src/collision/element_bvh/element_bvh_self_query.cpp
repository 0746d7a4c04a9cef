// Self-overlap query: the tree is traversed against itself.
#include "base/parallel.h"
#include "collision/element_bvh/element_bvh.h"

namespace sprung {
namespace {

// Approximate number of tasks that the traversal is divided into.
constexpr std::size_t kTasks = 128;

}  // namespace

std::vector<ElementBvh::LeafPair> ElementBvh::find_pairs(HorizonTimes times, double margin) const {
  const Search search{static_cast<float>(times.now), static_cast<float>(times.end), static_cast<float>(margin)};
  const std::vector<NodePair> tasks = find_tasks(search);
  std::vector<std::vector<LeafPair>> batches(tasks.size());
  parallel_chunks(static_cast<Index>(tasks.size()), 1, [&](Index begin, Index end) {
    for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k) traverse(tasks[k], search, batches[k]);
  });
  std::vector<LeafPair> found;
  for (const std::vector<LeafPair>& batch : batches) found.insert(found.end(), batch.begin(), batch.end());
  return found;
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
