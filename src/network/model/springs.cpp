#include "network/model/springs.h"

#include <algorithm>

namespace sprung {

void Springs::append(Index a, Index b, double rest, double k_s, double k_d, SpringKind spring_kind, const SpringLaw& law) {
  if (laws.empty() && law != SpringLaw()) laws.resize(first.size());
  if (!laws.empty() || law != SpringLaw()) laws.push_back(law);
  first.push_back(std::min(a, b));
  second.push_back(std::max(a, b));
  rest_length.push_back(rest);
  stiffness.push_back(k_s);
  damping.push_back(k_d);
  kind.push_back(spring_kind);
}

void AngleBends::append(const std::array<Index, 3>& particles, const std::array<double, 2>& lengths, double k, double k_d) {
  before.push_back(particles[0]);
  middle.push_back(particles[1]);
  after.push_back(particles[2]);
  length_before.push_back(lengths[0]);
  length_after.push_back(lengths[1]);
  stiffness.push_back(k);
  damping.push_back(k_d);
}

}  // namespace sprung
