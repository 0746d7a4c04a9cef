#include "dynamics/numerics/front_layout.h"

#include "dynamics/numerics/supernodes.h"

#include <algorithm>
#include <array>

namespace sprung {
namespace {

Index tiles_of(std::size_t particles) { return static_cast<Index>((3 * particles + kSimdWidth - 1) / kSimdWidth); }

/// The coupling of the included particles, by their numbers.
MatrixGraph graph_of(const BlockMatrix& pattern, const std::vector<Index>& number, std::size_t count) {
  std::vector<std::vector<Index>> others(count);
  for (Index j = 0; j < pattern.size(); ++j) {
    pattern.for_column(j, [&](Index i, const Matrix3&) {
      if (number[i] == kNone || number[j] == kNone) return;
      others[number[i]].push_back(number[j]);
      others[number[j]].push_back(number[i]);
    });
  }
  MatrixGraph graph;
  for (const std::vector<Index>& row : others) {
    graph.others.insert(graph.others.end(), row.begin(), row.end());
    graph.begin.push_back(static_cast<Index>(graph.others.size()));
  }
  return graph;
}

/// Supernodes of particles.
std::vector<Supernode> supernodes_of(const BlockMatrix& pattern, const std::vector<bool>& left_out) {
  std::vector<Index> particles;
  std::vector<Index> number(pattern.size(), kNone);
  for (Index i = 0; i < pattern.size(); ++i) {
    if (!left_out.empty() && left_out[i]) continue;
    number[i] = static_cast<Index>(particles.size());
    particles.push_back(i);
  }
  std::vector<Supernode> nodes = find_supernodes(graph_of(pattern, number, particles.size()));
  for (Supernode& node : nodes) {
    for (std::vector<Index>* const rows : {&node.columns, &node.rows}) {
      for (Index& row : *rows) row = particles[row];
    }
  }
  return nodes;
}

template <class T>
Index count_of(const std::vector<T>& list) {
  return static_cast<Index>(list.size());
}

}  // namespace

Index FrontLayout::row_of(const Front& front, Index at) const {
  if (at < front.first_slot + front.shape.width()) return at - front.first_slot;
  const std::span<const Index> below = lower_of(front);
  return front.shape.width() + 3 * static_cast<Index>(std::ranges::lower_bound(below, at) - below.begin());
}

FrontLayout::FrontLayout(const BlockMatrix& pattern, const std::vector<bool>& left_out) : slot(pattern.size(), kNone) {
  const std::vector<Supernode> nodes = supernodes_of(pattern, left_out);
  make_fronts(nodes);
  position_updates(nodes);  // parents record where their children's updates are
  join_with_parents(nodes);
  make_entries(pattern, nodes);
}

void FrontLayout::make_fronts(const std::vector<Supernode>& nodes) {
  for (const Supernode& node : nodes) {
    Front& front = fronts.emplace_back();
    front.shape = {.own_tiles = tiles_of(node.columns.size()), .lower_tiles = tiles_of(node.rows.size())};
    front.own_rows = 3 * count_of(node.columns);
    front.first_slot = static_cast<Index>(vector_size);
    front.panel = panel_size;
    for (std::size_t k = 0; k < node.columns.size(); ++k) slot[node.columns[k]] = front.first_slot + 3 * static_cast<Index>(k);
    vector_size += static_cast<std::size_t>(front.shape.width());
    panel_size += front.shape.size();
  }
  for (std::size_t f = 0; f < fronts.size(); ++f) {
    fronts[f].lower.begin = count_of(lower);
    for (const Index row : nodes[f].rows) lower.push_back(slot[row]);
    fronts[f].lower.end = count_of(lower);
  }
}

// Updates are consumed in the reverse order of their creation, but a front's update is created while its children's still exist.
// Fronts at even and odd depths of the tree therefore use two stacks.
void FrontLayout::position_updates(const std::vector<Supernode>& nodes) {
  std::vector<Index> depth(fronts.size(), 0);
  std::vector<Index> first_child(fronts.size(), kNone);
  for (std::size_t f = fronts.size(); f-- > 0;) {
    if (nodes[f].parent == kNone) continue;
    depth[f] = depth[nodes[f].parent] + 1;
    first_child[nodes[f].parent] = static_cast<Index>(f);
  }
  std::array<std::size_t, 2> top{};
  std::array<std::size_t, 2> most{};
  for (std::size_t f = 0; f < fronts.size(); ++f) {
    const auto stack = static_cast<std::size_t>(depth[f] % 2);
    const auto height = static_cast<std::size_t>(fronts[f].shape.lower_height());
    fronts[f].update = top[stack];
    top[stack] += height * height;
    most[stack] = std::max(most[stack], top[stack]);
    if (first_child[f] != kNone) top[1 - stack] = fronts[first_child[f]].update;
  }
  for (std::size_t f = 0; f < fronts.size(); ++f) {
    if (depth[f] % 2 == 1) fronts[f].update += most[0];
  }
  update_size = most[0] + most[1];
}

void FrontLayout::join_with_parents(const std::vector<Supernode>& nodes) {
  std::vector<std::vector<Index>> children_of_fronts(fronts.size());
  for (std::size_t f = 0; f < fronts.size(); ++f) {
    if (nodes[f].parent != kNone) children_of_fronts[nodes[f].parent].push_back(static_cast<Index>(f));
  }
  for (std::size_t f = 0; f < fronts.size(); ++f) {
    fronts[f].children.begin = count_of(children);
    for (const Index child : children_of_fronts[f]) add_child(fronts[f], fronts[child]);
    fronts[f].children.end = count_of(children);
  }
}

void FrontLayout::add_child(const Front& parent, const Front& child) {
  Child handed{.height = child.shape.lower_height(),
               .update = child.update,
               .columns = {.begin = count_of(columns)},
               .whole = {.begin = count_of(whole)},
               .single = {.begin = count_of(single)},
               .runs = {.begin = count_of(runs)}};
  const std::span<const Index> below = lower_of(child);
  std::vector<Index> rows;
  for (std::size_t k = 0; k < below.size(); ++k) {
    const Index row = row_of(parent, below[k]);
    for (Index r = 0; r < 3; ++r) rows.push_back(row + r);
    if (row < parent.shape.width()) {
      columns.push_back(row);
      continue;
    }
    const RowRun run{.from = 3 * static_cast<Index>(k), .to = row - parent.shape.width(), .length = 3};
    if (count_of(runs) > handed.runs.begin && runs.back().to + runs.back().length == run.to) {
      runs.back().length += run.length;
    } else {
      runs.push_back(run);
    }
  }
  add_rows(parent.shape, rows);
  handed.columns.end = count_of(columns);
  handed.whole.end = count_of(whole);
  handed.single.end = count_of(single);
  handed.runs.end = count_of(runs);
  children.push_back(handed);
}

/// Requires ascending rows.
void FrontLayout::add_rows(const FrontShape& parent, const std::vector<Index>& rows) {
  for (std::size_t k = 0; k < rows.size();) {
    const std::size_t last = k + kSimdWidth - 1;
    const bool fills = rows[k] % kSimdWidth == 0 && last < rows.size() && rows[last] == rows[k] + kSimdWidth - 1;
    (fills ? whole : single).push_back({static_cast<Index>(k), static_cast<Index>(parent.index(rows[k], 0))});
    k += fills ? kSimdWidth : 1;
  }
}

void FrontLayout::make_entries(const BlockMatrix& pattern, const std::vector<Supernode>& nodes) {
  std::vector<std::vector<Entry>> entries_of(pattern.size());
  Index block = 0;
  for (Index j = 0; j < pattern.size(); ++j) {
    if (slot[j] != kNone)
      entries_of[j].push_back({.block = j, .row = slot[j], .column = slot[j], .on_diagonal = true, .transposed = false});
    pattern.for_column(j, [&](Index i, const Matrix3&) {
      const Index number = block++;
      if (slot[i] == kNone || slot[j] == kNone) return;
      const bool transposed = slot[i] < slot[j];
      const auto [column, row] = std::minmax(slot[i], slot[j]);
      entries_of[transposed ? i : j].push_back(
          {.block = number, .row = row, .column = column, .on_diagonal = false, .transposed = transposed});
    });
  }
  for (std::size_t f = 0; f < fronts.size(); ++f) {
    for (const Index particle : nodes[f].columns) {
      for (Entry entry : entries_of[particle]) {
        entry.row = row_of(fronts[f], entry.row);
        entry.column -= fronts[f].first_slot;
        entries.push_back(entry);
      }
    }
    fronts[f].end_entry = entries.size();
  }
}

}  // namespace sprung
