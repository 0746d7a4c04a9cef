#include "dynamics/stretch_newton/coarse_cloth.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

namespace sprung {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

// If pins keep more than this fraction of the particles, coarsening is not worth it.
constexpr double kMostLeft = 0.5;

double squared(double x) { return x * x; }

/// About half of the rows, the first and the last among them.
std::vector<Index> every_other(Index count) {
  const Index coarse = (count + 1) / 2;
  std::vector<Index> rows;
  for (std::int64_t k = 0; k < coarse; ++k) rows.push_back(static_cast<Index>(k * (count - 1) / std::max(coarse - 1, 1)));
  if (rows.back() != count - 1) rows.push_back(count - 1);
  return rows;
}

bool insert(Index row, std::vector<Index>& rows) {
  const auto place = std::ranges::lower_bound(rows, row);
  if (place != rows.end() && *place == row) return false;
  rows.insert(place, row);
  return true;
}

/// The position of a row between coarse rows.
struct Along {
  Index before;   ///< the coarse row at or before it, never the last
  double beyond;  ///< distance from there, as a fraction of the cell
};

Along locate(Index row, const std::vector<Index>& rows) {
  const auto next = std::ranges::upper_bound(rows.begin() + 1, rows.end() - 1, row);
  const auto k = static_cast<Index>(next - rows.begin()) - 1;
  return {k, static_cast<double>(row - rows[k]) / (rows[k + 1] - rows[k])};
}

class Coarsener {
 public:
  Coarsener(const SpringNetwork& network, const Body& body, const std::vector<SpringKind>& kinds)
      : network_(network), body_(body), columns_(body.resolution[0]), rows_(body.resolution[1]) {
    length_to_right_.assign(static_cast<std::size_t>(body.particle_count), kUnknown);
    length_upwards_ = length_to_right_;
    for (Index s = body.first_spring; s < body.first_spring + body.spring_count; ++s) {
      if (std::ranges::find(kinds, network.springs.kind[s]) != kinds.end()) note_spring(s);
    }
  }

  std::optional<CoarseCloth> coarse(const StretchComponent& component) {
    if (!is_lattice() || !is_whole(component)) return std::nullopt;
    xs_ = every_other(columns_);
    ys_ = every_other(rows_);
    while (keep_pins()) {
    }
    if (static_cast<double>(xs_.size() * ys_.size()) > kMostLeft * body_.particle_count) return std::nullopt;
    add_points(component);
    add_links();
    return std::move(cloth_);
  }

 private:
  [[nodiscard]] Index width() const { return static_cast<Index>(xs_.size()); }
  [[nodiscard]] Index particle(Index x, Index y) const { return body_.first_particle + y * columns_ + x; }
  [[nodiscard]] Index coarse_particle(Index point) const { return particle(xs_[point % width()], ys_[point / width()]); }

  void note_spring(Index s) {
    const Springs& springs = network_.springs;
    const Index from = springs.first[s] - body_.first_particle;
    const Index apart = springs.second[s] - springs.first[s];
    const bool is_to_right = apart == 1 && (from + 1) % columns_ != 0;
    switch (springs.kind[s]) {
      case SpringKind::structural: {
        double& length = (apart == columns_ ? length_upwards_ : length_to_right_)[from];
        has_others_ = has_others_ || !(is_to_right || apart == columns_) || !std::isnan(length);
        length = springs.rest_length[s];
        break;
      }
      case SpringKind::shear:
        ++shear_count_;
        break;
      case SpringKind::bend:  // as long as two consecutive structural springs, which imply it
        has_others_ = has_others_ || !(apart == 2 || apart == 2 * columns_);
        break;
    }
  }

  /// Whether neighbours along all rows and columns are joined, all cells or none have both diagonals, and nothing else is joined.
  [[nodiscard]] bool is_lattice() const {
    const auto known = [](const std::vector<double>& lengths) {
      return std::ranges::count_if(lengths, [](double length) { return !std::isnan(length); });
    };
    const bool is_joined = known(length_to_right_) == (columns_ - 1) * rows_ && known(length_upwards_) == columns_ * (rows_ - 1);
    return is_joined && !has_others_ && (shear_count_ == 0 || shear_count_ == 2 * (columns_ - 1) * (rows_ - 1));
  }

  /// Whether it has all free particles of the cloth.
  [[nodiscard]] bool is_whole(const StretchComponent& component) const {
    Index free = 0;
    for (Index i = 0; i < body_.particle_count; ++i) free += network_.is_fixed(body_.first_particle + i) ? 0 : 1;
    return columns_ * rows_ == body_.particle_count && component.free_count == free;
  }

  /// Makes coarse points pins until the coarse cloth constrains every pin: a pin is represented if it is a coarse point, or if all
  /// points of its cell are pins. Returns whether any point became a pin.
  bool keep_pins() {
    bool any = false;
    for (Index y = 0; y < rows_; ++y) {
      for (Index x = 0; x < columns_; ++x) {
        if (!network_.is_fixed(particle(x, y)) || lies_between_pins(x, y)) continue;
        any = insert(x, xs_) || any;
        any = insert(y, ys_) || any;
      }
    }
    return any;
  }

  [[nodiscard]] bool lies_between_pins(Index x, Index y) const {
    const CoarseCloth::Interpolation place = interpolation_at(x, y);
    for (std::size_t k = 0; k < place.points.size(); ++k) {
      if (place.weights[k] > 0.0 && !network_.is_fixed(coarse_particle(place.points[k]))) return false;
    }
    return true;
  }

  [[nodiscard]] CoarseCloth::Interpolation interpolation_at(Index x, Index y) const {
    const Along right = locate(x, xs_);
    const Along up = locate(y, ys_);
    const Index corner = up.before * width() + right.before;
    return {.points = {corner, corner + 1, corner + width(), corner + width() + 1},
            .weights = {(1.0 - right.beyond) * (1.0 - up.beyond), right.beyond * (1.0 - up.beyond),
                        (1.0 - right.beyond) * up.beyond, right.beyond * up.beyond}};
  }

  void add_points(const StretchComponent& component) {
    const auto count = static_cast<Index>(xs_.size() * ys_.size());
    std::vector<double> masses(static_cast<std::size_t>(count), 0.0);
    for (Index i = 0; i < component.free_count; ++i) {
      const CoarseCloth::Interpolation& place = cloth_.interpolations.emplace_back(interpolation_of(component.points[i]));
      for (std::size_t k = 0; k < place.points.size(); ++k) masses[place.points[k]] += place.weights[k] * component.masses[i];
    }
    StretchComponent& coarse = cloth_.component;
    point_.assign(static_cast<std::size_t>(count), kNone);
    for (Index q = 0; q < count; ++q) {
      cloth_.particles.push_back(coarse_particle(q));
      if (network_.is_fixed(cloth_.particles[q])) {
        cloth_.pins.push_back(q);
      } else {
        add_point(q);
        coarse.masses.push_back(masses[q]);
      }
    }
    coarse.free_count = static_cast<Index>(coarse.points.size());
  }

  void add_point(Index q) {
    point_[q] = static_cast<Index>(cloth_.component.points.size());
    cloth_.component.points.push_back(q);
  }

  [[nodiscard]] CoarseCloth::Interpolation interpolation_of(Index particle) const {
    const Index i = particle - body_.first_particle;
    return interpolation_at(i % columns_, i / columns_);
  }

  void add_links() {
    const auto count = static_cast<Index>(cloth_.particles.size());
    // In the order of their first points.
    std::vector<std::vector<StretchComponent::Link>> of_first(static_cast<std::size_t>(cloth_.component.free_count));
    for (Index q = 0; q < count; ++q) {
      const bool has_right = (q + 1) % width() != 0;
      const bool has_above = q + width() < count;
      if (has_right) join(q, q + 1, length_right_of(q), of_first);
      if (has_above) join(q, q + width(), length_above(q), of_first);
      if (shear_count_ == 0 || !has_right || !has_above) continue;
      const double across = std::sqrt(squared(length_right_of(q)) + squared(length_above(q)));
      join(q, q + width() + 1, across, of_first);
      join(q + 1, q + width(), across, of_first);
    }
    for (const auto& links : of_first) {
      cloth_.component.links.insert(cloth_.component.links.end(), links.begin(), links.end());
      cloth_.component.begin.push_back(static_cast<Index>(cloth_.component.links.size()));
    }
  }

  /// Links between two pins are left out. A pin enters the component with its first link; a pin without links carries no load.
  void join(Index a, Index b, double length, std::vector<std::vector<StretchComponent::Link>>& of_first) {
    if (network_.is_fixed(cloth_.particles[a]) && network_.is_fixed(cloth_.particles[b])) return;
    for (const Index q : {a, b}) {
      if (point_[q] == kNone) add_point(q);
    }
    const Index first = std::min(point_[a], point_[b]);
    of_first[first].push_back({first, std::max(point_[a], point_[b]), length, kNone});
  }

  [[nodiscard]] double length_right_of(Index q) const {
    const Index row = ys_[q / width()] * columns_;
    const auto begin = length_to_right_.begin() + row;
    return std::accumulate(begin + xs_[q % width()], begin + xs_[q % width() + 1], 0.0);
  }

  [[nodiscard]] double length_above(Index q) const {
    double sum = 0.0;
    for (Index y = ys_[q / width()]; y < ys_[q / width() + 1]; ++y) sum += length_upwards_[y * columns_ + xs_[q % width()]];
    return sum;
  }

  const SpringNetwork& network_;
  const Body& body_;
  Index columns_;
  Index rows_;
  Index shear_count_ = 0;                ///< of limited springs
  bool has_others_ = false;              ///< limited springs that make_cloth does not make, or that occur twice
  std::vector<double> length_to_right_;  ///< of the structural spring from each particle to the next in its row
  std::vector<double> length_upwards_;   ///< and to the one in the next row
  std::vector<Index> xs_;                ///< coarse columns
  std::vector<Index> ys_;                ///< coarse rows
  std::vector<Index> point_;             ///< by coarse point: its number in the component
  CoarseCloth cloth_;
};

}  // namespace

std::optional<CoarseCloth> coarsen(const SpringNetwork& network, const StretchComponent& component,
                                   const std::vector<SpringKind>& kinds) {
  const Body& body = network.body_of(component.points.front());
  if (body.resolution[0] < 2 || body.resolution[1] < 2) return std::nullopt;
  return Coarsener(network, body, kinds).coarse(component);
}

}  // namespace sprung
