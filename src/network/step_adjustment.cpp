#include "network/step_adjustment.h"

#include "base/format.h"
#include "base/problem_list.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace sprung {
namespace {

// Of the square of the frequency: half the step of 99 in 100.
constexpr double kMostExcess = 4.0;
constexpr double kUsual = 0.99;

constexpr int kDigits = 3;
constexpr int kPositionDigits = 5;

/// A spring, angle bend or face bend: an elastic energy, the sum of 1/2 k (w . u)^2 over the rows w of `weights`, of displacements
/// u across or along the element.
struct Element {
  std::array<Index, 6> particles{};
  std::array<std::array<double, 6>, 3> weights{};
  double* stiffness = nullptr;
  double* damping = nullptr;
  std::array<Index, 2> edge{};  ///< the spring's ends, or the ends of the bend's shorter bond
  double length = 0.0;          ///< of that edge at rest [m]
};

std::vector<Element> elements_of(BodyShape& shape) {
  std::vector<Element> elements;
  Springs& springs = shape.springs;
  for (Index s = 0; s < springs.count(); ++s) {
    elements.push_back({{springs.first[s], springs.second[s]},
                        {{{1.0, -1.0}}},
                        &springs.stiffness[s],
                        &springs.damping[s],
                        {springs.first[s], springs.second[s]},
                        springs.rest_length[s]});
  }
  AngleBends& bends = shape.angle_bends;
  for (Index a = 0; a < bends.count(); ++a) {
    const double before = bends.length_before[a];
    const double after = bends.length_after[a];
    const Index end = before < after ? bends.before[a] : bends.after[a];
    elements.push_back({{bends.before[a], bends.middle[a], bends.after[a]},
                        {{{1.0 / before, -1.0 / before - 1.0 / after, 1.0 / after}}},
                        &bends.stiffness[a],
                        &bends.damping[a],
                        {bends.middle[a], end},
                        std::min(before, after)});
  }
  FaceBends& faces = shape.face_bends;
  for (Index f = 0; f < faces.count(); ++f) {
    Element element{.particles = stencil_of(faces, shape.hinges, f).particles,
                    .weights = weights_of(faces, shape.hinges, f),
                    .stiffness = &faces.stiffness[f],
                    .damping = &faces.damping[f],
                    .length = std::numeric_limits<double>::infinity()};
    for (const Index hinge : faces.hinges[f]) {
      if (hinge == kNone) continue;
      const auto [a, b, c, d] = shape.hinges.particles[hinge];
      const double length = (shape.positions[a] - shape.positions[b]).norm();
      if (length >= element.length) continue;
      element.edge = {a, b};
      element.length = length;
    }
    elements.push_back(element);
  }
  return elements;
}

/// The square of the element's frequency on its own [1/s^2].
double squared_frequency(const Element& element, const std::vector<double>& masses) {
  double largest = 0.0;
  for (const std::array<double, 6>& row : element.weights) {
    double sum = 0.0;
    for (std::size_t k = 0; k < row.size(); ++k) sum += row[k] * row[k] / masses[element.particles[k]];
    largest = std::max(largest, sum);
  }
  return *element.stiffness * largest;
}

/// The value that 99 in 100, by weight, of those above zero do not exceed; infinity if there are none.
double usual(const std::vector<double>& values, const std::vector<double>& weights) {
  std::vector<std::size_t> order;
  double total = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!(values[i] > 0.0)) continue;
    order.push_back(i);
    total += weights[i];
  }
  std::ranges::sort(order, {}, [&](std::size_t i) { return values[i]; });
  double sum = 0.0;
  for (const std::size_t i : order) {
    sum += weights[i];
    if (sum >= kUsual * total) return values[i];
  }
  return std::numeric_limits<double>::infinity();
}

void note_place(const BodyShape& shape, const std::array<Index, 2>& edge, double length, StepAdjustment& adjustment) {
  adjustment.from = shape.positions[edge[0]];
  adjustment.to = shape.positions[edge[1]];
  adjustment.length = length;
}

void soften(const BodyShape& shape, const std::vector<Element>& elements, StepAdjustment& adjustment) {
  std::vector<double> frequencies;
  for (const Element& element : elements) frequencies.push_back(squared_frequency(element, shape.masses));
  const double most = kMostExcess * usual(frequencies, std::vector<double>(frequencies.size(), 1.0));
  for (std::size_t e = 0; e < elements.size(); ++e) {
    if (!(frequencies[e] > most)) continue;
    const double factor = most / frequencies[e];
    *elements[e].stiffness *= factor;
    *elements[e].damping *= factor;
    ++adjustment.softened;
    if (factor >= adjustment.least_factor) continue;
    adjustment.least_factor = factor;
    note_place(shape, elements[e].edge, elements[e].length, adjustment);
  }
}

/// Row sums of the stiffness matrix [N/m]: divided by the mass, no mode is faster than the largest of the particles that it moves.
std::vector<double> row_sums(const BodyShape& shape, const std::vector<Element>& elements) {
  std::vector<double> sums(shape.masses.size(), 0.0);
  for (const Element& element : elements) {
    for (const std::array<double, 6>& row : element.weights) {
      double weights = 0.0;
      for (const double weight : row) weights += std::abs(weight);
      for (std::size_t k = 0; k < row.size(); ++k) sums[element.particles[k]] += *element.stiffness * std::abs(row[k]) * weights;
    }
  }
  return sums;
}

/// What particles lack of the mass at which no row sum divided by the mass exceeds `most` [kg].
double lacking_mass(const std::vector<double>& sums, const std::vector<double>& masses, double most) {
  double lacking = 0.0;
  for (std::size_t i = 0; i < sums.size(); ++i) lacking += std::max(0.0, sums[i] / most - masses[i]);
  return lacking;
}

/// The shortest edge at a particle.
const Element& shortest_at(Index particle, const std::vector<Element>& elements) {
  const auto length = [&](const Element& element) {
    return std::ranges::find(element.edge, particle) != element.edge.end() ? element.length
                                                                           : std::numeric_limits<double>::infinity();
  };
  return *std::ranges::min_element(elements, {}, length);
}

void add_mass(const std::vector<Element>& elements, double available, BodyShape& shape, StepAdjustment& adjustment) {
  const std::vector<double> sums = row_sums(shape, elements);
  std::vector<double> rates;
  for (std::size_t i = 0; i < sums.size(); ++i) rates.push_back(sums[i] / shape.masses[i]);
  // By mass: in a mesh with slivers, more than one particle in 100 may be tiny, although their total mass is negligible.
  double most = kMostExcess * usual(rates, shape.masses);
  const auto fastest = std::ranges::max_element(rates);
  if (available == 0.0 || !(*fastest > most)) return;
  if (lacking_mass(sums, shape.masses, most) > available) {
    double above = *fastest;  // where nothing is lacking
    for (int halving = 0; halving < std::numeric_limits<double>::digits; ++halving) {
      const double middle = 0.5 * (most + above);
      (lacking_mass(sums, shape.masses, middle) > available ? most : above) = middle;
    }
    most = above;
  }
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const double added = sums[i] / most - shape.masses[i];
    if (!(added > 0.0)) continue;
    shape.masses[i] += added;
    adjustment.added_mass += added;
    ++adjustment.heavier;
  }
  if (adjustment.softened > 0 || adjustment.heavier == 0) return;
  const Element& worst = shortest_at(static_cast<Index>(fastest - rates.begin()), elements);
  note_place(shape, worst.edge, worst.length, adjustment);
}

}  // namespace

std::optional<StepAdjustment> adjust_for_step(BodyShape& shape, double mass_share) {
  if (static_cast<Index>(shape.positions.size()) < kLeastAdjusted) return std::nullopt;
  StepAdjustment adjustment;
  for (const double mass : shape.masses) adjustment.mass += mass;
  const std::vector<Element> elements = elements_of(shape);
  soften(shape, elements, adjustment);
  add_mass(elements, mass_share * adjustment.mass, shape, adjustment);
  if (adjustment.softened == 0 && adjustment.heavier == 0) return std::nullopt;
  return adjustment;
}

std::string describe(const StepAdjustment& adjustment) {
  std::string text = "body \"" + adjustment.body + "\" has short edges, which would slow the whole scene: ";
  if (adjustment.softened > 0) {
    text += counted(static_cast<std::size_t>(adjustment.softened), "spring or bend", "springs and bends") + " softer, down to " +
            format_number(adjustment.least_factor, kDigits) + " of the material's";
  }
  if (adjustment.softened > 0 && adjustment.heavier > 0) text += "; ";
  if (adjustment.heavier > 0) {
    text += counted(static_cast<std::size_t>(adjustment.heavier), "particle") + " heavier, by " +
            format_number(adjustment.added_mass, kDigits) + " kg (" +
            format_number(100.0 * adjustment.added_mass / adjustment.mass, kDigits) + " % of the body) in total";
  }
  return text + "; worst from " + vector_text(adjustment.from, kPositionDigits) + " to " +
         vector_text(adjustment.to, kPositionDigits) + ", " + format_number(adjustment.length, kDigits) + " m long";
}

}  // namespace sprung
