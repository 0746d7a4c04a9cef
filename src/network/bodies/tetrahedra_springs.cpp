#include "network/bodies/tetrahedra_springs.h"

#include "geometry/tetrahedra/tetrahedra_mesh.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

namespace sprung {
namespace {

constexpr double kEvenness = 0.03;
// Bounds of the factor of a direction. Directions with few edges would get large factors; neighbouring springs would then differ
// much, and the network would become softer instead of stiffer.
constexpr double kLeastFactor = 0.72;
constexpr double kLargestFactor = 1.3;
// A network that is softer than this by its estimate is not made stiffer: a single step of relaxation does not describe it.
constexpr double kLeastRelaxed = 0.5;

constexpr int kMonomials = 15;
using Moments = Eigen::Matrix<double, kMonomials, 1>;

// The independent components of n (x) n (x) n (x) n, each times the square root of the number of its equals, so that the dot
// product of two is (n . m)^4.
Moments fourth_moments(const Vector3& n) {
  const Vector3 n2 = n.cwiseProduct(n);
  const double root4 = 2.0;
  const double root6 = std::sqrt(6.0);
  const double root12 = std::sqrt(12.0);
  Moments m;
  m << n2.x() * n2.x(), n2.y() * n2.y(), n2.z() * n2.z(),                                              //
      root6 * n2.x() * n2.y(), root6 * n2.y() * n2.z(), root6 * n2.z() * n2.x(),                       //
      root4 * n2.x() * n.x() * n.y(), root4 * n2.x() * n.x() * n.z(), root4 * n2.y() * n.y() * n.x(),  //
      root4 * n2.y() * n.y() * n.z(), root4 * n2.z() * n.z() * n.x(), root4 * n2.z() * n.z() * n.y(),  //
      root12 * n2.x() * n.y() * n.z(), root12 * n2.y() * n.x() * n.z(), root12 * n2.z() * n.x() * n.y();
  return m;
}

/// Their mean over all directions.
Moments isotropic_moments() {
  Moments m = Moments::Zero();
  m.head<3>().setConstant(1.0 / 5.0);
  m.segment<3>(3).setConstant(std::sqrt(6.0) / 15.0);
  return m;
}

Vector3 direction(const Points& vertices, const TetrahedraEdge& edge) {
  return (vertices.col(edge.second) - vertices.col(edge.first)).normalized();
}

std::vector<TetrahedraEdge> shared_volumes(const Points& vertices, const std::vector<std::array<Index, 4>>& tetrahedra) {
  std::vector<TetrahedraEdge> parts;
  parts.reserve(6 * tetrahedra.size());
  for (const std::array<Index, 4>& corners : tetrahedra) {
    const double part = tetrahedron_volume(vertices, corners) / 6.0;
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = a + 1; b < 4; ++b)
        parts.push_back({std::min(corners[a], corners[b]), std::max(corners[a], corners[b]), part});
    }
  }
  std::stable_sort(parts.begin(), parts.end(), [](const TetrahedraEdge& a, const TetrahedraEdge& b) {
    return std::tie(a.first, a.second) < std::tie(b.first, b.second);
  });
  std::vector<TetrahedraEdge> edges;
  for (const TetrahedraEdge& part : parts) {
    if (!edges.empty() && edges.back().first == part.first && edges.back().second == part.second) {
      edges.back().volume += part.volume;
    } else {
      edges.push_back(part);
    }
  }
  return edges;
}

// Least squares: |sum of w f n (x) n (x) n (x) n - isotropic|^2 + kEvenness (sum of w (f - 1)^2), with w the parts of the volume.
// Its minimum has f - 1 = G : n (x) n (x) n (x) n.
void weigh_directions(const Points& vertices, std::vector<TetrahedraEdge>& edges) {
  double volume = 0.0;
  Moments sum = Moments::Zero();
  Eigen::Matrix<double, kMonomials, kMonomials> gram = Eigen::Matrix<double, kMonomials, kMonomials>::Zero();
  for (const TetrahedraEdge& edge : edges) {
    const Moments moments = fourth_moments(direction(vertices, edge));
    volume += edge.volume;
    sum += edge.volume * moments;
    gram += edge.volume * moments * moments.transpose();
  }
  gram /= volume;
  gram.diagonal().array() += kEvenness;
  const Moments g = gram.ldlt().solve(isotropic_moments() - sum / volume);
  for (TetrahedraEdge& edge : edges) {
    edge.volume *= std::clamp(1.0 + g.dot(fourth_moments(direction(vertices, edge))), kLeastFactor, kLargestFactor);
  }
}

std::vector<bool> inner_vertices(Eigen::Index vertices, const std::vector<std::array<Index, 4>>& tetrahedra) {
  std::vector<bool> inner(static_cast<std::size_t>(vertices), true);
  const Triangles boundary = boundary_triangles(tetrahedra);
  for (const Index corner : boundary.reshaped()) inner[corner] = false;
  return inner;
}

// The part of the energy of a strain that stays, if each inner vertex alone follows its force. The strains are pulls, with
// Poisson's ratio 1/4, along the six axes of an icosahedron: their mean is that over all directions, exactly, for what is of the
// second order in the strain. The modulus is 1, so that k L = 6 V_e / L.
double relaxed_energy(const Points& vertices, const std::vector<TetrahedraEdge>& edges, const std::vector<bool>& inner) {
  const double golden = std::numbers::phi;
  const Vector3 axes[] = {{0, 1, golden}, {0, 1, -golden}, {1, golden, 0}, {1, -golden, 0}, {golden, 0, 1}, {-golden, 0, 1}};
  std::vector<Matrix3> stiffness(inner.size(), Matrix3::Zero());
  std::vector<Eigen::Matrix<double, 3, 6>> forces(inner.size(), Eigen::Matrix<double, 3, 6>::Zero());
  double energy = 0.0;
  for (const TetrahedraEdge& edge : edges) {
    const double length = (vertices.col(edge.second) - vertices.col(edge.first)).norm();
    const Vector3 n = direction(vertices, edge);
    Eigen::Matrix<double, 1, 6> strains;
    for (int pull = 0; pull < 6; ++pull) {
      const double cosine = n.dot(axes[pull].normalized());
      strains[pull] = 1.25 * cosine * cosine - 0.25;
    }
    const Matrix3 block = 6.0 * edge.volume / (length * length) * n * n.transpose();
    const Eigen::Matrix<double, 3, 6> force = 6.0 * edge.volume / length * n * strains;
    stiffness[edge.first] += block;
    stiffness[edge.second] += block;
    forces[edge.first] += force;
    forces[edge.second] -= force;
    energy += 3.0 * edge.volume * strains.squaredNorm();
  }
  double released = 0.0;
  for (std::size_t i = 0; i < inner.size(); ++i) {
    if (inner[i]) released += 0.5 * (forces[i].array() * (stiffness[i].ldlt().solve(forces[i])).array()).sum();
  }
  return 1.0 - released / energy;
}

}  // namespace

std::vector<TetrahedraEdge> tetrahedra_edges(const Points& vertices, const std::vector<std::array<Index, 4>>& tetrahedra) {
  std::vector<TetrahedraEdge> edges = shared_volumes(vertices, tetrahedra);
  weigh_directions(vertices, edges);
  const double relaxed = relaxed_energy(vertices, edges, inner_vertices(vertices.cols(), tetrahedra));
  for (TetrahedraEdge& edge : edges) edge.volume /= std::max(kLeastRelaxed, relaxed);
  return edges;
}

}  // namespace sprung
