#include "dynamics/air/gust_field.h"

#include "base/machine/kernel.h"
#include "base/machine/simd.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace sprung {
namespace {

constexpr double kPi = std::numbers::pi;

/// Uniform in [0, 1). The distributions of the standard library differ between libraries, its engines do not.
class Uniform {
 public:
  explicit Uniform(std::uint64_t seed) : engine_(seed) {}
  double operator()() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

 private:
  std::mt19937_64 engine_;
};

/// The fraction of the energy in waves with |k| < x sigma, for a spectrum k^4 exp(-k^2 / (2 sigma^2)): the chi distribution with
/// five degrees of freedom.
double energy_below(double x) {
  return std::erf(x / std::numbers::sqrt2) - std::sqrt(2.0 / kPi) * std::exp(-0.5 * x * x) * (x + x * x * x / 3.0);
}

double quantile(double fraction) {
  double lower = 0.0;
  double upper = 16.0;  // all but 1e-52
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = 0.5 * (lower + upper);
    (energy_below(middle) < fraction ? lower : upper) = middle;
  }
  return lower;
}

/// Uniform among all rotations (Shoemake 1992).
Matrix3 random_rotation(Uniform& uniform) {
  const double u = uniform();
  const double a = 2.0 * kPi * uniform();
  const double b = 2.0 * kPi * uniform();
  return Eigen::Quaterniond(std::sqrt(u) * std::cos(b), std::sqrt(1.0 - u) * std::sin(a), std::sqrt(1.0 - u) * std::cos(a),
                            std::sqrt(u) * std::sin(b))
      .toRotationMatrix();
}

/// Direction i of n, evenly spread over a half of the unit sphere (a Fibonacci lattice). The other half has the same waves.
Vector3 even_direction(int i, int n) {
  const double z = (i + 0.5) / n;
  const double turn = 2.0 * kPi * std::numbers::phi * i;
  const double r = std::sqrt(1.0 - z * z);
  return {r * std::cos(turn), r * std::sin(turn), z};
}

/// -cos(2 pi turns), within 1e-7. With z = 4 |r| - 1 for the distance r of `turns` to the next whole number, that is sin(pi z / 2),
/// taken as the odd polynomial of degree 9 that agrees with it in three derivatives at 0, and in value and two derivatives at 1.
[[gnu::always_inline]] inline void minus_cosine(Double4 turns, Double4& result) {
  constexpr double kRounder = 0x1.8p52;  // adding it rounds to whole numbers
  const Double4 r = turns - ((turns + kRounder) - kRounder);
  const Double4 z = 4.0 * (r < 0.0 ? -r : r) - 1.0;
  const Double4 y = z * z;
  result = z * (1.5707963267948966 +
                y * (-0.6459640975062462 + y * (0.07968919421531674 + y * (-0.004671403091481194 + y * 0.00014997958751406727))));
}

/// For four particles at a time: their positions and the gusts' velocities [m/s], each x, y, z of one particle after the other.
SPRUNG_KERNEL void add_waves(const GustField::Wave* waves, const double* phases, const double* positions, double* velocities) {
  Double4 x;
  Double4 y;
  Double4 z;
  for (Index lane = 0; lane < kSimdWidth; ++lane) {
    x[lane] = positions[3 * lane];
    y[lane] = positions[3 * lane + 1];
    z[lane] = positions[3 * lane + 2];
  }
  Double4 u{};
  Double4 v{};
  Double4 w{};
  for (int n = 0; n < GustField::kWaves; ++n) {
    const GustField::Wave& wave = waves[n];
    Double4 height;
    minus_cosine(phases[n] + (wave.wave_vector[0] * x + (wave.wave_vector[1] * y + wave.wave_vector[2] * z)), height);
    u -= wave.amplitude[0] * height;
    v -= wave.amplitude[1] * height;
    w -= wave.amplitude[2] * height;
  }
  for (Index lane = 0; lane < kSimdWidth; ++lane) {
    velocities[3 * lane] += u[lane];
    velocities[3 * lane + 1] += v[lane];
    velocities[3 * lane + 2] += w[lane];
  }
}

}  // namespace

GustField::GustField(const Gusts& gusts) : waves_{}, max_speed_(gusts.speed * std::sqrt(2.0 * kWaves)) {
  Uniform uniform(gusts.seed);
  const Matrix3 rotation = random_rotation(uniform);
  const double sigma = std::sqrt(0.5 * kPi) / gusts.length;  // [1/m]
  std::array<double, kWaves> wave_numbers{};
  for (int n = 0; n < kWaves; ++n) {
    wave_numbers[n] = sigma * quantile((n + uniform()) / kWaves);
    std::swap(wave_numbers[n], wave_numbers[static_cast<std::size_t>(uniform() * (n + 1))]);
  }
  for (int n = 0; n < kWaves; n += 2) {
    const Vector3 direction = rotation * even_direction(n / 2, kWaves / 2);
    const double turn = 2.0 * kPi * uniform();
    const Vector3 across = Eigen::AngleAxisd(turn, direction) * direction.unitOrthogonal();
    for (const auto& [wave, side] : {std::pair(n, across), std::pair(n + 1, Vector3(direction.cross(across)))}) {
      const double k = wave_numbers[wave] / (2.0 * kPi);
      waves_[wave] = {.wave_vector = k * direction,
                      .amplitude = gusts.speed * std::sqrt(2.0 / kWaves) * side,
                      .frequency = k * gusts.speed * (2.0 * uniform() - 1.0),
                      .phase = uniform()};
    }
  }
}

void GustField::add_velocities(const Eigen::Ref<const Points>& positions, const Vector3& shift, double time,
                               Eigen::Ref<Points> velocities) const {
  std::array<double, kWaves> phases{};
  for (int n = 0; n < kWaves; ++n) {
    const Wave& wave = waves_[n];
    const double turns = wave.phase + wave.frequency * time - wave.wave_vector.dot(shift);
    phases[n] = turns - std::floor(turns);
  }
  const auto count = static_cast<Index>(positions.cols());
  const Index whole = count - count % kSimdWidth;
  for (Index i = 0; i < whole; i += kSimdWidth) {
    add_waves(waves_.data(), phases.data(), positions.col(i).data(), velocities.col(i).data());
  }
  if (whole == count) return;
  Eigen::Matrix<double, 3, kSimdWidth> last = Eigen::Matrix<double, 3, kSimdWidth>::Zero();
  Eigen::Matrix<double, 3, kSimdWidth> sums = Eigen::Matrix<double, 3, kSimdWidth>::Zero();
  last.leftCols(count - whole) = positions.rightCols(count - whole);
  add_waves(waves_.data(), phases.data(), last.data(), sums.data());
  velocities.rightCols(count - whole) += sums.leftCols(count - whole);
}

}  // namespace sprung
