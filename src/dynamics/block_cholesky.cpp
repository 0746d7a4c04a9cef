#include "dynamics/block_cholesky.h"

#include "base/tiny_numbers.h"
#include "dynamics/front_layout.h"

#include <algorithm>

namespace sprung {
namespace {

using Front = FrontLayout::Front;
using Entry = FrontLayout::Entry;

void add_entry(const Entry& entry, const BlockMatrix& matrix, const FrontShape& shape, double* panel) {
  const Matrix3& block = entry.on_diagonal ? matrix.diagonal(entry.block) : matrix.beside(entry.block);
  for (Index c = 0; c < 3; ++c) {
    for (Index r = 0; r < 3; ++r) {
      panel[shape.place(entry.row + r, entry.column + c)] = entry.transposed ? block(c, r) : block(r, c);
    }
  }
}

}  // namespace

BlockCholesky::BlockCholesky(const BlockMatrix& pattern, const std::vector<bool>& left_out)
    : layout_(std::make_unique<FrontLayout>(pattern, left_out)),
      panels_(layout_->panel_size),
      inverse_(layout_->vector_size),
      updates_(layout_->update_size),
      vector_(layout_->vector_size) {
  Index width = 0;
  Index height = 0;
  for (const Front& front : layout_->fronts) {
    width = std::max(width, front.shape.width());
    height = std::max(height, front.shape.lower_height());
  }
  below_.resize(static_cast<std::size_t>(height));
  row_.resize(static_cast<std::size_t>(kRowRoom) * static_cast<std::size_t>(width));
}
BlockCholesky::~BlockCholesky() = default;

// Where springs hardly push, what one particle hands on to the next falls off until it is next to nothing.
bool BlockCholesky::factor(const BlockMatrix& matrix) {
  const TinyNumbersAreZero quick;
  const std::vector<Front>& fronts = layout_->fronts;
  for (std::size_t f = 0; f < fronts.size(); ++f) {
    const Front& front = fronts[f];
    assemble(f, matrix);
    double* const update = updates_.data() + front.update;
    if (!eliminate_front(front.shape, &panels_[front.panel], &inverse_[front.first_place], update, row_.data())) return false;
    for (const Index c : front.children) {
      const Front& child = fronts[c];
      add_to_update(child.runs, updates_.data() + child.update, child.shape.lower_height(), front.shape.lower_height(), update);
    }
  }
  return true;
}

void BlockCholesky::assemble(std::size_t number, const BlockMatrix& matrix) {
  const Front& front = layout_->fronts[number];
  const FrontShape& shape = front.shape;
  double* const panel = &panels_[front.panel];
  std::fill_n(panel, shape.size(), 0.0);
  for (Index k = 3 * static_cast<Index>(front.own.size()); k < shape.width(); ++k) panel[shape.place(k, k)] = 1.0;
  for (std::size_t e = number == 0 ? 0 : layout_->fronts[number - 1].end_entry; e < front.end_entry; ++e) {
    add_entry(layout_->entries[e], matrix, shape, panel);
  }
  for (const Index c : front.children) {
    const Front& child = layout_->fronts[c];
    add_to_panel(child.parent_columns, child.parent_rows, updates_.data() + child.update, child.shape.lower_height(), panel);
  }
}

void BlockCholesky::solve(const Points& right, Points& solution) {
  std::ranges::fill(vector_, 0.0);
  for (Index i = 0; i < right.cols(); ++i) {
    if (layout_->place[i] != kNone) Vector3::Map(&vector_[layout_->place[i]]) = right.col(i);
  }
  for (const Front& front : layout_->fronts) {
    solve_front(front.shape, &panels_[front.panel], &vector_[front.first_place], below_.data());
    for (std::size_t k = 0; k < front.lower.size(); ++k) Vector3::Map(&vector_[front.lower[k]]) -= Vector3::Map(&below_[3 * k]);
  }
  for (std::size_t f = layout_->fronts.size(); f-- > 0;) {
    const Front& front = layout_->fronts[f];
    // The rows that fill up the last tile are zero in L, but zero times what is not finite is not.
    std::fill_n(below_.begin(), front.shape.lower_height(), 0.0);
    for (std::size_t k = 0; k < front.lower.size(); ++k) Vector3::Map(&below_[3 * k]) = Vector3::Map(&vector_[front.lower[k]]);
    solve_front_transposed(front.shape, &panels_[front.panel], &inverse_[front.first_place], &vector_[front.first_place],
                           below_.data(), row_.data());
  }
  solution.resize(Eigen::NoChange, right.cols());
  for (Index i = 0; i < right.cols(); ++i) {
    if (layout_->place[i] == kNone) {
      solution.col(i).setZero();
    } else {
      solution.col(i) = Vector3::Map(&vector_[layout_->place[i]]);
    }
  }
}

}  // namespace sprung
