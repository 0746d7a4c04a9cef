#include "dynamics/numerics/supernodes.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

#include <algorithm>
#include <utility>

namespace sprung {
namespace {

/// order[k] is the row that is eliminated k-th.
std::vector<Index> minimum_degree_order(const MatrixGraph& graph) {
  std::vector<Eigen::Triplet<double>> entries;
  for (Index i = 0; i < graph.size(); ++i) {
    entries.emplace_back(i, i, 1.0);
    for (Index k = graph.begin[i]; k < graph.begin[i + 1]; ++k) entries.emplace_back(i, graph.others[k], 1.0);
  }
  Eigen::SparseMatrix<double> matrix(graph.size(), graph.size());
  matrix.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, Index> order;
  Eigen::AMDOrdering<Index>()(matrix, order);
  return {order.indices().begin(), order.indices().end()};
}

std::vector<Index> inverse(const std::vector<Index>& order) {
  std::vector<Index> position(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) position[order[k]] = static_cast<Index>(k);
  return position;
}

/// Supernodes of one column each, numbered in the order of elimination. Their rows use the same numbers and are not sorted.
class EliminationTree {
 public:
  EliminationTree(const MatrixGraph& graph, const std::vector<Index>& order)
      : nodes_(order.size()), children_(order.size()), seen_by_(order.size(), kNone) {
    const std::vector<Index> position = inverse(order);
    for (Index j = 0; j < graph.size(); ++j) {
      nodes_[j].columns = {j};
      for (Index k = graph.begin[order[j]]; k < graph.begin[order[j] + 1]; ++k) see(position[graph.others[k]], j);
      // An eliminated row couples all rows that it was coupled to.
      for (const Index child : children_[j]) {
        for (const Index row : nodes_[child].rows) see(row, j);
      }
      if (nodes_[j].rows.empty()) continue;
      nodes_[j].parent = std::ranges::min(nodes_[j].rows);
      children_[nodes_[j].parent].push_back(j);
    }
  }

  std::vector<Supernode>& nodes() { return nodes_; }
  [[nodiscard]] const std::vector<std::vector<Index>>& children() const { return children_; }

 private:
  void see(Index row, Index by) {
    if (row <= by || seen_by_[row] == by) return;
    seen_by_[row] = by;
    nodes_[by].rows.push_back(row);
  }

  std::vector<Supernode> nodes_;
  std::vector<std::vector<Index>> children_;
  std::vector<Index> seen_by_;
};

/// Estimates the work of a supernode in multiplications: its panel, the products of its update, and their sums.
double cost(std::size_t columns, std::size_t rows) {
  constexpr double kSum = 6.0;       // a scattered sum in the parent costs as much as this many products
  constexpr double kStart = 2000.0;  // fixed cost of a supernode; half or twice this value makes no measurable difference
  const double width = 3.0 * static_cast<double>(columns);
  const double below = 3.0 * static_cast<double>(rows);
  return width * (width * width / 6.0 + 0.5 * below * (width + below)) +
         kSum * (0.5 * below * below + width * (0.5 * width + below)) + kStart;
}

/// Merges children into their parents where that costs less. A merged supernode has no columns.
void join(std::vector<Supernode>& nodes, const std::vector<std::vector<Index>>& children) {
  std::vector<std::vector<Index>> left = children;
  for (std::size_t j = 0; j < nodes.size(); ++j) {
    Supernode& parent = nodes[j];
    std::vector<Index> kept;
    for (std::size_t c = 0; c < left[j].size(); ++c) {
      Supernode& child = nodes[left[j][c]];
      const std::size_t both = child.columns.size() + parent.columns.size();
      const double apart = cost(child.columns.size(), child.rows.size()) + cost(parent.columns.size(), parent.rows.size());
      if (cost(both, parent.rows.size()) > apart) {
        kept.push_back(left[j][c]);
        continue;
      }
      child.columns.insert(child.columns.end(), parent.columns.begin(), parent.columns.end());
      parent.columns = std::exchange(child.columns, {});
      child.rows.clear();
      // The grandchildren may be merged with the parent in turn.
      left[j].insert(left[j].end(), left[left[j][c]].begin(), left[left[j][c]].end());
    }
    left[j] = kept;
    for (const Index child : kept) nodes[child].parent = static_cast<Index>(j);
  }
}

/// The supernodes that are left, children right before their parents.
std::vector<Index> postorder(const std::vector<Supernode>& nodes) {
  std::vector<std::vector<Index>> children(nodes.size());
  std::vector<Index> open;
  for (std::size_t j = 0; j < nodes.size(); ++j) {
    if (nodes[j].columns.empty()) continue;
    (nodes[j].parent == kNone ? open : children[nodes[j].parent]).push_back(static_cast<Index>(j));
  }
  // This order is reversed: parents first, their last children next.
  std::vector<Index> order;
  while (!open.empty()) {
    const Index node = open.back();
    open.pop_back();
    order.push_back(node);
    open.insert(open.end(), children[node].begin(), children[node].end());
  }
  std::ranges::reverse(order);
  return order;
}

}  // namespace

std::vector<Supernode> find_supernodes(const MatrixGraph& graph) {
  const std::vector<Index> order = minimum_degree_order(graph);
  EliminationTree tree(graph, order);
  std::vector<Supernode>& nodes = tree.nodes();
  join(nodes, tree.children());

  const std::vector<Index> left = postorder(nodes);
  std::vector<Index> number(nodes.size(), kNone);
  std::vector<Index> position(nodes.size());
  Index eliminated = 0;
  for (std::size_t k = 0; k < left.size(); ++k) {
    number[left[k]] = static_cast<Index>(k);
    for (const Index column : nodes[left[k]].columns) position[column] = eliminated++;
  }
  std::vector<Supernode> found;
  for (const Index j : left) {
    Supernode& node = found.emplace_back(std::move(nodes[j]));
    if (node.parent != kNone) node.parent = number[node.parent];
    std::ranges::sort(node.rows, {}, [&](Index row) { return position[row]; });
    for (std::vector<Index>* const rows : {&node.columns, &node.rows}) {
      for (Index& row : *rows) row = order[row];
    }
  }
  return found;
}

}  // namespace sprung
