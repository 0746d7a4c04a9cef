#include "output/forces_csv.h"

#include "base/format.h"

namespace sprung {

std::string forces_csv_head() { return "frame,time,name,force_x,force_y,force_z\n"; }

std::string forces_csv_rows(int frame, double time, const std::vector<Reaction>& reactions) {
  std::string text;
  for (const Reaction& reaction : reactions) {
    text += std::to_string(frame) + ',' + format_number(time) + ',' + reaction.name;
    for (const double component : reaction.force) text += ',' + format_number(component);
    text += '\n';
  }
  return text;
}

}  // namespace sprung
