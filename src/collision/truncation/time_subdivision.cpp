#include "collision/truncation/time_subdivision.h"

#include <algorithm>

namespace sprung {

namespace {

constexpr double kSmallestPart = 1.0 / 64.0;

}  // namespace

Outcomes place_in_parts(Environment& environment, const Way& way, Points& after, const ClipSubstep& place) {
  const auto [begin, end] = environment.interval();
  const auto time = [begin = begin, end = end](double part) { return part < 1.0 ? begin + part * (end - begin) : end; };
  Outcomes outcomes;
  Points from = way.from;
  double done = 0.0;
  double part = 0.5;
  while (done < 1.0) {
    const double next = std::min(1.0, done + part);
    environment.set_interval(time(done), time(next));
    const Points to = next < 1.0 ? Points(from + (next - done) / (1.0 - done) * (way.to - from)) : way.to;
    after = to;
    auto [of_part, sure] = place({from, to}, after);
    if (part > kSmallestPart && (!sure || count(of_part, Outcome::infeasible) > 0)) {
      part *= 0.5;
      continue;
    }
    keep_infeasible(outcomes, of_part);
    outcomes = std::move(of_part);
    from = after;
    done = next;
  }
  environment.set_interval(begin, end);
  return outcomes;
}

}  // namespace sprung
