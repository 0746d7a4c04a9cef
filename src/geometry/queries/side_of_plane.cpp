#include "geometry/queries/side_of_plane.h"

#include <array>
#include <cmath>
#include <limits>

namespace sprung {

namespace {

// An exact sum of doubles that do not overlap, the smallest first. Its sign is that of its last term. Zero terms are left out,
// which keeps sums of numbers with few digits short.
template <int capacity>
class Expansion {
 public:
  /// Shewchuk's grow-expansion. The two-sum is exact for any order of magnitudes.
  void add(double value) {
    int kept = 0;
    for (int i = 0; i < size_; ++i) {
      const double sum = value + terms_[i];
      const double virtual_part = sum - value;
      const double rest = (value - (sum - virtual_part)) + (terms_[i] - virtual_part);
      if (rest != 0.0) terms_[kept++] = rest;
      value = sum;
    }
    if (value != 0.0) terms_[kept++] = value;
    size_ = kept;
  }

  void add_product(double x, double y) {
    const double product = x * y;
    add(std::fma(x, y, -product));
    add(product);
  }

  template <int n, int m>
  void add_product(const Expansion<n>& x, const Expansion<m>& y, double factor = 1.0) {
    for (int i = 0; i < x.size(); ++i) {
      for (int j = 0; j < y.size(); ++j) add_product(factor * x[i], y[j]);
    }
  }

  [[nodiscard]] int size() const { return size_; }
  double operator[](int i) const { return terms_[i]; }

  [[nodiscard]] double value() const {
    double sum = 0.0;
    for (int i = 0; i < size_; ++i) sum += terms_[i];
    return sum;
  }

 private:
  std::array<double, capacity> terms_;
  int size_ = 0;
};

using Difference = Expansion<2>;
using Minor = Expansion<16>;
using Determinant = Expansion<192>;

Difference difference(double x, double y) {
  Difference result;
  result.add(x);
  result.add(-y);
  return result;
}

double exact_side_of_plane(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& p) {
  std::array<Difference, 3> u;
  std::array<Difference, 3> v;
  std::array<Difference, 3> w;
  for (int k = 0; k < 3; ++k) {
    u[k] = difference(a[k], p[k]);
    v[k] = difference(b[k], p[k]);
    w[k] = difference(c[k], p[k]);
  }
  Determinant determinant;
  for (int k = 0; k < 3; ++k) {
    const int l = (k + 1) % 3;
    const int m = (k + 2) % 3;
    Minor minor;
    minor.add_product(v[l], w[m]);
    minor.add_product(v[m], w[l], -1.0);
    determinant.add_product(u[k], minor, -1.0);
  }
  return determinant.value();
}

}  // namespace

double side_of_plane(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& p) {
  const Vector3 u = a - p;
  const Vector3 v = b - p;
  const Vector3 w = c - p;
  const double determinant = -u.dot(v.cross(w));
  const Vector3 magnitude = v.cwiseAbs();
  const Vector3 other = w.cwiseAbs();
  const double permanent = std::abs(u[0]) * (magnitude[1] * other[2] + magnitude[2] * other[1]) +
                           std::abs(u[1]) * (magnitude[2] * other[0] + magnitude[0] * other[2]) +
                           std::abs(u[2]) * (magnitude[0] * other[1] + magnitude[1] * other[0]);
  // Each product undergoes at most 8 roundings: 8 eps, doubled for the rounding of the bound itself.
  constexpr double kBound = 8.0 * std::numeric_limits<double>::epsilon();
  if (std::abs(determinant) > kBound * permanent) return determinant;
  return exact_side_of_plane(a, b, c, p);
}

double side_of_line(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p) {
  const Eigen::Vector2d u = a - p;
  const Eigen::Vector2d v = b - p;
  const double left = u[0] * v[1];
  const double right = u[1] * v[0];
  // Each product undergoes four roundings.
  constexpr double kBound = 4.0 * std::numeric_limits<double>::epsilon();
  if (std::abs(left - right) > kBound * (std::abs(left) + std::abs(right))) return left - right;
  Minor determinant;
  determinant.add_product(difference(a[0], p[0]), difference(b[1], p[1]));
  determinant.add_product(difference(a[1], p[1]), difference(b[0], p[0]), -1.0);
  return determinant.value();
}

}  // namespace sprung
