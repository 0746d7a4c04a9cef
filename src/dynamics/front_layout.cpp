#include "dynamics/front_layout.h"

#include "dynamics/supernodes.h"

#include <algorithm>
#include <array>

namespace sprung {
namespace {

Index tiles_of(std::size_t particles) { return static_cast<Index>((3 * particles + kSpringLanes - 1) / kSpringLanes); }

/// The particles that are in, and who is coupled to whom among them.
MatrixGraph graph_of(const BlockMatrix& pattern, const std::vector<Index>& number, Index count) {
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

/// Of rows that ascend.
PanelRows places_in_panel(const std::vector<Index>& rows, const FrontShape& shape) {
  PanelRows places;
  for (std::size_t k = 0; k < rows.size();) {
    const std::size_t last = k + kSpringLanes - 1;
    const bool fills = rows[k] % kSpringLanes == 0 && last < rows.size() && rows[last] == rows[k] + kSpringLanes - 1;
    (fills ? places.whole : places.single).push_back({static_cast<Index>(k), static_cast<Index>(shape.place(rows[k], 0))});
    k += fills ? kSpringLanes : 1;
  }
  return places;
}

}  // namespace

Index FrontLayout::Front::row_of(Index at) const {
  if (at < first_place + shape.width()) return at - first_place;
  return shape.width() + 3 * static_cast<Index>(std::ranges::lower_bound(lower, at) - lower.begin());
}

FrontLayout::FrontLayout(const BlockMatrix& pattern, const std::vector<bool>& left_out) {
  place_fronts(pattern, left_out);
  join_with_parents();
  place_updates();
  place_entries(pattern);
}

void FrontLayout::place_fronts(const BlockMatrix& pattern, const std::vector<bool>& left_out) {
  std::vector<Index> particles;
  std::vector<Index> number(pattern.size(), kNone);
  for (Index i = 0; i < pattern.size(); ++i) {
    if (!left_out.empty() && left_out[i]) continue;
    number[i] = static_cast<Index>(particles.size());
    particles.push_back(i);
  }
  const std::vector<Supernode> nodes = find_supernodes(graph_of(pattern, number, static_cast<Index>(particles.size())));
  place.assign(pattern.size(), kNone);
  for (const Supernode& node : nodes) {
    Front& front = fronts.emplace_back();
    front.shape = {.own_tiles = tiles_of(node.columns.size()), .lower_tiles = tiles_of(node.rows.size())};
    front.parent = node.parent;
    front.first_place = static_cast<Index>(vector_size);
    front.panel = panel_size;
    for (const Index column : node.columns) {
      place[particles[column]] = front.first_place + 3 * static_cast<Index>(front.own.size());
      front.own.push_back(particles[column]);
    }
    vector_size += static_cast<std::size_t>(front.shape.width());
    panel_size += front.shape.size();
  }
  for (std::size_t f = 0; f < fronts.size(); ++f) {
    for (const Index row : nodes[f].rows) fronts[f].lower.push_back(place[particles[row]]);
  }
}

void FrontLayout::join_with_parents() {
  for (std::size_t f = 0; f < fronts.size(); ++f) {
    Front& front = fronts[f];
    if (front.parent == kNone) continue;
    Front& parent = fronts[front.parent];
    parent.children.push_back(static_cast<Index>(f));
    std::vector<Index> rows;
    for (std::size_t k = 0; k < front.lower.size(); ++k) {
      const Index row = parent.row_of(front.lower[k]);
      for (Index r = 0; r < 3; ++r) rows.push_back(row + r);
      if (row < parent.shape.width()) {
        front.parent_columns.push_back(row);
        continue;
      }
      const RowRun run{.from = 3 * static_cast<Index>(k), .to = row - parent.shape.width(), .length = 3};
      if (!front.runs.empty() && front.runs.back().to + front.runs.back().length == run.to) {
        front.runs.back().length += run.length;
      } else {
        front.runs.push_back(run);
      }
    }
    front.parent_rows = places_in_panel(rows, parent.shape);
  }
}

// Updates are taken in the reverse order of their making, but a front's is made while its children's are still there. Fronts at
// even and odd depths of the tree have a stack each, so that theirs can go first.
void FrontLayout::place_updates() {
  std::vector<Index> depth(fronts.size(), 0);
  for (std::size_t f = fronts.size(); f-- > 0;) {
    if (fronts[f].parent != kNone) depth[f] = depth[fronts[f].parent] + 1;
  }
  std::array<std::size_t, 2> top{};
  std::array<std::size_t, 2> most{};
  for (std::size_t f = 0; f < fronts.size(); ++f) {
    const auto stack = static_cast<std::size_t>(depth[f] % 2);
    const auto height = static_cast<std::size_t>(fronts[f].shape.lower_height());
    fronts[f].update = top[stack];
    top[stack] += height * height;
    most[stack] = std::max(most[stack], top[stack]);
    if (!fronts[f].children.empty()) top[1 - stack] = fronts[fronts[f].children.front()].update;
  }
  for (std::size_t f = 0; f < fronts.size(); ++f) {
    if (depth[f] % 2 == 1) fronts[f].update += most[0];
  }
  update_size = most[0] + most[1];
}

void FrontLayout::place_entries(const BlockMatrix& pattern) {
  std::vector<std::vector<Entry>> entries_of(pattern.size());
  Index block = 0;
  for (Index j = 0; j < pattern.size(); ++j) {
    if (place[j] != kNone)
      entries_of[j].push_back({.block = j, .row = place[j], .column = place[j], .on_diagonal = true, .transposed = false});
    pattern.for_column(j, [&](Index i, const Matrix3&) {
      const Index number = block++;
      if (place[i] == kNone || place[j] == kNone) return;
      const bool transposed = place[i] < place[j];
      const auto [column, row] = std::minmax(place[i], place[j]);
      entries_of[transposed ? i : j].push_back(
          {.block = number, .row = row, .column = column, .on_diagonal = false, .transposed = transposed});
    });
  }
  for (Front& front : fronts) {
    for (const Index particle : front.own) {
      for (Entry entry : entries_of[particle]) {
        entry.row = front.row_of(entry.row);
        entry.column -= front.first_place;
        entries.push_back(entry);
      }
    }
    front.end_entry = entries.size();
  }
}

}  // namespace sprung
