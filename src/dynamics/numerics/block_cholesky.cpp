#include "dynamics/numerics/block_cholesky.h"

#include "base/machine/tiny_numbers.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace sprung {
namespace {

using Front = FrontLayout::Front;
using Child = FrontLayout::Child;
using Entry = FrontLayout::Entry;

/// The inverse of the largest power of two below `largest`, or 1 if there is none.
double scale_to_one(double largest) {
  if (!(largest > 0.0) || !std::isfinite(largest)) return 1.0;
  return std::ldexp(1.0, -std::ilogb(largest));
}

// Entries are read in the order of elimination, blocks lie in the order of particles. Each block is prefetched this many entries
// ahead.
constexpr std::size_t kAhead = 8;

const Matrix3& block_of(const Entry& entry, const BlockMatrix& matrix) {
  return entry.on_diagonal ? matrix.diagonal(entry.block) : matrix.beside(entry.block);
}

template <class Number>
void add_entry(const Entry& entry, const BlockMatrix& matrix, double scale, double raise, const FrontShape& shape, Number* panel) {
  Matrix3 block = block_of(entry, matrix);
  if (entry.transposed) block.transposeInPlace();
  if (entry.on_diagonal) block.diagonal() += raise * block.diagonal();
  for (Index r = 0; r < 3; ++r) {
    Number* const row = panel + shape.index(entry.row + r, entry.column);
    for (Index c = 0; c < 3; ++c) row[c * kSimdWidth] = static_cast<Number>(scale * block(r, c));
  }
}

// Hardware does not prefetch backward reads. Once the first bytes of a large panel are read, it continues by itself.
constexpr std::size_t kFetched = 16384;  // [bytes]
constexpr std::size_t kCacheLine = 64;

// Inlined: compilers drop calls of a function that only prefetches.
template <class Number>
[[gnu::always_inline]] inline void fetch_panel(const Front& front, const Number* panels) {
  const Number* const panel = panels + front.panel;
  const std::size_t size = std::min(front.shape.size(), kFetched / sizeof(Number));
  for (std::size_t k = 0; k < size; k += kCacheLine / sizeof(Number)) __builtin_prefetch(panel + k);
}

}  // namespace

template <class Number>
BlockCholesky<Number>::BlockCholesky(const BlockMatrix& pattern, const std::vector<bool>& left_out)
    : layout_(pattern, left_out),
      panels_(layout_.panel_size),
      inverse_(layout_.vector_size),
      updates_(layout_.update_size),
      vector_(layout_.vector_size) {
  Index width = 0;
  Index height = 0;
  for (const Front& front : layout_.fronts) {
    width = std::max(width, front.shape.width());
    height = std::max(height, front.shape.lower_height());
  }
  below_.resize(static_cast<std::size_t>(height));
  row_.resize(static_cast<std::size_t>(kRowRoom) * static_cast<std::size_t>(width));
}

template <class Number>
bool BlockCholesky<Number>::factor_and_solve(const BlockMatrix& matrix, double raise, const Points& right, Points& solution) {
  const TinyNumbersAreZero quick;
  const double scale = take(right);
  if (!eliminate(matrix, raise)) return false;
  substitute_back();
  give(scale, solution);
  return true;
}

template <class Number>
void BlockCholesky<Number>::solve(const Points& right, Points& solution) {
  const TinyNumbersAreZero quick;
  const double scale = take(right);
  for (const Front& front : layout_.fronts) substitute(front);
  substitute_back();
  give(scale, solution);
}

/// Substitutes with each front while its panel is in the cache.
template <class Number>
bool BlockCholesky<Number>::eliminate(const BlockMatrix& matrix, double raise) {
  double largest = 0.0;
  for (Index i = 0; i < matrix.size(); ++i) largest = std::max(largest, matrix.diagonal(i).diagonal().maxCoeff());
  scale_ = scale_to_one(largest);
  const std::vector<Front>& fronts = layout_.fronts;
  for (std::size_t f = 0; f < fronts.size(); ++f) {
    const Front& front = fronts[f];
    assemble(f, matrix, raise);
    Number* const update = updates_.data() + front.update;
    if (!eliminate_front(front.shape, &panels_[front.panel], &inverse_[front.first_slot], update, row_.data())) return false;
    substitute(front);
    for (const Child& child : layout_.children_of(front)) {
      add_to_update(layout_.runs_of(child), updates_.data() + child.update, child.height, front.shape.lower_height(), update);
    }
  }
  return true;
}

template <class Number>
void BlockCholesky<Number>::assemble(std::size_t number, const BlockMatrix& matrix, double raise) {
  const Front& front = layout_.fronts[number];
  const FrontShape& shape = front.shape;
  Number* const panel = &panels_[front.panel];
  std::fill_n(panel, shape.size(), Number{});
  for (Index k = front.own_rows; k < shape.width(); ++k) panel[shape.index(k, k)] = 1;
  const std::vector<Entry>& entries = layout_.entries;
  for (std::size_t e = number == 0 ? 0 : layout_.fronts[number - 1].end_entry; e < front.end_entry; ++e) {
    __builtin_prefetch(block_of(entries[std::min(e + kAhead, entries.size() - 1)], matrix).data());
    add_entry(entries[e], matrix, scale_, raise, shape, panel);
  }
  for (const Child& child : layout_.children_of(front)) {
    add_to_panel(layout_.columns_of(child), layout_.rows_of(child), updates_.data() + child.update, child.height, panel);
  }
}

/// Returns the scale that numbers are multiplied by when they are read.
template <class Number>
double BlockCholesky<Number>::take(const Points& right) {
  const double scale = scale_to_one(right.size() > 0 ? right.cwiseAbs().maxCoeff() : 0.0);
  std::ranges::fill(vector_, Number{});
  for (Index i = 0; i < right.cols(); ++i) {
    if (layout_.slot[i] != kNone) Vector::Map(&vector_[layout_.slot[i]]) = (scale * right.col(i)).template cast<Number>();
  }
  return scale;
}

template <class Number>
void BlockCholesky<Number>::substitute(const Front& front) {
  solve_front(front.shape, &panels_[front.panel], &vector_[front.first_slot], below_.data());
  const std::span<const Index> lower = layout_.lower_of(front);
  for (std::size_t k = 0; k < lower.size(); ++k) Vector::Map(&vector_[lower[k]]) -= Vector::Map(&below_[3 * k]);
}

template <class Number>
void BlockCholesky<Number>::substitute_back() {
  for (std::size_t f = layout_.fronts.size(); f-- > 0;) {
    const Front& front = layout_.fronts[f];
    if (f > 0) fetch_panel(layout_.fronts[f - 1], panels_.data());
    // Padding rows are zero in L, but zero times a non-finite number is not zero.
    std::fill_n(below_.begin(), front.shape.lower_height(), Number{});
    const std::span<const Index> lower = layout_.lower_of(front);
    for (std::size_t k = 0; k < lower.size(); ++k) Vector::Map(&below_[3 * k]) = Vector::Map(&vector_[lower[k]]);
    solve_front_transposed(front.shape, &panels_[front.panel], &inverse_[front.first_slot], &vector_[front.first_slot],
                           below_.data(), row_.data());
  }
}

template <class Number>
void BlockCholesky<Number>::give(double scale, Points& solution) const {
  const double back = scale_ / scale;
  const auto count = static_cast<Index>(layout_.slot.size());
  solution.resize(Eigen::NoChange, count);
  for (Index i = 0; i < count; ++i) {
    if (layout_.slot[i] == kNone) {
      solution.col(i).setZero();
    } else {
      solution.col(i) = back * Vector::Map(&vector_[layout_.slot[i]]).template cast<double>();
    }
  }
}

template class BlockCholesky<double>;
template class BlockCholesky<float>;

}  // namespace sprung
